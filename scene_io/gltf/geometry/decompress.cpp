#include "scene_io/gltf/geometry/decompress.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace parian {
namespace {

constexpr std::size_t kSmallFile = std::size_t(64) << 20;

std::size_t file_bytes(const GltfDocument& document) {
  std::size_t sum = 0;
  for (const auto& bytes : document.storage) sum += bytes.size();
  return sum;
}

}  // namespace

DecodingBudget::DecodingBudget(const GltfDocument& document, std::size_t growth)
    : file_(document.file),
      room_(memory_limit() - std::min(memory_limit(), resident_memory())),
      most_(kSmallFile + growth * file_bytes(document)) {}

bool DecodingBudget::claim(std::size_t bytes) {
  std::size_t claimed = claimed_;
  do {
    if (bytes > most_ - claimed) return false;
  } while (!claimed_.compare_exchange_weak(claimed, claimed + bytes));
  if (claimed + bytes <= room_) return true;
  throw std::runtime_error(
      fmt::format("not enough memory: decompressing {} takes more than the {} that are left", file_,
                  format_bytes(double(room_))));
}

int add_buffer(GltfDocument& document, SharedArray<std::byte> bytes) {
  document.buffers.emplace_back(bytes.data(), bytes.size());
  document.decoded.push_back(std::move(bytes));
  return int(document.buffers.size()) - 1;
}

const tinygltf::Value* meshopt_extension(const tinygltf::BufferView& view) {
  return find_extension(view.extensions, "EXT_meshopt_compression");
}

std::vector<bool> fallback_buffers(const tinygltf::Model& model, std::size_t count) {
  std::vector<bool> is_fallback(count, false), is_read(count, false);
  for (const auto& view : model.bufferViews) {
    const auto* extension = meshopt_extension(view);
    if (extension) is_fallback[std::size_t(view.buffer)] = true;
    is_read[std::size_t(extension ? index_or_none(*extension, "buffer") : view.buffer)] = true;
  }
  for (std::size_t i = 0; i < count; ++i) is_fallback[i] = is_fallback[i] && !is_read[i];
  return is_fallback;
}

bool is_compressed(const GltfDocument& document) {
  const auto is_draco = [](const tinygltf::Primitive& primitive) {
    return find_extension(primitive.extensions, "KHR_draco_mesh_compression") != nullptr;
  };
  return std::ranges::any_of(document.model.bufferViews,
                             [](const auto& view) { return meshopt_extension(view) != nullptr; }) ||
         std::ranges::any_of(document.model.meshes, [&](const auto& mesh) {
           return std::ranges::any_of(mesh.primitives, is_draco);
         });
}

void decompress(GltfDocument& document) {
  decode_meshopt(document);
  decode_draco(document);  // second: its streams may lie in bufferViews of the first
}

}  // namespace parian

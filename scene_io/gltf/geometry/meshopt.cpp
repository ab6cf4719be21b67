/// decode_meshopt(): EXT_meshopt_compression, the only code that knows meshoptimizer.
#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/geometry/decompress.h"

namespace parian {
namespace {

// No stream holds more: two header bits stand for 16 deltas of zero.
constexpr std::size_t kMaxGrowth = 64;

struct CompressedView {
  std::size_t number;
  std::span<const std::byte> bytes;
  std::size_t count, stride;
  std::string mode, filter;
  SharedArray<std::byte> decoded = {};

  std::string where() const {
    return fmt::format("/bufferViews/{}/extensions/EXT_meshopt_compression", number);
  }
};

/// The length of the shortest stream of so many elements (the extension's appendix A); counts are below 2^31.
std::size_t shortest_stream(const CompressedView& view) {
  if (view.mode == "TRIANGLES") return 1 + view.count / 3 + 16;  // header, a byte for each, table
  if (view.mode == "INDICES") return 1 + view.count + 4;
  const std::size_t block = std::min<std::size_t>((8192 / view.stride) & ~std::size_t(15), 256);
  // For each byte of the elements: two bits for each group of 16, in whole bytes.
  const auto header_bytes = [](std::size_t elements) { return ((elements + 15) / 16 + 3) / 4; };
  const std::size_t headers = view.count / block * header_bytes(block) + header_bytes(view.count % block);
  return 1 + view.stride * headers + std::max<std::size_t>(view.stride, 32);
}

/// The view with the bytes it is decoded from, once nothing it claims exceeds what they can hold.
CompressedView find_stream(const GltfDocument& document, std::size_t number,
                           const tinygltf::Value& extension) {
  const auto size = [&](const char* key) { return std::size_t(number_or(extension, key, 0)); };
  CompressedView view{.number = number,
                      .bytes = document.buffers[std::size_t(index_or_none(extension, "buffer"))],
                      .count = size("count"),
                      .stride = size("byteStride"),
                      .mode = text_or(extension, "mode", ""),
                      .filter = text_or(extension, "filter", "NONE")};
  const std::size_t offset = size("byteOffset"), length = size("byteLength");
  if (offset > view.bytes.size() || length > view.bytes.size() - offset) {
    document.fail(view.where() + "/byteLength",
                  fmt::format("expected byteOffset + byteLength of at most {}, the length of buffer {}",
                              view.bytes.size(), index_or_none(extension, "buffer")));
  }
  view.bytes = view.bytes.subspan(offset, length);
  if (const std::size_t shortest = shortest_stream(view); length < shortest) {
    document.fail(view.where() + "/byteLength",
                  fmt::format("expected at least {}, which {} elements take", shortest, view.count));
  }
  return view;
}

void apply_filter(const CompressedView& view, void* elements) {
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(elements, view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(elements, view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(elements, view.count, view.stride);
}

void decode(const GltfDocument& document, CompressedView& view) {
  // The library reads its own older and newer formats too; the extension has one of each mode.
  const std::uint8_t header = view.mode == "ATTRIBUTES" ? 0xA0 : view.mode == "TRIANGLES" ? 0xE1 : 0xD1;
  const auto* const stream = reinterpret_cast<const unsigned char*>(view.bytes.data());
  if (stream[0] != header) {
    document.fail(view.where(),
                  fmt::format("expected a stream of mode {}, which begins with {:#x}, not {:#x}", view.mode,
                              header, stream[0]));
  }
  const std::size_t bytes = view.count * view.stride;
  // As integers, since filters want elements aligned.
  const auto [words, out] = make_shared_array<std::uint64_t>((bytes + 7) / 8);
  using Decoder = int (*)(void*, std::size_t, std::size_t, const unsigned char*, std::size_t);
  const Decoder decoder = view.mode == "ATTRIBUTES"  ? Decoder(meshopt_decodeVertexBuffer)
                          : view.mode == "TRIANGLES" ? Decoder(meshopt_decodeIndexBuffer)
                                                     : Decoder(meshopt_decodeIndexSequence);
  if (decoder(out, view.count, view.stride, stream, view.bytes.size()) != 0) {
    document.fail(view.where(),
                  fmt::format("expected a stream of {} elements of {} bytes, mode {}; it is broken",
                              view.count, view.stride, view.mode));
  }
  apply_filter(view, out);
  view.decoded = {words.owner(), reinterpret_cast<const std::byte*>(out), bytes, true};
}

}  // namespace

void decode_meshopt(GltfDocument& document) {
  std::vector<CompressedView> views;
  DecodingBudget budget(document, kMaxGrowth);
  for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
    const auto* const extension = meshopt_extension(document.model.bufferViews[i]);
    if (!extension) continue;
    views.push_back(find_stream(document, i, *extension));
    if (!budget.claim(views.back().count * views.back().stride)) {
      document.fail(views.back().where(), "expected streams that do not repeat the same bytes so many times");
    }
  }
  parallel_for(views.size(), 1, [&](std::size_t i) { decode(document, views[i]); });
  for (CompressedView& view : views) {
    tinygltf::BufferView& target = document.model.bufferViews[view.number];
    target.buffer = add_buffer(document, std::move(view.decoded));
    target.byteOffset = 0;
  }
}

}  // namespace parian

/// A glTF document whose structure has been checked: every index, offset and length in it can be relied on.
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/memory.h"

namespace parian {

struct GltfDocument {
  std::string file;                                 // as messages name it
  std::filesystem::path folder;                     // what URIs are relative to
  tinygltf::Model model;                            // buffers without data; images with name, uri, bufferView
  std::vector<std::span<const std::byte>> buffers;  // exactly byteLength each
  std::vector<SharedArray<std::byte>> storage;      // what the buffers are views of
  std::vector<std::shared_ptr<PageBuffer>> pages;   // of `storage`, those read from files
  std::size_t json_bytes = 0;                       // of `storage`, those of the JSON text
  std::map<std::filesystem::path, std::size_t> stored;  // files, by their places in `storage`
  std::vector<SharedArray<std::byte>> decoded;  // what further buffers are views of, once decompressed

  std::span<const std::byte> view(int buffer_view) const {
    const auto& v = model.bufferViews[std::size_t(buffer_view)];
    return buffers[std::size_t(v.buffer)].subspan(v.byteOffset, v.byteLength);
  }

  /// Reads a file into `storage`, once, and returns its place there. Throws std::runtime_error as
  /// read_asset_file() does.
  std::size_t store_file(const std::filesystem::path& path);

  [[noreturn]] void fail(std::string_view where, std::string_view expected) const {
    throw InputError(file, where, expected);
  }
};

/// Reads the file and its buffers, and checks all that needs neither the values in the buffers nor what is
/// decompressed: types, ranges, indices, that bufferViews lie in their buffers, and that no unsupported
/// extension is required. Images are not read. Throws InputError.
GltfDocument read_document(const std::string& path);

/// What can be checked once nothing is compressed any more: that accessors lie in their bufferViews, and the
/// relations between the other parts. That the nodes form a forest is left to validate(). Throws InputError.
void check_document(const GltfDocument& document);

/// The part of check_document() that read_document() does.
void check_buffer_views(const GltfDocument& document);

/// Bytes of one element of an accessor, without padding.
std::size_t element_bytes(const tinygltf::Accessor& accessor);

/// The messages of one file, each once.
class Warnings {
 public:
  Warnings(std::string file, std::vector<std::string>& lines) : file_(std::move(file)), lines_(lines) {}
  void add(std::string_view text) {
    std::string line = fmt::format("{}: {}", file_, text);
    if (seen_.insert(line).second) lines_.push_back(std::move(line));
  }

 private:
  std::string file_;
  std::set<std::string> seen_;
  std::vector<std::string>& lines_;
};

/// Member `key` of an extension's value, or `fallback` where the file leaves it out.
double number_or(const tinygltf::Value& value, const std::string& key, double fallback);
std::vector<double> numbers_or(const tinygltf::Value& value, const std::string& key,
                               std::vector<double> fallback);
int index_or_none(const tinygltf::Value& value, const std::string& key);
std::string text_or(const tinygltf::Value& value, const std::string& key, std::string fallback);

/// The extension `name` of an object that may have it, or nullptr.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name);

}  // namespace parian

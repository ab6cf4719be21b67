#include "scene_io/gltf/file/document.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "scene_io/gltf/file/file.h"
#include "scene_io/gltf/file/schema.h"
#include "scene_io/gltf/geometry/decompress.h"

namespace parian {
namespace {

using nlohmann::json;

// No document nests deeper, and what follows may recurse.
constexpr int kMaxJsonDepth = 64;

// How deep the brackets of a JSON text are nested, up to one more than the limit. Its own pass: the parser's
// callback, which knows the depth too, takes time that grows with the square of an array's length.
int bracket_depth(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size() && deepest <= kMaxJsonDepth; ++i) {
    if (text[i] == '"') in_string = !in_string;
    if (in_string) {
      if (text[i] == '\\') ++i;
    } else if (text[i] == '[' || text[i] == '{') {
      deepest = std::max(deepest, ++depth);
    } else if (text[i] == ']' || text[i] == '}') {
      --depth;
    }
  }
  return deepest;
}

json parse_json(std::string_view text, const std::string& file) {
  if (bracket_depth(text) > kMaxJsonDepth) {
    throw InputError(file, "", fmt::format("expected JSON nested at most {} deep", kMaxJsonDepth));
  }
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::exception& error) {
    // Drop the library's own prefix, "[json.exception.parse_error.101] ", and keep to one short line.
    std::string what = error.what();
    what = what.substr(std::min(what.size(), what.find("] ") == std::string::npos ? 0 : what.find("] ") + 2));
    std::ranges::replace_if(
        what, [](unsigned char c) { return c < 0x20 || c > 0x7E; }, '?');
    if (what.size() > 200) what.replace(197, std::string::npos, "...");
    throw InputError(file, "", "expected valid JSON: " + what);
  }
}

// One buffer's bytes: the binary chunk of the .glb, a data URI or a file beside.
std::span<const std::byte> load_buffer(GltfDocument& document, const json& buffer, std::size_t number,
                                       std::span<const std::byte> binary) {
  const std::string where = fmt::format("/buffers/{}", number);
  const bool has_uri = buffer.contains("uri");
  std::span<const std::byte> bytes = binary;
  if (has_uri) {
    const auto& uri = buffer["uri"].get_ref<const std::string&>();
    std::optional<std::size_t> file;
    try {
      if (is_data_uri(uri))
        document.storage.push_back(decode_data_uri(uri));
      else
        file = document.store_file(resolve_uri(uri, document.folder));
    } catch (const std::runtime_error& error) {
      document.fail(where + "/uri", error.what());
    }
    const SharedArray<std::byte>& stored = file ? document.storage[*file] : document.storage.back();
    bytes = {stored.data(), stored.size()};
  } else if (number != 0 || binary.empty()) {
    document.fail(where + "/uri", "expected a string: there is no binary chunk for this buffer");
  }
  const auto length = buffer["byteLength"].get<std::uint64_t>();
  if (length > bytes.size()) {
    document.fail(where + "/byteLength",
                  fmt::format("expected at most {}, the bytes that are there", bytes.size()));
  }
  return bytes.first(length);
}

json take(json& root, const char* key) {
  const auto found = root.find(key);
  if (found == root.end()) return json::array();
  json value = std::move(*found);
  root.erase(found);
  return value;
}

void fill_images(tinygltf::Model& model, const json& images, const GltfDocument& document) {
  for (std::size_t i = 0; i < images.size(); ++i) {
    tinygltf::Image image;
    image.name = images[i].value("name", std::string());
    image.uri = images[i].value("uri", std::string());
    image.bufferView = images[i].value("bufferView", -1);
    if (image.uri.empty() == (image.bufferView < 0)) {
      document.fail(fmt::format("/images/{}", i), "expected either uri or bufferView");
    }
    model.images.push_back(std::move(image));
  }
}

// tinygltf turns the checked document into typed structs. Files, buffers and images are kept from it: it
// would trust what they claim.
void parse_model(GltfDocument& document, const json& root) {
  const std::string text = root.dump();
  if (text.size() > std::numeric_limits<unsigned int>::max()) document.fail("", "expected JSON below 4 GiB");
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(), unsigned(text.size()), "",
                                  tinygltf::NO_REQUIRE)) {
    document.fail(
        "", fmt::format("expected a document that tinygltf reads: {}", error.substr(0, error.find('\n'))));
  }
}

}  // namespace

std::size_t GltfDocument::store_file(const std::filesystem::path& path) {
  const auto [known, is_new] = stored.try_emplace(path, storage.size());
  if (!is_new) return known->second;
  pages.push_back(read_asset_file(path));
  const PageBuffer& bytes = *pages.back();
  storage.emplace_back(pages.back(), bytes.data(), bytes.size(), true);
  return known->second;
}

GltfDocument read_document(const std::string& path) {
  GltfDocument document;
  document.file = path;
  document.folder = std::filesystem::path(path).parent_path();
  try {
    document.store_file(path);
  } catch (const std::runtime_error& error) {
    document.fail("", error.what());
  }
  const SharedArray<std::byte> bytes = document.storage.front();
  const GltfChunks chunks = split_gltf({bytes.data(), bytes.size()}, path);
  document.json_bytes = chunks.json.size();
  json root = parse_json(chunks.json, path);
  conform(root, path);
  const json buffers = take(root, "buffers");
  const json images = take(root, "images");
  parse_model(document, root);
  root = {};  // before the buffers come
  fill_images(document.model, images, document);
  const std::vector<bool> is_fallback = fallback_buffers(document.model, buffers.size());
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    document.buffers.push_back(is_fallback[i] ? std::span<const std::byte>()
                                              : load_buffer(document, buffers[i], i, chunks.binary));
  }
  check_buffer_views(document);
  return document;
}

double number_or(const tinygltf::Value& value, const std::string& key, double fallback) {
  return value.Has(key) ? value.Get(key).GetNumberAsDouble() : fallback;
}

std::vector<double> numbers_or(const tinygltf::Value& value, const std::string& key,
                               std::vector<double> fallback) {
  if (!value.Has(key)) return fallback;
  std::vector<double> numbers;
  for (const auto& entry : value.Get(key).Get<tinygltf::Value::Array>())
    numbers.push_back(entry.GetNumberAsDouble());
  return numbers;
}

int index_or_none(const tinygltf::Value& value, const std::string& key) {
  return value.Has(key) ? value.Get(key).GetNumberAsInt() : -1;
}

std::string text_or(const tinygltf::Value& value, const std::string& key, std::string fallback) {
  return value.Has(key) ? value.Get(key).Get<std::string>() : fallback;
}

const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

}  // namespace parian

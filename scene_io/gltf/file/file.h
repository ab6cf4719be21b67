/// The bytes of a glTF asset: the file itself, the two chunks of a .glb, and what URIs point to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "renderer/base/memory.h"

namespace parian {

/// The whole content of a regular file, read on all threads. Throws std::runtime_error whose text says what
/// was expected.
std::shared_ptr<PageBuffer> read_asset_file(const std::filesystem::path& path);

/// The JSON text of a .gltf or .glb, and the binary chunk of a .glb (empty where there is none): views of
/// `bytes`.
struct GltfChunks {
  std::string_view json;
  std::span<const std::byte> binary;
};

/// Tells the two formats apart by their first bytes. Throws InputError where the container is broken.
GltfChunks split_gltf(std::span<const std::byte> bytes, const std::string& file);

bool is_data_uri(std::string_view uri);

/// The bytes of a base64 data URI. Throws std::runtime_error whose text says what was expected.
SharedArray<std::byte> decode_data_uri(std::string_view uri);

/// The path that a relative URI names, percent escapes decoded. Throws std::runtime_error as above.
std::filesystem::path resolve_uri(std::string_view uri, const std::filesystem::path& folder);

}  // namespace parian

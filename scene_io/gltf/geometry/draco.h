/// Draco streams into arrays, bounded by what a document says is in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene_io/gltf/geometry/decompress.h"

namespace parian {

/// What an accessor says of an attribute of a stream.
struct DracoAttribute {
  std::uint32_t id = 0;  // its unique id in the stream
  int component_type = 0, components = 0;
  std::size_t count = 0;
  std::string where;  // JSON path, for messages
};

/// What an accessor says of the triangles of a stream: their corners, or those of a strip that has them all.
struct DracoIndices {
  std::size_t count = 0;
  std::uint32_t limit = 0;  // the number of vertices that its component type can tell apart
  bool is_strip = false;
  std::string where;
};

struct DracoStream {
  std::span<const std::byte> bytes;
  std::vector<DracoAttribute> attributes;
  std::vector<DracoIndices> indices;
  std::string where;
};

/// Elements of the types that the accessors have, without padding.
struct DracoMesh {
  std::size_t triangles = 0;
  SharedArray<std::byte> corners = {};  // three std::uint32_t for each triangle, not checked
  std::vector<SharedArray<std::byte>> attributes = {};
};

/// Decodes a stream, version 2.2 of the format. Refused before anything is allocated for it is what is not as
/// the accessors say or takes more memory than is left in the budget. Throws InputError.
DracoMesh decode_stream(const GltfDocument& document, const DracoStream& stream, DecodingBudget& budget);

}  // namespace parian

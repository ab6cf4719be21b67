/// The elements of an accessor where they lie in a buffer, and their decoding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "scene_io/gltf/file/document.h"

namespace parian {

/// Elements in memory: element i starts at data + i * stride. Without data all are zero.
struct Elements {
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  int component_type = 0, components = 0;
  bool normalized = false;
};

/// What the accessor holds, but for its sparse replacements.
Elements base_elements(const GltfDocument& document, const tinygltf::Accessor& accessor);

/// The replacements of a sparse accessor, one behind the other.
Elements sparse_elements(const GltfDocument& document, const tinygltf::Accessor& accessor);

/// Writes elements [begin, end), there must be data, as floats; element begin + i goes to out + i *
/// out_stride.
void decode_floats(const Elements& elements, std::size_t begin, std::size_t end, float* out,
                   std::size_t out_stride);

/// Writes elements [begin, end), scalars of an unsigned type and data, to out.
void decode_integers(const Elements& elements, std::size_t begin, std::size_t end, std::uint32_t* out);

/// Calls body(position, k) for each replacement k of accessor `number`, none if it is not sparse: it goes to
/// element `position`. Throws InputError where positions do not rise or lie outside.
void for_sparse(const GltfDocument& document, int number,
                const std::function<void(std::size_t, std::size_t)>& body);

}  // namespace parian

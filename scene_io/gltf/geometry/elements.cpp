#include "scene_io/gltf/geometry/elements.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace parian {
namespace {

Elements sparse_positions(const GltfDocument& document, const tinygltf::Accessor& accessor) {
  const auto& indices = accessor.sparse.indices;
  return {.data = document.view(indices.bufferView).data() + std::size_t(indices.byteOffset),
          .stride = std::size_t(tinygltf::GetComponentSizeInBytes(std::uint32_t(indices.componentType))),
          .component_type = indices.componentType,
          .components = 1,
          .normalized = false};
}

/// Calls body with a value of the C++ type of the components.
template <class Body>
void with_component_type(int component_type, const Body& body) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return body(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return body(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return body(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return body(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return body(std::uint32_t());
    default:
      return body(float());
  }
}

}  // namespace

Elements base_elements(const GltfDocument& document, const tinygltf::Accessor& accessor) {
  Elements elements{.component_type = accessor.componentType,
                    .components = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)),
                    .normalized = accessor.normalized};
  if (accessor.bufferView >= 0) {
    const std::size_t stride = document.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
    elements.data = document.view(accessor.bufferView).data() + accessor.byteOffset;
    elements.stride = stride ? stride : element_bytes(accessor);
  }
  return elements;
}

Elements sparse_elements(const GltfDocument& document, const tinygltf::Accessor& accessor) {
  Elements elements = base_elements(document, accessor);
  elements.data = document.view(accessor.sparse.values.bufferView).data() +
                  std::size_t(accessor.sparse.values.byteOffset);
  elements.stride = element_bytes(accessor);
  return elements;
}

void decode_floats(const Elements& elements, std::size_t begin, std::size_t end, float* out,
                   std::size_t out_stride) {
  with_component_type(elements.component_type, [&](auto tag) {
    using Stored = decltype(tag);
    for (std::size_t i = begin; i < end; ++i) {
      float* const target = out + (i - begin) * out_stride;
      const std::byte* const source = elements.data + i * elements.stride;
      for (int c = 0; c < elements.components; ++c) {
        Stored value;  // buffers promise no alignment
        std::memcpy(&value, source + std::size_t(c) * sizeof(Stored), sizeof(Stored));
        target[c] = float(value);
        if constexpr (std::is_integral_v<Stored>) {
          if (elements.normalized) {
            target[c] = std::max(target[c] / float(std::numeric_limits<Stored>::max()), -1.0f);
          }
        }
      }
    }
  });
}

void decode_integers(const Elements& elements, std::size_t begin, std::size_t end, std::uint32_t* out) {
  with_component_type(elements.component_type, [&](auto tag) {
    using Stored = decltype(tag);
    if constexpr (std::is_unsigned_v<Stored>) {
      for (std::size_t i = begin; i < end; ++i) {
        Stored value;
        std::memcpy(&value, elements.data + i * elements.stride, sizeof(Stored));
        out[i - begin] = value;
      }
    }
  });
}

void for_sparse(const GltfDocument& document, int number,
                const std::function<void(std::size_t, std::size_t)>& body) {
  const auto& accessor = document.model.accessors[std::size_t(number)];
  if (!accessor.sparse.isSparse) return;
  const Elements positions = sparse_positions(document, accessor);
  std::int64_t previous = -1;
  for (std::size_t k = 0; k < std::size_t(accessor.sparse.count); ++k) {
    std::uint32_t position = 0;
    decode_integers(positions, k, k + 1, &position);
    if (position <= previous || position >= accessor.count) {
      document.fail(
          fmt::format("/accessors/{}/sparse/indices", number),
          fmt::format("expected rising indices below {}, element {} is {}", accessor.count, k, position));
    }
    previous = position;
    body(position, k);
  }
}

}  // namespace parian

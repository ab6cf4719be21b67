#include "scene_io/gltf_accessor.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <type_traits>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

constexpr std::size_t kChunk = std::size_t(1) << 16;

// The largest honest growth: a 1-byte index that becomes a 12-byte triangle of a strip, or a quantised 4-byte
// rotation that becomes an instance transform. More means that accessors overlap.
constexpr std::size_t kMaxGrowth = 64;
constexpr std::size_t kSmallFile = std::size_t(64) << 20;

/// Elements in memory: element i starts at data + i * stride. Without data all are zero.
struct Elements {
  const std::byte* data = nullptr;
  std::size_t stride = 0;
  int component_type = 0, components = 0;
  bool normalized = false;
};

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

/// The densely stored replacements of a sparse accessor.
Elements sparse_elements(const GltfDocument& document, const tinygltf::Accessor& accessor) {
  Elements elements = base_elements(document, accessor);
  elements.data = document.view(accessor.sparse.values.bufferView).data() +
                  std::size_t(accessor.sparse.values.byteOffset);
  elements.stride = element_bytes(accessor);
  return elements;
}

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

/// Writes elements [begin, end) to out(i): a pointer to floats.
template <class Out>
void decode_floats(const Elements& elements, std::size_t begin, std::size_t end, const Out& out) {
  with_component_type(elements.component_type, [&](auto tag) {
    using Stored = decltype(tag);
    for (std::size_t i = begin; i < end; ++i) {
      float* const target = out(i);
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

/// Calls body(position, k): replacement k goes to element `position`.
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

bool accepts(const tinygltf::Accessor& accessor, Components components) {
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return components.floats;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return false;
    default:
      return accessor.normalized ? components.normalized_integers : components.plain_integers;
  }
}

std::string describe(std::size_t dimension, Components components) {
  std::string text = fmt::format("an accessor of VEC{}, float", dimension);
  if (components.normalized_integers)
    text += components.plain_integers ? " or 8 or 16 bit" : " or normalized 8 or 16 bit";
  return text;
}

}  // namespace

void for_chunks(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
  const auto chunk = [&](std::size_t i) { body(i * kChunk, std::min(count, (i + 1) * kChunk)); };
  const std::size_t chunks = (count + kChunk - 1) / kChunk;
  if (chunks == 1) return chunk(0);
  parallel_for(chunks, 1, chunk);
}

AccessorReader::AccessorReader(const GltfDocument& document) : document_(document), claimable_(kSmallFile) {
  for (const auto& bytes : document.storage) claimable_ += kMaxGrowth * bytes.size();
  // Already bounded as a whole by check_document().
  for (const auto& accessor : document.model.accessors) {
    if (accessor.bufferView < 0) claimable_ += sizeof(Vec4f) * accessor.count;
  }
}

void AccessorReader::claim(std::size_t bytes, const std::string& where) {
  if (bytes > claimable_)
    document_.fail(where, "expected accessors that do not repeat the same bytes so many times");
  claimable_ -= bytes;
}

template <class Vector>
SharedArray<Vector> AccessorReader::vectors(int number, Components components, const std::string& where) {
  auto& cache = [this]() -> auto& {
    if constexpr (std::is_same_v<Vector, Vec2f>) return vec2_;
    if constexpr (std::is_same_v<Vector, Vec3f>) return vec3_;
    if constexpr (std::is_same_v<Vector, Vec4f>) return vec4_;
  }
  ();
  const auto& accessor = document_.model.accessors[std::size_t(number)];
  const int dimension = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
  const bool is_vector = accessor.type == TINYGLTF_TYPE_VEC2 || accessor.type == TINYGLTF_TYPE_VEC3 ||
                         accessor.type == TINYGLTF_TYPE_VEC4;
  const bool fits =
      is_vector && (dimension == int(Vector::dimensions()) || (dimension == 3 && Vector::dimensions() == 4));
  if (!fits || !accepts(accessor, components)) {
    document_.fail(where, "expected " + describe(Vector::dimensions(), components));
  }
  if (const auto known = cache.find(number); known != cache.end()) return known->second;

  claim(accessor.count * sizeof(Vector), where);
  const auto owner = std::make_shared_for_overwrite<Vector[]>(accessor.count);
  Vector* const out = owner.get();
  const auto target = [&](std::size_t i) { return &out[i][0]; };
  const Elements base = base_elements(document_, accessor);
  for_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    if (!base.data) std::fill(out + begin, out + end, Vector(0));
    if (base.data) decode_floats(base, begin, end, target);
    for (std::size_t i = begin; dimension < int(Vector::dimensions()) && i < end; ++i) out[i][dimension] = 1;
  });
  const Elements replacements = accessor.sparse.isSparse ? sparse_elements(document_, accessor) : Elements{};
  for_sparse(document_, number, [&](std::size_t position, std::size_t k) {
    decode_floats(replacements, k, k + 1, [&](std::size_t) { return target(position); });
  });
  for_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (unsigned int c = 0; c < Vector::dimensions(); ++c) {
        if (!std::isfinite(out[i][int(c)])) {
          document_.fail(fmt::format("/accessors/{}", number),
                         fmt::format("expected finite numbers, element {} holds {}", i, out[i][int(c)]));
        }
      }
    }
  });
  return cache[number] = SharedArray<Vector>(owner, out, accessor.count);
}

template SharedArray<Vec2f> AccessorReader::vectors<Vec2f>(int, Components, const std::string&);
template SharedArray<Vec3f> AccessorReader::vectors<Vec3f>(int, Components, const std::string&);
template SharedArray<Vec4f> AccessorReader::vectors<Vec4f>(int, Components, const std::string&);

AccessorReader::Indices AccessorReader::decode_indices(int number, const std::string& where) {
  const auto& accessor = document_.model.accessors[std::size_t(number)];
  const bool is_unsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned) {
    document_.fail(where, "expected an accessor of SCALAR, unsigned integers");
  }
  claim(accessor.count * sizeof(std::uint32_t), where);
  const auto owner = std::make_shared_for_overwrite<std::uint32_t[]>(accessor.count);
  std::uint32_t* const out = owner.get();
  const Elements base = base_elements(document_, accessor);
  for_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    if (base.data) decode_integers(base, begin, end, out + begin);
    if (!base.data) std::fill(out + begin, out + end, 0);
  });
  const Elements replacements = accessor.sparse.isSparse ? sparse_elements(document_, accessor) : Elements{};
  for_sparse(document_, number, [&](std::size_t position, std::size_t k) {
    decode_integers(replacements, k, k + 1, out + position);
  });
  std::atomic<std::uint32_t> largest = 0;
  for_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    const std::uint32_t local = *std::max_element(out + begin, out + end);
    std::uint32_t seen = largest;
    while (local > seen && !largest.compare_exchange_weak(seen, local)) {
    }
  });
  const std::uint32_t restart = 0xFFFFFFFFu >> (32 - 8 * element_bytes(accessor));
  if (largest == restart) {
    document_.fail(fmt::format("/accessors/{}", number),
                   fmt::format("expected no index {}, which is the primitive restart value", restart));
  }
  return {{owner, out, accessor.count}, largest};
}

SharedArray<std::uint32_t> AccessorReader::indices(int number, std::size_t limit, const std::string& where) {
  auto known = indices_.find(number);
  if (known == indices_.end()) known = indices_.emplace(number, decode_indices(number, where)).first;
  const Indices& indices = known->second;
  if (indices.largest >= limit) {
    const auto bad = std::ranges::find_if(indices.values, [&](std::uint32_t i) { return i >= limit; });
    document_.fail(fmt::format("/accessors/{}", number),
                   fmt::format("expected indices below {}, the number of vertices; element {} is {}", limit,
                               bad - indices.values.begin(), *bad));
  }
  return indices.values;
}

}  // namespace parian

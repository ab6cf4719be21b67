#include "scene_io/gltf/geometry/accessor.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <type_traits>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/geometry/elements.h"

namespace parian {
namespace {

// The largest honest growth: a 1-byte index that becomes a 12-byte triangle of a strip, or a quantised 4-byte
// rotation that becomes an instance transform. More means that accessors overlap.
constexpr std::size_t kMaxGrowth = 64;
// Compressed elements have grown already, and none of them is a single byte.
constexpr std::size_t kMaxDecodedGrowth = 16;
constexpr std::size_t kSmallFile = std::size_t(64) << 20;

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

std::string describe(const std::string& type, Components components) {
  std::string text = fmt::format("an accessor of {}, float", type);
  if (components.normalized_integers)
    text += components.plain_integers ? " or 8 or 16 bit" : " or normalized 8 or 16 bit";
  return text;
}

// The array where it lies in the file, where that is how T lies in memory; else nothing.
template <class T>
std::optional<SharedArray<T>> share(const GltfDocument& document, const tinygltf::Accessor& accessor,
                                    const Elements& elements) {
  constexpr int kType =
      std::is_same_v<T, std::uint32_t> ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT : TINYGLTF_COMPONENT_TYPE_FLOAT;
  const bool fits = elements.data && !accessor.sparse.isSparse && elements.component_type == kType &&
                    std::size_t(elements.components) * sizeof(float) == sizeof(T) &&
                    elements.stride == sizeof(T) &&
                    reinterpret_cast<std::uintptr_t>(elements.data) % alignof(T) == 0;
  if (!fits) return std::nullopt;
  for (const auto* arrays : {&document.storage, &document.decoded})
    for (const SharedArray<std::byte>& bytes : *arrays) {
      if (elements.data < bytes.data() || elements.data >= bytes.end()) continue;
      const bool padded =
          bytes.padded() || elements.data + accessor.count * sizeof(T) + kArrayPadding <= bytes.end();
      return SharedArray<T>(bytes.owner(), reinterpret_cast<const T*>(elements.data), accessor.count, padded);
    }
  return std::nullopt;
}

// Exponent bits all set is what Inf and NaN are made of. Without a branch, so that it is done by lanes.
bool all_finite(const float* values, std::size_t count) {
  constexpr std::uint32_t kExponent = 0x7f800000;
  bool bad = false;
  for (std::size_t i = 0; i < count; ++i)
    bad |= (std::bit_cast<std::uint32_t>(values[i]) & kExponent) == kExponent;
  return !bad;
}

template <class Vector>
void check_finite(const SharedArray<Vector>& array, const GltfDocument& document, int number) {
  constexpr std::size_t kSize = sizeof(Vector) / sizeof(float);
  if (array.empty()) return;
  const float* const values = &array[0][0];
  parallel_chunks(array.size(), [&](std::size_t begin, std::size_t end) {
    if (all_finite(values + begin * kSize, (end - begin) * kSize)) return;
    std::size_t i = begin * kSize;
    while (std::isfinite(values[i])) ++i;
    document.fail(fmt::format("/accessors/{}", number),
                  fmt::format("expected finite numbers, element {} holds {}", i / kSize, values[i]));
  });
}

// Before memory for a decoded array is taken.
void require(const GltfDocument& document, std::size_t bytes, const std::string& where) try {
  require_memory(bytes, "decoding it");
} catch (const std::runtime_error& error) {
  document.fail(where, error.what());
}

std::string type_name(int type) {
  if (type == TINYGLTF_TYPE_SCALAR) return "SCALAR";
  const int components = tinygltf::GetNumComponentsInType(std::uint32_t(type));
  return type == TINYGLTF_TYPE_MAT4 ? "MAT4" : fmt::format("VEC{}", components);
}

}  // namespace

AccessorReader::AccessorReader(const GltfDocument& document) : document_(document), claimable_(kSmallFile) {
  for (const auto& bytes : document.storage) claimable_ += kMaxGrowth * bytes.size();
  claimable_ -= kMaxGrowth * document.json_bytes;  // a long text holds no elements
  for (const auto& bytes : document.decoded) claimable_ += kMaxDecodedGrowth * bytes.size();
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
    document_.fail(where, "expected " + describe(fmt::format("VEC{}", Vector::dimensions()), components));
  }
  if (const auto known = cache.find(number); known != cache.end()) return known->second;

  claim(accessor.count * sizeof(Vector), where);
  const Elements base = base_elements(document_, accessor);
  if (auto shared = share<Vector>(document_, accessor, base)) {
    check_finite(*shared, document_, number);
    return cache[number] = *std::move(shared);
  }
  require(document_, accessor.count * sizeof(Vector), where);
  auto [array, out_data] = make_shared_array<Vector>(accessor.count);
  Vector* const out = out_data;
  constexpr std::size_t kStride = sizeof(Vector) / sizeof(float);
  parallel_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    if (!base.data) std::fill(out + begin, out + end, Vector(0));
    if (base.data) decode_floats(base, begin, end, &out[begin][0], kStride);
    for (std::size_t i = begin; dimension < int(Vector::dimensions()) && i < end; ++i) out[i][dimension] = 1;
  });
  const Elements replacements = accessor.sparse.isSparse ? sparse_elements(document_, accessor) : Elements{};
  for_sparse(document_, number, [&](std::size_t position, std::size_t k) {
    decode_floats(replacements, k, k + 1, &out[position][0], kStride);
  });
  check_finite(array, document_, number);
  return cache[number] = std::move(array);
}

template SharedArray<Vec2f> AccessorReader::vectors<Vec2f>(int, Components, const std::string&);
template SharedArray<Vec3f> AccessorReader::vectors<Vec3f>(int, Components, const std::string&);
template SharedArray<Vec4f> AccessorReader::vectors<Vec4f>(int, Components, const std::string&);

SharedArray<float> AccessorReader::numbers(int number, int type, Components components,
                                           const std::string& where) {
  const auto& accessor = document_.model.accessors[std::size_t(number)];
  if (accessor.type != type || !accepts(accessor, components))
    document_.fail(where, "expected " + describe(type_name(type), components));
  if (const auto known = numbers_.find(number); known != numbers_.end()) return known->second;

  const auto width = std::size_t(tinygltf::GetNumComponentsInType(std::uint32_t(type)));
  claim(accessor.count * width * sizeof(float), where);
  std::vector<float> values(accessor.count * width, 0);
  const Elements base = base_elements(document_, accessor);
  if (base.data) decode_floats(base, 0, accessor.count, values.data(), width);
  const Elements replacements = accessor.sparse.isSparse ? sparse_elements(document_, accessor) : Elements{};
  for_sparse(document_, number, [&](std::size_t position, std::size_t k) {
    decode_floats(replacements, k, k + 1, &values[position * width], width);
  });
  const auto bad = std::ranges::find_if(values, [](float value) { return !std::isfinite(value); });
  if (bad != values.end()) {
    document_.fail(fmt::format("/accessors/{}", number),
                   fmt::format("expected finite numbers, element {} holds {}",
                               std::size_t(bad - values.begin()) / width, *bad));
  }
  return numbers_[number] = std::move(values);
}

AccessorReader::Indices AccessorReader::decode_indices(int number, const std::string& where) {
  const auto& accessor = document_.model.accessors[std::size_t(number)];
  const bool is_unsigned = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                           accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  if (accessor.type != TINYGLTF_TYPE_SCALAR || !is_unsigned) {
    document_.fail(where, "expected an accessor of SCALAR, unsigned integers");
  }
  claim(accessor.count * sizeof(std::uint32_t), where);
  const Elements base = base_elements(document_, accessor);
  if (auto shared = share<std::uint32_t>(document_, accessor, base))
    return checked(*std::move(shared), number);
  require(document_, accessor.count * sizeof(std::uint32_t), where);
  auto [array, out_data] = make_shared_array<std::uint32_t>(accessor.count);
  std::uint32_t* const out = out_data;
  parallel_chunks(accessor.count, [&](std::size_t begin, std::size_t end) {
    if (base.data) decode_integers(base, begin, end, out + begin);
    if (!base.data) std::fill(out + begin, out + end, 0);
  });
  const Elements replacements = accessor.sparse.isSparse ? sparse_elements(document_, accessor) : Elements{};
  for_sparse(document_, number, [&](std::size_t position, std::size_t k) {
    decode_integers(replacements, k, k + 1, out + position);
  });
  return checked(std::move(array), number);
}

AccessorReader::Indices AccessorReader::checked(SharedArray<std::uint32_t> indices, int number) const {
  std::atomic<std::uint32_t> largest = 0;
  parallel_chunks(indices.size(), [&](std::size_t begin, std::size_t end) {
    std::uint32_t local = 0;
    for (std::size_t i = begin; i < end; ++i) local = std::max(local, indices[i]);
    std::uint32_t seen = largest;
    while (local > seen && !largest.compare_exchange_weak(seen, local)) {
    }
  });
  const auto& accessor = document_.model.accessors[std::size_t(number)];
  const std::uint32_t restart = 0xFFFFFFFFu >> (32 - 8 * element_bytes(accessor));
  if (largest == restart) {
    document_.fail(fmt::format("/accessors/{}", number),
                   fmt::format("expected no index {}, which is the primitive restart value", restart));
  }
  return {std::move(indices), largest};
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

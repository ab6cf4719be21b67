/// Accessors as arrays of floats, vectors or indices, whatever way the file stores them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "renderer/base/math.h"
#include "renderer/base/shared_array.h"
#include "scene_io/gltf/file/document.h"

namespace parian {

/// The component types an attribute may have.
struct Components {
  bool floats = true;
  bool normalized_integers = false;  // 8 and 16 bit, mapped to [0, 1] or [-1, 1]
  bool plain_integers = false;       // 8 and 16 bit, taken as numbers
};

/// Decodes accessors, each once: primitives that share one share its array, and what lies in the file as it
/// does in memory stays where it is. What all of them together may take is bounded by the size of the file,
/// however often accessors overlap.
class AccessorReader {
 public:
  explicit AccessorReader(const GltfDocument& document);

  /// The elements as vectors (V2f, V3f or V4f), finite. An accessor with three components read as V4f has w
  /// = 1. `where` is the JSON path that names the accessor, for messages. Throws InputError.
  template <class Vector>
  SharedArray<Vector> vectors(int accessor, Components components, const std::string& where);

  /// The components of all elements, one behind the other, finite; the elements are of tinygltf's `type`
  /// SCALAR, VEC2 to VEC4 or MAT4. `where` as above. Throws InputError.
  SharedArray<float> numbers(int accessor, int type, Components components, const std::string& where);

  /// The elements as indices, each below `limit`. Throws InputError.
  SharedArray<std::uint32_t> indices(int accessor, std::size_t limit, const std::string& where);

  /// Counts memory that a decoded array takes, on behalf of `where`. Throws InputError if it is too much.
  void claim(std::size_t bytes, const std::string& where);

 private:
  struct Indices {
    SharedArray<std::uint32_t> values;
    std::uint32_t largest = 0;
  };
  Indices decode_indices(int accessor, const std::string& where);
  /// Finds the largest, which must not be the restart value.
  Indices checked(SharedArray<std::uint32_t> indices, int accessor) const;

  const GltfDocument& document_;
  std::size_t claimable_;
  std::map<int, SharedArray<Vec2f>> vec2_;
  std::map<int, SharedArray<Vec3f>> vec3_;
  std::map<int, SharedArray<Vec4f>> vec4_;
  std::map<int, SharedArray<float>> numbers_;
  std::map<int, Indices> indices_;
};

}  // namespace parian

/// Equality of elements that never reads a large array: arrays are the same where they share their storage.
/// Two arrays of equal contents in two places count as different, which is also what a BVH that holds on to
/// the memory of one of them has to hear.
#pragma once

#include <algorithm>

#include "renderer/scene/scene.h"

namespace parian {

template <class T>
bool shares_storage(const SharedArray<T>& a, const SharedArray<T>& b) {
  return a.data() == b.data() && a.size() == b.size();
}

/// Of what is equal bit for bit and has no arrays. NaN is none of a valid scene's.
template <class T>
bool identical(const T& a, const T& b) {
  return a == b;
}

// The arrays first: where they are the same, == compares them by their addresses.

inline bool identical(const Primitive& a, const Primitive& b) {
  return shares_storage(a.positions, b.positions) && shares_storage(a.normals, b.normals) &&
         shares_storage(a.tangents, b.tangents) && shares_storage(a.uvs[0], b.uvs[0]) &&
         shares_storage(a.uvs[1], b.uvs[1]) && shares_storage(a.colors, b.colors) &&
         shares_storage(a.triangles, b.triangles) && a == b;
}

inline bool identical(const Mesh& a, const Mesh& b) {
  const auto same = [](const Primitive& p, const Primitive& q) { return identical(p, q); };
  return std::ranges::equal(a.primitives, b.primitives, same) && a == b;
}

inline bool identical(const Image& a, const Image& b) {
  return shares_storage(a.pixels, b.pixels) && a.source == b.source && a == b;
}

inline bool identical(const Node& a, const Node& b) {
  return shares_storage(a.instances, b.instances) && a == b;
}

}  // namespace parian

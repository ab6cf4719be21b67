#include "scene_io/gltf/write/new_data.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "scene_io/gltf/write/member.h"
#include "scene_io/gltf/write/references.h"

namespace parian {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126, kUnsignedInt = 5125, kUnsignedShort = 5123;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::size_t kChunk = std::size_t(1) << 14;  // elements converted at once
// As an index it would be the primitive restart value.
constexpr std::size_t kMaxShortVertices = 65535;

template <class T>
Piece whole(const SharedArray<T>& array) {
  return {array.bytes(), [array](FileWriter& file) { file.write(array.data(), array.bytes()); }};
}

/// An array whose elements `convert` makes of those of another, chunk by chunk.
template <class To, class From, class Convert>
Piece converted(const SharedArray<From>& array, const Convert& convert) {
  return {array.size() * sizeof(To), [array, convert](FileWriter& file) {
            std::vector<To> chunk;
            for (std::size_t i = 0; i < array.size(); i += chunk.size()) {
              chunk.resize(std::min(kChunk, array.size() - i));
              for (std::size_t k = 0; k < chunk.size(); ++k) chunk[k] = convert(array[i + k]);
              file.write(chunk.data(), chunk.size() * sizeof(To));
            }
          }};
}

int add_accessor(json& root, int view, int component_type, std::size_t count, const char* type) {
  json& accessors = need_array(root, array::kAccessors);
  accessors.push_back(
      {{"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}});
  return int(accessors.size()) - 1;
}

/// make() of what is not known yet.
template <class T, class Make>
int add_once(NewData& data, const SharedArray<T>& array, const char* use, const Make& make) {
  const auto [known, is_new] = data.known.try_emplace({array.data(), array.size(), use}, 0);
  if (is_new) known->second = make();
  return known->second;
}

int add_vertex_view(json& root, NewData& data, Piece piece) {
  const int view = add_piece(root, data, std::move(piece));
  root["bufferViews"][std::size_t(view)]["target"] = kArrayBuffer;
  return view;
}

template <class Vector>
int add_vectors_of(json& root, NewData& data, const SharedArray<Vector>& array, const char* type) {
  return add_once(data, array, type, [&] {
    return add_accessor(root, add_vertex_view(root, data, whole(array)), kFloat, array.size(), type);
  });
}

}  // namespace

int add_piece(json& root, NewData& data, Piece piece) {
  json& views = need_array(root, array::kBufferViews);
  // Where it lies is known once all pieces are.
  views.push_back({{"buffer", 0}, {"byteLength", piece.bytes}});
  data.pieces.push_back(std::move(piece));
  return int(views.size()) - 1;
}

int add_vectors(json& root, NewData& data, const SharedArray<Vec2f>& array) {
  return add_vectors_of(root, data, array, "VEC2");
}
int add_vectors(json& root, NewData& data, const SharedArray<Vec3f>& array) {
  return add_vectors_of(root, data, array, "VEC3");
}
int add_vectors(json& root, NewData& data, const SharedArray<Vec4f>& array) {
  return add_vectors_of(root, data, array, "VEC4");
}

int add_positions(json& root, NewData& data, const SharedArray<Vec3f>& positions) {
  return add_once(data, positions, "POSITION", [&] {
    const int accessor =
        add_accessor(root, add_vertex_view(root, data, whole(positions)), kFloat, positions.size(), "VEC3");
    Vec3f low = positions[0], high = low;
    for (const Vec3f& p : positions)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    // As doubles: the bounds are meant to be those of the stored floats.
    const auto exact = [](const Vec3f& v) { return json::array({double(v.x), double(v.y), double(v.z)}); };
    root["accessors"][std::size_t(accessor)]["min"] = exact(low);
    root["accessors"][std::size_t(accessor)]["max"] = exact(high);
    return accessor;
  });
}

int add_indices(json& root, NewData& data, const SharedArray<Triangle>& triangles, std::size_t vertices) {
  const bool is_short = vertices <= kMaxShortVertices;
  return add_once(data, triangles, is_short ? "uint16" : "uint32", [&] {
    using Short = std::array<std::uint16_t, 3>;
    Piece piece =
        is_short
            ? converted<Short>(triangles,
                               [](const Triangle& t) {
                                 return Short{std::uint16_t(t[0]), std::uint16_t(t[1]), std::uint16_t(t[2])};
                               })
            : whole(triangles);
    const int view = add_piece(root, data, std::move(piece));
    root["bufferViews"][std::size_t(view)]["target"] = kElementArrayBuffer;
    return add_accessor(root, view, is_short ? kUnsignedShort : kUnsignedInt, 3 * triangles.size(), "SCALAR");
  });
}

json add_instances(json& root, NewData& data, const SharedArray<InstanceTransform>& instances) {
  using Three = std::array<float, 3>;
  using Four = std::array<float, 4>;
  const auto add = [&](const char* use, const char* type, const auto& make_piece) {
    return add_once(data, instances, use, [&] {
      return add_accessor(root, add_piece(root, data, make_piece()), kFloat, instances.size(), type);
    });
  };
  json attributes;
  attributes["TRANSLATION"] = add("TRANSLATION", "VEC3", [&] {
    return converted<Three>(instances, [](const InstanceTransform& t) {
      return Three{t.translation.x, t.translation.y, t.translation.z};
    });
  });
  attributes["ROTATION"] = add("ROTATION", "VEC4", [&] {
    return converted<Four>(instances, [](const InstanceTransform& t) {
      return Four{t.rotation.v.x, t.rotation.v.y, t.rotation.v.z, t.rotation.r};
    });
  });
  attributes["SCALE"] = add("SCALE", "VEC3", [&] {
    return converted<Three>(instances, [](const InstanceTransform& t) {
      return Three{t.scale.x, t.scale.y, t.scale.z};
    });
  });
  return attributes;
}

}  // namespace parian

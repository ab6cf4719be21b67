/// The bytes that a document gets beside those of its sources.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/base/file.h"
#include "renderer/scene/scene.h"

namespace parian {

/// Bytes that are made when they are written: no second copy of a large array is held.
struct Piece {
  std::size_t bytes = 0;
  std::function<void(FileWriter&)> write;
};

/// Accessors and bufferViews of new bytes, of which number i lies in bufferView first_view + i.
struct NewData {
  std::size_t first_view = 0;
  std::vector<Piece> pieces;
  std::map<std::tuple<const void*, std::size_t, std::string>, int> known;  // accessors by array and use
};

/// The bufferView of a new piece.
int add_piece(nlohmann::json& root, NewData& data, Piece piece);

/// Accessors, one for each array however many primitives share it. Positions have their bounds.
int add_positions(nlohmann::json& root, NewData& data, const SharedArray<Vec3f>& positions);
int add_vectors(nlohmann::json& root, NewData& data, const SharedArray<Vec2f>& array);
int add_vectors(nlohmann::json& root, NewData& data, const SharedArray<Vec3f>& array);
int add_vectors(nlohmann::json& root, NewData& data, const SharedArray<Vec4f>& array);
/// 16 bits each where `vertices` allow it.
int add_indices(nlohmann::json& root, NewData& data, const SharedArray<Triangle>& triangles,
                std::size_t vertices);
/// TRANSLATION, ROTATION and SCALE of EXT_mesh_gpu_instancing, by name.
nlohmann::json add_instances(nlohmann::json& root, NewData& data,
                             const SharedArray<InstanceTransform>& instances);

}  // namespace parian

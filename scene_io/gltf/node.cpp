/// read_nodes(): the node forest, transforms, and what nodes show.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

constexpr double kAffineTolerance = 1e-5;

Vec3f to_vec3(const std::vector<double>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

/// A unit quaternion from glTF's x, y, z, w; nothing where that has no direction. One that validate() takes
/// for unit stays as it is to the bit, so that it can be written and read again; who uses it divides by its
/// length anyway.
std::optional<Quatf> to_rotation(double x, double y, double z, double w) {
  constexpr double kUnitTolerance = 9e-4;  // of a squared length, below that of validate()
  const double square = x * x + y * y + z * z + w * w, length = std::sqrt(square);
  if (std::abs(square - 1) <= kUnitTolerance) return Quatf(float(w), float(x), float(y), float(z));
  if (!(length > 0)) return std::nullopt;
  return Quatf(float(w / length), float(x / length), float(y / length), float(z / length));
}

constexpr const char* kExpectedRotation = "expected a unit quaternion, not zero";

Transform read_transform(const tinygltf::Node& source, const GltfDocument& document,
                         const std::string& where) {
  Transform transform;
  if (!source.matrix.empty()) {
    const auto& m = source.matrix;
    for (const int i : {3, 7, 11, 15}) {
      if (std::abs(m[std::size_t(i)] - (i == 15)) > kAffineTolerance) {
        document.fail(fmt::format("{}/matrix/{}", where, i),
                      fmt::format("expected {}, in an affine matrix", int(i == 15)));
      }
    }
    Imath::M44f matrix;
    for (int i = 0; i < 16; ++i)
      matrix[i / 4][i % 4] = i % 4 == 3 ? float(i == 15) : float(m[std::size_t(i)]);
    transform.matrix = matrix;
    return transform;
  }
  if (!source.translation.empty()) transform.translation = to_vec3(source.translation);
  if (!source.scale.empty()) transform.scale = to_vec3(source.scale);
  if (const auto& r = source.rotation; !r.empty()) {
    const auto rotation = to_rotation(r[0], r[1], r[2], r[3]);
    if (!rotation) document.fail(where + "/rotation", kExpectedRotation);
    transform.rotation = *rotation;
  }
  return transform;
}

/// EXT_mesh_gpu_instancing. All attributes are optional, and as long as each other.
SharedArray<InstanceTransform> read_instances(const tinygltf::Value& extension, const GltfDocument& document,
                                              AccessorReader& accessors, const std::string& where) {
  const tinygltf::Value attributes =
      extension.Has("attributes") ? extension.Get("attributes") : tinygltf::Value();
  std::optional<std::size_t> count;
  const auto read = [&]<class Vector>(const char* name, Components components, SharedArray<Vector>& target) {
    const int accessor = index_or_none(attributes, name);
    if (accessor < 0) return;
    const std::string place = fmt::format("{}/{}", where, name);
    target = accessors.vectors<Vector>(accessor, components, place);
    if (count && *count != target.size()) {
      document.fail(place, fmt::format("expected {} elements, as many as the others have, not {}", *count,
                                       target.size()));
    }
    count = target.size();
  };
  SharedArray<Vec3f> translations, scales;
  SharedArray<Vec4f> rotations;
  read("TRANSLATION", {}, translations);
  read("ROTATION", {.normalized_integers = true}, rotations);
  read("SCALE", {}, scales);
  const std::size_t size = count.value_or(0);
  accessors.claim(size * sizeof(InstanceTransform), where);
  auto [array, data] = make_shared_array<InstanceTransform>(size);
  parallel_chunks(size, [&, instances = data](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      instances[i] = {};
      if (!translations.empty()) instances[i].translation = translations[i];
      if (!scales.empty()) instances[i].scale = scales[i];
      if (rotations.empty()) continue;
      const Vec4f& r = rotations[i];
      const auto rotation = to_rotation(r.x, r.y, r.z, r.w);
      if (!rotation) document.fail(fmt::format("{}/ROTATION", where), kExpectedRotation);
      instances[i].rotation = *rotation;
    }
  });
  return array;
}

void set_pose(const NodePose& pose, Transform& transform) {
  if (pose.translation) transform.translation = *pose.translation;
  if (pose.rotation) transform.rotation = *pose.rotation;
  if (pose.scale) transform.scale = *pose.scale;
}

Node read_node(const tinygltf::Node& source, const GltfDocument& document, AccessorReader& accessors,
               const std::string& where) {
  Node node;
  node.name = source.name;
  node.transform = read_transform(source, document, where);
  node.children = source.children;
  node.mesh = source.mesh;
  node.camera = source.camera;
  if (const auto* light = find_extension(source.extensions, "KHR_lights_punctual")) {
    node.light = index_or_none(*light, "light");
  }
  if (const auto* shape = find_extension(source.extensions, "PARIAN_shape")) {
    node.shape = index_or_none(*shape, "shape");
    node.shape_material = index_or_none(*shape, "material");
  }
  if (const auto* visibility = find_extension(source.extensions, "KHR_node_visibility")) {
    node.visible = !visibility->Has("visible") || visibility->Get("visible").Get<bool>();
  }
  const auto* instancing = find_extension(source.extensions, "EXT_mesh_gpu_instancing");
  if (instancing && (node.mesh != kNone || node.shape != kNone)) {
    const std::string place = where + "/extensions/EXT_mesh_gpu_instancing/attributes";
    node.instances = read_instances(*instancing, document, accessors, place);
  }
  return node;
}

std::vector<int> find_roots(const GltfDocument& document) {
  if (const int scene = default_scene(document); scene != kNone)
    return document.model.scenes[std::size_t(scene)].nodes;
  std::vector<bool> has_parent(document.model.nodes.size(), false);
  for (const auto& node : document.model.nodes) {
    for (const int child : node.children) has_parent[std::size_t(child)] = true;
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < has_parent.size(); ++i) {
    if (!has_parent[i]) roots.push_back(int(i));
  }
  return roots;
}

}  // namespace

int punctual_count(const GltfDocument& document) {
  const auto* extension = find_extension(document.model.extensions, "KHR_lights_punctual");
  return extension && extension->Has("lights") ? int(extension->Get("lights").ArrayLen()) : 0;
}

int default_scene(const GltfDocument& document) {
  if (document.model.scenes.empty()) return kNone;
  return std::max(document.model.defaultScene, 0);
}

void read_nodes(const GltfDocument& document, AccessorReader& accessors, const Pose& pose, Scene& scene) {
  std::vector<Node> area_nodes;  // for nodes that have a light already
  const int first_area_light = punctual_count(document);
  for (std::size_t i = 0; i < document.model.nodes.size(); ++i) {
    const tinygltf::Node& source = document.model.nodes[i];
    Node node = read_node(source, document, accessors, fmt::format("/nodes/{}", i));
    if (const auto posed = pose.find(int(i)); posed != pose.end()) set_pose(posed->second, node.transform);
    if (node.shape != kNone && node.shape_material == kNone) {
      node.shape_material = default_material(document, scene);
    }
    if (const auto* area = find_extension(source.extensions, "EXT_lights_area")) {
      const int light = first_area_light + index_or_none(*area, "light");
      if (node.light == kNone) {
        node.light = light;
      } else {
        // A node of the scene holds one light: the second gets a child of its own.
        node.children.push_back(int(document.model.nodes.size() + area_nodes.size()));
        area_nodes.emplace_back().name = node.name;
        area_nodes.back().light = light;
      }
    }
    scene.nodes.push_back(std::move(node));
  }
  scene.nodes.insert(scene.nodes.end(), std::move_iterator(area_nodes.begin()),
                     std::move_iterator(area_nodes.end()));
  scene.roots = find_roots(document);
}

}  // namespace parian

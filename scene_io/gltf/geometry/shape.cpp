/// read_shapes().
#include <utility>

#include "scene_io/gltf/read.h"

namespace parian {
namespace {

/// Whether a node draws each of the shapes.
std::vector<bool> find_drawn(const GltfDocument& document, std::size_t shapes) {
  std::vector<bool> drawn(shapes, false);
  for (const tinygltf::Node& node : document.model.nodes) {
    const auto* use = find_extension(node.extensions, "PARIAN_shape");
    if (use) drawn[std::size_t(index_or_none(*use, "shape"))] = true;
  }
  return drawn;
}

[[noreturn]] void refuse(const std::string& type, const GltfDocument& document, const std::string& where) {
  if (type == "plane") {
    document.fail(where + "/plane",
                  "expected sizeX and sizeZ: an infinite plane cannot be drawn; use a finite plane, or a "
                  "box, as large as the scene needs");
  }
  const std::string expected = "expected sphere, cylinder, box or plane";
  document.fail(where + "/type", type == "capsule" ? expected + ": Parian draws no capsules" : expected);
}

Shape read_shape(const tinygltf::Value& source, bool is_drawn, const GltfDocument& document,
                 const std::string& where) {
  const std::string type = text_or(source, "type", "");
  // tinygltf drops an empty object, which stands for the defaults.
  const tinygltf::Value block = source.Has(type) ? source.Get(type) : tinygltf::Value();
  Shape shape;
  if (type == "sphere") {
    shape.radius = float(number_or(block, "radius", 0.5));
  } else if (type == "cylinder") {
    shape.kind = ShapeKind::cylinder;
    shape.height = float(number_or(block, "height", 0.5));
    shape.radius_bottom = float(number_or(block, "radiusBottom", 0.25));
    shape.radius_top = float(number_or(block, "radiusTop", 0.25));
  } else if (type == "box") {
    shape.kind = ShapeKind::box;
    const auto size = numbers_or(block, "size", {1, 1, 1});
    shape.size = {float(size[0]), float(size[1]), float(size[2])};
  } else if (type == "plane" && block.Has("sizeX") && block.Has("sizeZ")) {
    // Without doubleSided: what the back does is for the material to say.
    shape.kind = ShapeKind::plane;
    shape.size = {float(number_or(block, "sizeX", 1)), 1, float(number_or(block, "sizeZ", 1))};
  } else if (is_drawn) {
    refuse(type, document, where);
  }
  shape.name = text_or(source, "name", "");
  return shape;
}

}  // namespace

void read_shapes(const GltfDocument& document, Scene& scene) {
  const auto* extension = find_extension(document.model.extensions, "KHR_implicit_shapes");
  if (!extension || !extension->Has("shapes")) return;
  const auto& shapes = extension->Get("shapes").Get<tinygltf::Value::Array>();
  const std::vector<bool> drawn = find_drawn(document, shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    const std::string where = fmt::format("/extensions/KHR_implicit_shapes/shapes/{}", i);
    scene.shapes.push_back(read_shape(shapes[i], drawn[i], document, where));
  }
}

}  // namespace parian

// Shapes (KHR_implicit_shapes) and the nodes that draw them (PARIAN_shape).
#include <gtest/gtest.h>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

const std::string kShapes = "/extensions/KHR_implicit_shapes/shapes";

json draw(int shape) { return {{"extensions", {{"PARIAN_shape", {{"shape", shape}}}}}}; }

class GltfShape : public GltfTest {
 protected:
  Scene scene(const json& shapes) {
    builder.root["extensions"]["KHR_implicit_shapes"]["shapes"] = shapes;
    return load(builder.glb());
  }

  /// With every shape drawn, or none.
  std::string refused(const json& shapes, bool drawn) {
    GltfBuilder bad;
    bad.root["extensions"]["KHR_implicit_shapes"]["shapes"] = shapes;
    for (int i = 0; drawn && i < int(shapes.size()); ++i) bad.root["nodes"].push_back(draw(i));
    return refusal(bad.glb());
  }

  GltfBuilder builder;
};

TEST_F(GltfShape, ReadsEachKind) {
  const auto shapes =
      scene({{{"name", "ball"}, {"type", "sphere"}, {"sphere", {{"radius", 2}}}},
             {{"type", "cylinder"}, {"cylinder", {{"height", 3}, {"radiusBottom", 1.5}, {"radiusTop", 0}}}},
             {{"type", "box"}, {"box", {{"size", {1, 2.5, 3}}}}},
             {{"type", "plane"}, {"plane", {{"sizeX", 4}, {"sizeZ", 5.5}}}},
             {{"type", "plane"}, {"plane", {{"sizeX", 4}, {"sizeZ", 5.5}, {"doubleSided", true}}}}})
          .shapes;
  ASSERT_EQ(shapes.size(), 5u);
  EXPECT_EQ(shapes[0], (Shape{.name = "ball", .kind = ShapeKind::sphere, .radius = 2}));
  EXPECT_EQ(
      shapes[1],
      (Shape{.name = "", .kind = ShapeKind::cylinder, .radius_bottom = 1.5f, .radius_top = 0, .height = 3}));
  EXPECT_EQ(shapes[2], (Shape{.name = "", .kind = ShapeKind::box, .size = {1, 2.5f, 3}}));
  EXPECT_EQ(shapes[3].kind, ShapeKind::plane);
  EXPECT_EQ(shapes[3].size.x, 4);
  EXPECT_EQ(shapes[3].size.z, 5.5f);
  EXPECT_EQ(shapes[4], shapes[3]);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(GltfShape, ReadsDefaults) {
  const json none = json::object();
  builder.root["nodes"] = {draw(0), draw(1), draw(2)};
  const auto shapes = scene({{{"type", "sphere"}, {"sphere", none}},
                             {{"type", "cylinder"}, {"cylinder", none}},
                             {{"type", "box"}, {"box", none}},
                             {{"type", "cylinder"}, {"cylinder", {{"radiusTop", 0}}}}})
                          .shapes;
  ASSERT_EQ(shapes.size(), 4u);
  EXPECT_EQ(shapes[0], (Shape{.name = "", .kind = ShapeKind::sphere, .radius = .5f}));
  EXPECT_EQ(shapes[1], (Shape{.name = "",
                              .kind = ShapeKind::cylinder,
                              .radius_bottom = .25f,
                              .radius_top = .25f,
                              .height = .5f}));
  EXPECT_EQ(shapes[2], (Shape{.name = "", .kind = ShapeKind::box, .size = {1, 1, 1}}));
  EXPECT_EQ(shapes[3].radius_bottom, .25f);
  EXPECT_EQ(shapes[3].radius_top, 0);
}

TEST_F(GltfShape, ReadsNodes) {
  builder.root["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  builder.root["nodes"] = {draw(1), draw(0), json::object()};
  builder.root["nodes"][0]["extensions"]["PARIAN_shape"]["material"] = 1;
  builder.root["nodes"][1]["extensions"]["PARIAN_shape"]["material"] = 0;
  builder.root["extensionsRequired"] = {"KHR_implicit_shapes", "PARIAN_shape"};
  builder.root["extensionsUsed"] = builder.root["extensionsRequired"];
  const json sphere = {{"type", "sphere"}, {"sphere", json::object()}};
  const Scene s = scene({sphere, sphere});
  EXPECT_EQ(s.nodes[0].shape, 1);
  EXPECT_EQ(s.nodes[0].shape_material, 1);
  EXPECT_EQ(s.nodes[1].shape, 0);
  EXPECT_EQ(s.nodes[1].shape_material, 0);
  EXPECT_EQ(s.nodes[2], Node());
  EXPECT_EQ(s.materials.size(), 2u);
  EXPECT_TRUE(warnings.empty());
}

TEST_F(GltfShape, SharesTheDefaultMaterialWithMeshes) {
  builder.root["materials"] = {{{"name", "a"}}};
  builder.root["nodes"] = {draw(0), draw(0)};
  const json sphere = {{"type", "sphere"}, {"sphere", json::object()}};
  Scene s = scene(json::array({sphere}));
  ASSERT_EQ(s.materials.size(), 2u);
  EXPECT_EQ(s.materials[1].name, "default");
  EXPECT_EQ(s.nodes[0].shape_material, 1);
  EXPECT_EQ(s.nodes[1].shape_material, 1);
  builder.add_triangle();
  builder.root["nodes"][1]["mesh"] = 0;
  s = scene(json::array({sphere}));
  EXPECT_EQ(s.materials.size(), 2u);
  EXPECT_EQ(s.meshes[0].primitives[0].material, 1);
  EXPECT_EQ(s.nodes[1].mesh, 0);
  EXPECT_EQ(s.nodes[1].shape_material, 1);
}

TEST_F(GltfShape, ReadsInstances) {
  builder.root["nodes"] = {draw(0), json::object()};
  const int translation = builder.add<float>({1, 2, 3, 4, 5, 6}, "VEC3");
  for (json& node : builder.root["nodes"])
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = translation;
  const Scene s = scene({{{"type", "sphere"}, {"sphere", json::object()}}});
  ASSERT_EQ(s.nodes[0].instances.size(), 2u);
  EXPECT_EQ(s.nodes[0].instances[1].translation, Vec3f(4, 5, 6));
  EXPECT_TRUE(s.nodes[1].instances.empty());  // nothing to draw
}

// Engines of physics have shapes that Parian does not.
TEST_F(GltfShape, RefusesWhatItCannotDrawOnlyWhereItIsDrawn) {
  struct Case {
    json shape;
    std::string expected;
  };
  const json none = json::object();
  const std::string infinite =
      "/1/plane: expected sizeX and sizeZ: an infinite plane cannot be drawn; use a finite plane, or a box, "
      "as "
      "large as the scene needs";
  const std::vector<Case> cases = {
      {{{"type", "capsule"}, {"capsule", none}},
       "/1/type: expected sphere, cylinder, box or plane: Parian draws no capsules"},
      {{{"type", "capsule"}, {"capsule", {{"height", 1}, {"radiusTop", 2}, {"radiusBottom", 0}}}},
       "/1/type: expected sphere, cylinder, box or plane: Parian draws no capsules"},
      {{{"type", "plane"}, {"plane", none}}, infinite},
      {{{"type", "plane"}, {"plane", {{"sizeX", 1}}}}, infinite},
      {{{"type", "plane"}, {"plane", {{"sizeZ", 1}, {"doubleSided", true}}}}, infinite},
      {{{"type", "mesh"}, {"mesh", 7}}, "/1/type: expected sphere, cylinder, box or plane"},
      {{{"type", "name"}, {"name", "n"}}, "/1/type: expected sphere, cylinder, box or plane"},
      {{{"type", ""}}, "/1/type: expected sphere, cylinder, box or plane"},
  };
  const json box = {{"type", "box"}, {"box", {{"size", {1, 2, 3}}}}};
  for (const Case& c : cases) {
    EXPECT_EQ(refused({box, c.shape, box}, true), kShapes + c.expected);
    builder.root["nodes"] = {draw(2)};
    const Scene s = scene({box, c.shape, box});
    ASSERT_EQ(s.shapes.size(), 3u) << c.shape;
    Shape substitute = s.shapes[1];
    substitute.name = "";
    EXPECT_EQ(substitute, Shape()) << c.shape;
    EXPECT_EQ(s.shapes[s.nodes[0].shape], s.shapes[0]);
    EXPECT_TRUE(warnings.empty());
  }
}

TEST_F(GltfShape, RefusesMalformedShapesDrawnOrNot) {
  struct Case {
    json shape;
    std::string expected;
  };
  const json none = json::object();
  const std::vector<Case> cases = {
      {7, ": expected an object"},
      {none, "/type: expected a string"},
      {{{"type", 3}}, "/type: expected a string"},
      {{{"type", "sphere"}, {"sphere", none}, {"name", 5}}, "/name: expected a string"},
      {{{"type", "sphere"}}, "/sphere: expected an object, since type says so"},
      {{{"type", "cylinder"}}, "/cylinder: expected an object, since type says so"},
      {{{"type", "box"}}, "/box: expected an object, since type says so"},
      {{{"type", "plane"}}, "/plane: expected an object, since type says so"},
      {{{"type", "capsule"}}, "/capsule: expected an object, since type says so"},
      {{{"type", "box"}, {"sphere", none}}, "/sphere: expected no such member, since type is box"},
      {{{"type", "box"}, {"box", none}, {"capsule", none}},
       "/capsule: expected no such member, since type is box"},
      {{{"type", "sphere"}, {"sphere", 1}}, "/sphere: expected an object"},
      {{{"type", "sphere"}, {"sphere", {{"radius", 0}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "sphere"}, {"sphere", {{"radius", -1}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "sphere"}, {"sphere", {{"radius", 1e-300}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "sphere"}, {"sphere", {{"radius", 1e39}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "sphere"}, {"sphere", {{"radius", "1"}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "sphere"}, {"sphere", {{"radius", nullptr}}}}, "/sphere/radius: expected a number above 0"},
      {{{"type", "box"}, {"box", {{"size", 1}}}}, "/box/size: expected 3 numbers, each above 0"},
      {{{"type", "box"}, {"box", {{"size", {1, 1}}}}}, "/box/size: expected 3 numbers, each above 0"},
      {{{"type", "box"}, {"box", {{"size", {1, 0, 1}}}}}, "/box/size/1: expected 3 numbers, each above 0"},
      {{{"type", "box"}, {"box", {{"size", {1, 1, "1"}}}}}, "/box/size/2: expected 3 numbers, each above 0"},
      {{{"type", "cylinder"}, {"cylinder", {{"height", 0}}}}, "/cylinder/height: expected a number above 0"},
      {{{"type", "cylinder"}, {"cylinder", {{"radiusTop", -1}}}},
       "/cylinder/radiusTop: expected a number of at least 0"},
      {{{"type", "cylinder"}, {"cylinder", {{"radiusBottom", 1e39}}}},
       "/cylinder/radiusBottom: expected a number of at least 0"},
      {{{"type", "cylinder"}, {"cylinder", {{"radiusBottom", 0}, {"radiusTop", 0}}}},
       "/cylinder/radiusTop: expected a number above 0, since radiusBottom is 0"},
      {{{"type", "cylinder"}, {"cylinder", {{"radiusBottom", 0}, {"radiusTop", 1e-60}}}},
       "/cylinder/radiusTop: expected a number above 0, since radiusBottom is 0"},
      {{{"type", "capsule"}, {"capsule", {{"radiusBottom", 0}, {"radiusTop", 0}}}},
       "/capsule/radiusTop: expected a number above 0, since radiusBottom is 0"},
      {{{"type", "capsule"}, {"capsule", {{"height", -1}}}}, "/capsule/height: expected a number above 0"},
      {{{"type", "plane"}, {"plane", {{"sizeX", 0}, {"sizeZ", 1}}}},
       "/plane/sizeX: expected a number above 0"},
      {{{"type", "plane"}, {"plane", {{"sizeZ", -1}}}}, "/plane/sizeZ: expected a number above 0"},
      {{{"type", "plane"}, {"plane", {{"doubleSided", 1}}}}, "/plane/doubleSided: expected true or false"},
  };
  const json box = {{"type", "box"}, {"box", none}};
  for (const Case& c : cases) {
    const std::string expected = kShapes + "/1" + c.expected;
    for (const bool drawn : {false, true}) {
      EXPECT_EQ(refused({box, c.shape}, drawn).substr(0, expected.size()), expected) << c.shape;
    }
  }
}

// JSON has no word for these: the parser refuses them, which knows no path.
TEST_F(GltfShape, RefusesNumbersThatAreNone) {
  for (const char* number : {"1e999", "NaN", "Infinity"}) {
    const std::string text = fmt::format(
        R"({{"asset": {{"version": "2.0"}}, "extensions": {{"KHR_implicit_shapes": {{"shapes": [
            {{"type": "sphere", "sphere": {{"radius": {}}}}}]}}}}}})",
        number);
    EXPECT_NE(refusal(text, "scene.gltf").find("expected valid JSON"), std::string::npos) << number;
  }
}

TEST_F(GltfShape, RefusesMalformedNodes) {
  const std::string where = "/nodes/0/extensions/PARIAN_shape";
  const std::vector<std::pair<json, std::string>> cases = {
      {json::object(), "/shape: expected an index into " + kShapes + " (0 to 0)"},
      {7, ": expected an object"},
      {{{"shape", 1}}, "/shape: expected an index into " + kShapes + " (0 to 0)"},
      {{{"shape", -1}}, "/shape: expected an index into"},
      {{{"shape", 0.5}}, "/shape: expected an index into"},
      {{{"shape", "0"}}, "/shape: expected an index into"},
      {{{"shape", 0}, {"material", 1}}, "/material: expected an index into /materials (0 to 0)"},
      {{{"shape", 0}, {"material", nullptr}}, "/material: expected an index into"},
  };
  builder.root["materials"] = {json::object()};
  builder.root["extensions"]["KHR_implicit_shapes"]["shapes"] = {{{"type", "box"}, {"box", json::object()}}};
  for (const auto& [extension, expected] : cases) {
    builder.root["nodes"] = {{{"extensions", {{"PARIAN_shape", extension}}}}};
    EXPECT_EQ(refusal(builder.glb()).substr(0, where.size() + expected.size()), where + expected);
  }
  builder.root.erase("extensions");
  builder.root["nodes"] = {draw(0)};
  EXPECT_EQ(refusal(builder.glb()),
            where + "/shape: expected an index into " + kShapes + " (which is empty)");
}

}  // namespace
}  // namespace parian

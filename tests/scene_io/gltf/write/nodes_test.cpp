// Nodes of a file that change, and new bytes beside those of the file.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteChanged : public WriteTest {
 protected:
  GltfBuilder builder_;
};

// Caught: rotations that are near what they were, left as they were; a matrix beside them.
TEST_F(WriteChanged, TransformsByTheLastBit) {
  builder_.root["nodes"] = {{{"rotation", {0, 0, 0.6, 0.8}}},
                            {{"matrix", {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 3, 0, 1}}}};
  builder_.root["scenes"] = {{{"nodes", {0, 1}}}};
  Loaded loaded = load_source(builder_);
  float& z = loaded.scene.nodes[0].transform.rotation.v.z;
  z = std::nextafter(z, 1.0f);
  Transform& was_matrix = loaded.scene.nodes[1].transform;
  ASSERT_TRUE(was_matrix.matrix);
  was_matrix = {};
  was_matrix.translation = {0, 3, 0};
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  EXPECT_EQ(written(loaded)["nodes"][1], json::parse(R"({"translation": [0, 3, 0]})"));
}

// Caught: attributes of the file for as many instances as there were.
TEST_F(WriteChanged, InstancesOfAnotherNumber) {
  builder_.add_triangle();
  json attributes;
  attributes["TRANSLATION"] = builder_.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  attributes["_NUMBER"] = builder_.add<float>({7, 8}, "SCALAR");
  builder_.root["nodes"] = {{{"mesh", 0}}};
  builder_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  builder_.use_extension("EXT_mesh_gpu_instancing");
  Loaded loaded = load_source(builder_);
  const auto attributes_of = [&] {
    return written(loaded)["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  };
  SharedArray<InstanceTransform>& instances = loaded.scene.nodes[0].instances;
  std::vector<InstanceTransform> places(instances.begin(), instances.end());
  ASSERT_EQ(places.size(), 2u);
  places[1].translation.x = 3;
  instances = places;
  EXPECT_TRUE(attributes_of().contains("_NUMBER")) << "as many as before";
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  places.push_back(places[0]);
  instances = places;
  EXPECT_FALSE(attributes_of().contains("_NUMBER"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: new bytes that begin where others end; bytes of the file in their place.
TEST_F(WriteChanged, NewBytesBesideThoseOfTheFile) {
  builder_.add_triangle()["material"] = 0;
  std::string image = png(path("p.png"));
  image.resize(image.size() + 5 - image.size() % 4);  // what follows the end of a PNG is nobody's
  builder_.root["images"] = {{{"bufferView", builder_.add_bytes(image)}, {"mimeType", "image/png"}}};
  builder_.root["textures"] = {{{"source", 0}}};
  builder_.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  builder_.root["nodes"] = {{{"mesh", 0}}};
  Loaded loaded = load_source(builder_);
  loaded.scene.meshes[0].primitives[0].positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  for (const char* name : {"x.glb", "x.gltf"}) EXPECT_EQ(again(loaded, name).scene, loaded.scene);
  const json root = written(loaded);
  ASSERT_EQ(root["bufferViews"].size(), 2u) << "the image and positions";
  EXPECT_EQ(root["bufferViews"][0]["byteLength"].get<std::size_t>() % 4, 1u);
  for (const json& view : root["bufferViews"])
    EXPECT_EQ(view.value("byteOffset", std::size_t(0)) % 4, 0u) << view;
}

// Caught: ranges that begin at 0, though what is aligned in them began at 2.
TEST_F(WriteChanged, BytesAreAlignedAsTheyWere) {
  builder_.add_triangle();
  builder_.binary = "abcd" + builder_.binary;
  builder_.root["bufferViews"][0].update({{"byteOffset", 2}, {"byteLength", 38}});
  builder_.root["accessors"][0]["byteOffset"] = 2;
  builder_.root["nodes"] = {{{"mesh", 0}}};
  const Loaded loaded = load_source(builder_);
  EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions[1], Vec3f(1, 0, 0));
  EXPECT_EQ(written(loaded)["bufferViews"][0]["byteOffset"].get<std::size_t>() % 4, 2u);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// 65535 as an index of 16 bits would begin a new primitive. Caught: indices too narrow by one.
TEST_F(WriteChanged, IndicesAreWideEnough) {
  for (const std::size_t vertices : {65535u, 65536u}) {
    Scene scene;
    scene.materials.emplace_back();
    Primitive p;
    std::vector<Vec3f> positions(vertices, Vec3f(1));
    positions[0] = Vec3f(0);
    p.positions = positions;
    p.triangles = std::vector<Triangle>{{0, 1, std::uint32_t(vertices - 1)}};
    p.material = 0;
    scene.meshes = {{.name = "", .primitives = {p}}};
    const Loaded made{scene, {}};
    const json root = written(made);
    const std::size_t indices = root["meshes"][0]["primitives"][0]["indices"];
    EXPECT_EQ(root["accessors"][indices]["componentType"], vertices == 65535 ? 5123 : 5125);
  }
}

// Caught: what only the kind had that they were before.
TEST_F(WriteChanged, CamerasAndLightsOfAnotherKind) {
  Scene scene;
  scene.cameras.resize(1);
  scene.lights.resize(1);
  scene.lights[0].kind = LightKind::spot;
  scene.lights[0].outer_angle = 0.2f;
  scene.nodes.resize(1);
  scene.nodes[0].camera = scene.nodes[0].light = 0;
  scene.roots = {0};
  Loaded loaded = again({scene, {}}, "first.glb");
  loaded.scene.cameras[0].projection = Projection::orthographic;
  loaded.scene.lights[0].kind = LightKind::point;
  const json root = written(loaded);
  EXPECT_FALSE(root["cameras"][0].contains("perspective"));
  EXPECT_TRUE(root["cameras"][0].contains("orthographic"));
  EXPECT_FALSE(root["extensions"]["KHR_lights_punctual"]["lights"][0].contains("spot"));
}

// Caught: a mirrored wrap as a plain one; a filter that can only become nearest.
TEST_F(WriteChanged, Samplers) {
  builder_.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(path("p.png")))}}};
  builder_.root["samplers"] = {{{"magFilter", 9728}, {"wrapS", 33071}}};
  builder_.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  builder_.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  Loaded loaded = load_source(builder_);
  loaded.scene.textures[0].filter = Filter::linear;
  loaded.scene.textures[0].wrap_s = Wrap::mirrored_repeat;
  EXPECT_EQ(again(loaded).scene.textures, loaded.scene.textures);
}

}  // namespace
}  // namespace parian

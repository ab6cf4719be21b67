// Broken documents: each is refused with the place and what was expected there, and nothing worse ever
// happens.
#include <gtest/gtest.h>

#include <random>

#include "tests/scene_io/support/gltf_builder.h"
#include "tests/scene_io/support/material_mutations.h"

namespace parian {
namespace {

// A document with something of everything that the reader reads.
class GltfBroken : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    builder_.root = R"({
      "asset": {"version": "2.0"},
      "extensionsUsed": ["KHR_texture_transform"],
      "materials": [{
        "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0, "roughnessFactor": 0.5,
          "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 1]}}}},
        "normalTexture": {"index": 0, "scale": 2},
        "emissiveFactor": [0, 0, 1], "alphaMode": "MASK", "alphaCutoff": 0.5,
        "extensions": {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_specular": {"specularFactor": 1},
                       "KHR_materials_emissive_strength": {"emissiveStrength": 2}}}, {
        "extensions": {
          "KHR_materials_transmission": {"transmissionFactor": 1, "transmissionTexture": {"index": 0}},
          "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
            "attenuationColor": [0.5, 0.6, 0.7], "thicknessTexture": {"index": 0}},
          "KHR_materials_volume_scatter": {"multiscatterColor": [0.1, 0.2, 0.3], "scatterAnisotropy": 0.5},
          "KHR_materials_dispersion": {"dispersion": 1},
          "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
            "diffuseTransmissionTexture": {"index": 0}, "diffuseTransmissionColorFactor": [1, 1, 0],
            "diffuseTransmissionColorTexture": {"index": 0}},
          "KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0},
            "clearcoatRoughnessFactor": 0.5, "clearcoatRoughnessTexture": {"index": 0},
            "clearcoatNormalTexture": {"index": 0, "scale": 1}},
          "KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1], "sheenColorTexture": {"index": 0},
            "sheenRoughnessFactor": 0.5, "sheenRoughnessTexture": {"index": 0}},
          "KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyRotation": 1,
            "anisotropyTexture": {"index": 0}},
          "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceTexture": {"index": 0},
            "iridescenceIor": 1.5, "iridescenceThicknessMinimum": 100, "iridescenceThicknessMaximum": 200,
            "iridescenceThicknessTexture": {"index": 0}},
          "PARIAN_materials_phong": {"diffuse": [0, 0, 0], "specular": [1, 1, 1], "exponent": 9},
          "PARIAN_materials_priority": {"priority": -3}}}, {
        "extensions": {
          "PARIAN_materials_conductor": {"eta": [1, 2, 3], "k": [4, 5, 6]}}}, {
        "extensions": {
          "PARIAN_materials_conductor": {"name": "gold"}}}, {
        "extensions": {
          "PARIAN_materials_subsurface": {"sigmaA": [0, 1, 2], "sigmaSPrime": [3, 4, 5], "eta": 1.4,
            "scale": 10}}}, {
        "extensions": {
          "PARIAN_materials_subsurface": {"name": "marble", "scale": 10}}}],
      "textures": [{"source": 0, "sampler": 0}],
      "samplers": [{"wrapS": 33071, "magFilter": 9728}],
      "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1, "zfar": 10},
                   "extensions": {"EXT_camera_physical": {"focalLength": 0.05, "sensorSize": [0.036, 0.024],
                                                          "fStop": 2, "focusDistance": 3}}},
                  {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 1}}],
      "nodes": [{"mesh": 0, "children": [1, 2], "scale": [1, 2, 3]},
                {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0},
                                             "PARIAN_shape": {"shape": 1, "material": 0}}},
                {"camera": 1, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
                 "extensions": {"EXT_lights_area": {"light": 0}}}],
      "scenes": [{"nodes": [0], "extensions": {"EXT_lights_environment": {"environment": 0}}}],
      "scene": 0,
      "extensions": {
        "KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "range": 1,
                                            "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}}]},
        "EXT_lights_area": {"lights": [{"type": "rect", "size": 1, "rect": {"aspect": 2}}]},
        "KHR_implicit_shapes": {"shapes": [
          {"type": "sphere", "sphere": {"radius": 1}},
          {"type": "cylinder", "cylinder": {"height": 2, "radiusBottom": 1, "radiusTop": 0}},
          {"type": "box", "box": {"size": [1, 2, 3]}},
          {"type": "plane", "plane": {"sizeX": 1, "sizeZ": 2, "doubleSided": true}},
          {"type": "capsule", "capsule": {}}]},
        "EXT_lights_environment": {"environments": [{"source": 0, "intensity": 1, "frontside": "+Z"}]}}
    })"_json;
    json& mesh = builder_.add_triangle();  // accessor 0, bufferView 0
    const int normals = builder_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int indices = builder_.add<std::uint16_t>({0, 1, 2}, "SCALAR");
    const int uvs = builder_.add<std::uint8_t>({0, 0, 0, 0, 255, 0, 0, 0, 0, 255, 0, 0}, "VEC4", true);
    builder_.root["accessors"][3]["type"] = "VEC2";  // 2 of 4 bytes
    builder_.root["bufferViews"][3]["byteStride"] = 4;
    mesh["attributes"].update({{"NORMAL", normals}, {"TEXCOORD_0", uvs}});
    mesh["indices"] = indices;
    mesh["material"] = 0;
    const int positions = builder_.add_view<std::uint8_t>({1});
    const int values = builder_.add_view<float>({2, 0, 0});
    builder_.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", positions}, {"componentType", 5121}}},
        {"values", {{"bufferView", values}}}};
    builder_.root["images"] = {{{"bufferView", builder_.add_bytes(png(path("scratch.png")))}}};
    builder_.root["buffers"] = {{{"byteLength", builder_.binary.size()}}};
    const int instances = builder_.add<float>({0, 0, 0, 2, 0, 0}, "VEC3");
    builder_.root["buffers"][0]["byteLength"] = builder_.binary.size();
    builder_.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        instances;
  }

  GltfBuilder builder_;
};

TEST_F(GltfBroken, IsWholeWhenLeftAlone) {
  EXPECT_EQ(refusal(builder_.glb()), "");
  EXPECT_EQ(warnings, std::vector<std::string>());
}

std::vector<Mutation> structure_mutations() {
  return {
      {"/asset", kRemoved},
      {"/asset", nullptr},
      {"/asset/version", "1.0"},
      {"/asset/version", 2.0},
      {"/asset/minVersion", "2.1"},
      {"/accessors", json::object(), "/accessors: expected an array of objects"},
      {"/accessors/0", 7, "/accessors/0: expected an object"},
      {"/accessors/0/bufferView", 99},
      {"/accessors/0/bufferView", -1},
      {"/accessors/0/bufferView", "0"},
      {"/accessors/0/bufferView", 0.5},
      {"/accessors/0/byteOffset", -4},
      {"/accessors/0/byteOffset", 4, "/accessors/0/count"},
      {"/accessors/0/byteOffset", 1e18,
       "/accessors/0/byteOffset: expected an integer from 0 to 9007199254740992"},
      {"/accessors/0/byteOffset", 9007199254740992, "/accessors/0/count"},
      {"/accessors/0/componentType", 5124},
      {"/accessors/0/componentType", kRemoved},
      {"/accessors/0/count", 4},
      {"/accessors/0/count", 0},
      {"/accessors/0/count", 18446744073709551615u},
      {"/accessors/0/count", kRemoved},
      {"/accessors/0/type", "VEC5"},
      {"/accessors/0/type", "VEC4", "/accessors/0/count"},
      {"/accessors/0/normalized", 1},
      {"/accessors/0/sparse", 1},
      {"/accessors/0/sparse/count", 4},
      {"/accessors/0/sparse/count", 2, "/accessors/0/sparse/indices: expected 2 elements"},
      {"/accessors/0/sparse/indices", kRemoved},
      {"/accessors/0/sparse/indices/byteOffset", 1, "/accessors/0/sparse/indices"},
      {"/accessors/0/sparse/indices/componentType", 5126},
      {"/accessors/0/sparse/indices/bufferView", 77},
      {"/accessors/0/sparse/values/byteOffset", 1, "/accessors/0/sparse/values"},
      {"/accessors/2/bufferView", kRemoved,
       "/meshes/0/primitives/0/indices: expected an accessor with a bufferView"},
      {"/accessors/2/componentType", 5126, "/accessors/2/count"},
      {"/accessors/2/componentType", 5122, "/meshes/0/primitives/0/indices"},
      {"/bufferViews/0/buffer", 1},
      {"/bufferViews/0/buffer", kRemoved},
      {"/bufferViews/0/byteOffset", 1000000, "/bufferViews/0/byteLength"},
      {"/bufferViews/0/byteLength", 1000000},
      {"/bufferViews/0/byteLength", 35, "/accessors/0/count"},
      {"/bufferViews/0/byteStride", 8, "/bufferViews/0/byteStride: expected at least 12"},
      {"/bufferViews/0/byteStride", 16, "/accessors/0/count"},
      {"/bufferViews/0/byteStride", 14, "/bufferViews/0/byteStride: expected a multiple of 4"},
      {"/bufferViews/0/byteStride", 256},
      {"/buffers/0/byteLength", 1000000},
      {"/buffers/0/byteLength", kRemoved},
      {"/buffers/0/uri", 3},
      {"/buffers/0/uri", "absent.bin"},
      {"/buffers/1", {{"byteLength", 1}}, "/buffers/1/uri: expected a string"},
      {"/meshes/0/primitives", kRemoved},
      {"/meshes/0/primitives/0/attributes", kRemoved},
      {"/meshes/0/primitives/0/attributes/POSITION", 50},
      {"/meshes/0/primitives/0/attributes/NORMAL", 2},
      {"/meshes/0/primitives/0/attributes/JOINTS_0", nullptr},
      {"/meshes/0/primitives/0/indices", 0},
      {"/meshes/0/primitives/0/material", 6},
      {"/meshes/0/primitives/0/mode", 7},
      {"/nodes/0/mesh", 1},
      {"/nodes/0/children", 1, "/nodes/0/children: expected an array of indices"},
      {"/nodes/0/children/0", 3},
      {"/nodes/0/children/0", 0, "/scenes/0/nodes/0: expected a node without a parent"},
      {"/nodes/1/camera", 2},
      {"/nodes/1/extensions/KHR_lights_punctual/light", 1},
      {"/nodes/1/extensions/KHR_lights_punctual/light", kRemoved},
      {"/nodes/2/extensions/EXT_lights_area/light", 1},
      {"/nodes/1/extensions/PARIAN_shape", 1},
      {"/nodes/1/extensions/PARIAN_shape/shape", kRemoved},
      {"/nodes/1/extensions/PARIAN_shape/shape", 5},
      {"/nodes/1/extensions/PARIAN_shape/shape", 4, "/extensions/KHR_implicit_shapes/shapes/4/type"},
      {"/nodes/1/extensions/PARIAN_shape/material", 6},
      {"/extensions/KHR_implicit_shapes/shapes", kRemoved, "/nodes/1/extensions/PARIAN_shape/shape"},
      {"/extensions/KHR_implicit_shapes/shapes/0/type", kRemoved},
      {"/extensions/KHR_implicit_shapes/shapes/0/sphere", kRemoved},
      {"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION", 3},
      {"/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION", 99},
      {"/nodes/0/name", 5},
      {"/scenes/0/nodes/0", 3},
      {"/scenes/0/extensions/EXT_lights_environment/environment", 1},
      {"/scene", 1},
      {"/textures/0/source", 1},
      {"/textures/0/sampler", 1},
      {"/images/0/bufferView", 99},
      {"/images/0/bufferView", 0, "/images/0"},
      {"/images/0/uri", "a.png", "/images/0"},
      {"/extensions/EXT_lights_environment/environments/0/source", 1},
      {"/extensionsUsed", "KHR_texture_transform"},
      {"/extensionsUsed/0", 3},
      {"/extensionsRequired",
       {"KHR_materials_unlit", "ACME_magic"},
       "/extensionsRequired/1: expected an extension that Parian reads, ACME_magic is not one"},
      {"/extensionsRequired", {"KHR_texture_basisu"}, "/extensionsRequired/0: expected"},
      {"/extensionsRequired", {1}, "/extensionsRequired/0: expected a string"},
  };
}

std::vector<Mutation> number_mutations() {
  return {
      {"/materials/0/pbrMetallicRoughness", 1},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor", {1, 1, 1}},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor/1", 1.5},
      {"/materials/0/pbrMetallicRoughness/baseColorFactor/1", "1"},
      {"/materials/0/pbrMetallicRoughness/metallicFactor", -0.1},
      {"/materials/0/pbrMetallicRoughness/roughnessFactor", 1.1},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 1},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", kRemoved},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", -1},
      {"/materials/0/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/offset/0", 1e39},
      {"/materials/0/normalTexture/scale", "x"},
      {"/materials/0/emissiveFactor/0", 2},
      {"/materials/0/alphaMode", "GLASS"},
      {"/materials/0/alphaCutoff", -1},
      {"/materials/0/doubleSided", 1},
      {"/materials/0/extensions", json::array()},
      {"/materials/0/extensions/KHR_materials_ior/ior", 0.5,
       "/materials/0/extensions/KHR_materials_ior/ior: expected 0 or a number of at least 1"},
      {"/materials/0/extensions/KHR_materials_ior/ior", -1},
      {"/materials/0/extensions/KHR_materials_specular/specularFactor", 1.5},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", -1},
      {"/materials/0/extensions/KHR_materials_emissive_strength/emissiveStrength", 1e300},
      {"/samplers/0/wrapS", 1},
      {"/samplers/0/magFilter", 9984},
      {"/cameras/0/type", "fisheye"},
      {"/cameras/0/type", "orthographic", "/cameras/0/orthographic: expected an object, since type says so"},
      {"/cameras/0/perspective/yfov", 0},
      {"/cameras/0/perspective/yfov", 3.15},
      {"/cameras/0/perspective/yfov", kRemoved},
      {"/cameras/0/perspective/aspectRatio", 0},
      {"/cameras/0/perspective/zfar", 0.05},
      {"/cameras/0/extensions/EXT_camera_physical/fStop", 0},
      {"/cameras/0/extensions/EXT_camera_physical/sensorSize/1", 0},
      {"/cameras/0/extensions/EXT_camera_physical/focusDistance", -1},
      {"/cameras/1/orthographic/xmag", 0},
      {"/cameras/1/orthographic/zfar", kRemoved},
      {"/nodes/0/scale/2", nullptr},
      {"/nodes/0/scale", {1, 2}},
      {"/nodes/2/matrix/7", 1},
      {"/extensions/KHR_lights_punctual/lights", kRemoved, "/nodes/1/extensions/KHR_lights_punctual/light"},
      {"/extensions/KHR_lights_punctual/lights/0/type", "laser"},
      {"/extensions/KHR_lights_punctual/lights/0/color/2", -1},
      {"/extensions/KHR_lights_punctual/lights/0/intensity", -1},
      {"/extensions/KHR_lights_punctual/lights/0/range", 0},
      {"/extensions/KHR_lights_punctual/lights/0/spot", kRemoved},
      {"/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", 2},
      {"/extensions/KHR_lights_punctual/lights/0/spot/innerConeAngle", 0.3},
      {"/extensions/EXT_lights_area/lights/0/type", "sphere"},
      {"/extensions/EXT_lights_area/lights/0/size", 0},
      {"/extensions/EXT_lights_area/lights/0/rect/aspect", -1},
      {"/extensions/KHR_implicit_shapes/shapes/0/sphere/radius", 0},
      {"/extensions/KHR_implicit_shapes/shapes/1/cylinder/radiusBottom", 0,
       "/extensions/KHR_implicit_shapes/shapes/1/cylinder/radiusTop"},
      {"/extensions/KHR_implicit_shapes/shapes/2/box/size/1", -2},
      {"/extensions/KHR_implicit_shapes/shapes/3/plane/sizeZ", 1e39},
      {"/extensions/EXT_lights_environment/environments/0/intensity", -1},
      {"/extensions/EXT_lights_environment/environments/0/frontside", "+Y"},
  };
}

void remove(json& root, const json::json_pointer& place) {
  json& parent = root.at(place.parent_pointer());
  if (parent.is_array()) parent.erase(std::stoul(place.back()));
  if (parent.is_object()) parent.erase(place.back());
}

TEST_F(GltfBroken, IsRefusedWithThePlace) {
  std::vector<Mutation> mutations = structure_mutations();
  for (Mutation& mutation : number_mutations()) mutations.push_back(std::move(mutation));
  for (Mutation& mutation : material_extension_mutations()) mutations.push_back(std::move(mutation));
  for (const Mutation& mutation : mutations) {
    GltfBuilder broken = builder_;
    const json::json_pointer place(mutation.place);
    if (mutation.value == kRemoved) {
      remove(broken.root, place);
    } else {
      broken.root[place] = mutation.value;
    }
    const std::string expected =
        mutation.expected.empty() ? mutation.place + ": expected" : mutation.expected;
    const std::string message = refusal(broken.glb());
    EXPECT_EQ(message.substr(0, expected.size()), expected)
        << mutation.place << " = " << mutation.value << ": " << message;
  }
}

TEST_F(GltfBroken, WarnsOfWhatItIgnores) {
  builder_.root["extensionsUsed"] = {"KHR_materials_ior", "ACME_magic", "ACME_magic",
                                     "KHR_materials_variants"};
  EXPECT_EQ(refusal(builder_.glb()), "");
  const std::string file = path("scene.glb");
  EXPECT_EQ(warnings,
            (std::vector<std::string>{file + ": ACME_magic is not supported and is ignored",
                                      file + ": KHR_materials_variants is not supported and is ignored"}));
}

TEST_F(GltfBroken, RefusesEveryPrefix) {
  const std::string glb = builder_.glb();
  for (std::size_t size = 0; size < glb.size(); size += 3)
    EXPECT_NE(refusal(glb.substr(0, size)), "") << size;
}

// Any exception but InputError ends the test, as does a crash; the sanitizer build sees what this one does
// not.
TEST_F(GltfBroken, SurvivesFlippedBytes) {
  const std::string good = builder_.glb();
  std::mt19937 random(1);
  int refused = 0;
  constexpr int kRounds = 2000;
  for (int i = 0; i < kRounds; ++i) {
    std::string bad = good;
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips) {
      bad[random() % bad.size()] = char(random());
    }
    refused += !refusal(bad).empty();
  }
  EXPECT_GT(refused, kRounds / 2);
}

// Values of every kind in every place: these get further than flipped bytes, which mostly break the JSON.
TEST_F(GltfBroken, SurvivesMisplacedValues) {
  const json flat = builder_.root.flatten();
  std::vector<json::json_pointer> places;
  for (const auto& [key, value] : flat.items()) {
    for (json::json_pointer place(key); !place.empty(); place.pop_back()) places.push_back(place);
  }
  const std::vector<json> values = {nullptr,
                                    true,
                                    0,
                                    1,
                                    -1,
                                    2,
                                    3,
                                    255,
                                    65535,
                                    2147483647,
                                    4294967295,
                                    9007199254740991,
                                    18446744073709551615u,
                                    0.5,
                                    1e38,
                                    -1e38,
                                    1e300,
                                    "",
                                    "x",
                                    json::array(),
                                    json::object(),
                                    {0},
                                    {{"x", 0}},
                                    kRemoved};
  std::mt19937 random(1);
  int refused = 0;
  constexpr int kRounds = 2000;
  for (int i = 0; i < kRounds; ++i) {
    GltfBuilder bad = builder_;
    const json::json_pointer& place = places[random() % places.size()];
    const json& value = values[random() % values.size()];
    if (value == kRemoved) {
      remove(bad.root, place);
    } else {
      bad.root[place] = value;
    }
    refused += !refusal(bad.glb()).empty();
  }
  EXPECT_GT(refused, kRounds / 2);
}

}  // namespace
}  // namespace parian

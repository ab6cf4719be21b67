// Materials with all that they can have, and their textures.
#include <gtest/gtest.h>

#include "scene_io/gltf/write/texture_use.h"
#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteMaterials : public WriteTest {
 protected:
  /// One material, and the textures that it uses, in the order of their use.
  Scene scene_of(const Material& material) {
    Scene scene;
    scene.materials = {material};
    for_each_texture(scene.materials[0], [&](TextureRef& ref) {
      if (!ref) return;
      const std::string file = fmt::format("t{}.png", scene.images.size());
      write(file, png(path("p.png"), int(scene.images.size()) + 1, 2));
      ref.texture = int(scene.textures.size());
      scene.textures.emplace_back().image = int(scene.images.size());
      scene.images.push_back(read_image(path(file)));
    });
    return scene;
  }

  json material_of(const Material& material) { return written({scene_of(material), {}})["materials"][0]; }

  /// Read as written; and written from its source with one value after the other.
  void expect_read(const Material& material) {
    const Scene scene = scene_of(material);
    const Loaded loaded = again({scene, {}}, "first.glb");
    EXPECT_EQ(loaded.scene.materials, scene.materials);
    EXPECT_EQ(again(loaded).scene, loaded.scene);
    Loaded plain = loaded;
    plain.scene.materials[0] = Material();
    plain.scene.materials[0].origin = material.origin;
    EXPECT_EQ(again(plain).scene.materials, plain.scene.materials);
    Loaded cleared = loaded;
    Material empty;
    empty.origin = loaded.scene.materials[0].origin;
    cleared.scene.materials[0] = empty;
    EXPECT_EQ(again(cleared).scene.materials[0], empty) << "what the file has is taken away";
    Loaded changed = load_with_source([&] {
      write_gltf(cleared.scene, cleared.sources, path("cleared.glb"));
      return path("cleared.glb");
    }());
    const Origin origin = changed.scene.materials[0].origin;
    changed.scene.materials = scene.materials;
    changed.scene.materials[0].origin = origin;
    changed.scene.textures = scene.textures;
    changed.scene.images = scene.images;
    EXPECT_EQ(again(changed).scene.materials, scene.materials);
  }
};

const TextureRef kUsed{.texture = 0};

Material full() {
  Material m;
  m.name = "full";
  m.base_color = {0.1f, 0.2f, 0.3f};
  m.alpha = 0.4f;
  m.metallic = 0.7f;
  m.roughness = 0.9f;
  m.normal_scale = 0.3f;
  m.emission = {17.3f, 0.1f, 4};
  m.specular = 0.6f;
  m.specular_color = {0.9f, 1.7f, 0};
  m.transmission = Transmission{.factor = 0.1f, .texture = kUsed};
  m.volume = Volume{.thickness = 0.7f, .attenuation_color = {0.1f, 0.9f, 1}, .attenuation_distance = 0.3f};
  m.scatter = VolumeScatter{.multiscatter_color = {0.1f, 0.2f, 0.7f}, .anisotropy = -0.3f};
  m.diffuse_transmission =
      DiffuseTransmission{.factor = 0.3f, .color = {1, 0.1f, 0}, .texture = kUsed, .color_texture = kUsed};
  m.clearcoat = Clearcoat{.factor = 1,
                          .roughness = 0.3f,
                          .texture = kUsed,
                          .roughness_texture = kUsed,
                          .normal_texture = kUsed,
                          .normal_scale = 0.7f};
  m.sheen = SheenModel{
      .color = {0.7f, 0, 1}, .roughness = 0.1f, .color_texture = kUsed, .roughness_texture = kUsed};
  m.anisotropy = Anisotropy{.strength = 0.3f, .rotation = -1.1f, .texture = kUsed};
  m.iridescence = Iridescence{.factor = 1,
                              .ior = 1.7f,
                              .thickness_minimum = 10.1f,
                              .thickness_maximum = 700,
                              .texture = kUsed,
                              .thickness_texture = kUsed};
  m.ior = 1.33f;
  m.dispersion = 0.1f;
  m.priority = -3;
  m.alpha_mode = AlphaMode::mask;
  m.alpha_cutoff = 0.3f;
  m.double_sided = true;
  for_each_texture(m, [](TextureRef& ref) { ref = kUsed; });
  m.base_color_texture.uv_set = 1;
  return m;
}

TEST_F(WriteMaterials, WithAllExtensions) { expect_read(full()); }

TEST_F(WriteMaterials, InPlaceOfMetallicRoughness) {
  Material m;
  m.phong = PhongModel{.diffuse = {0.1f, 0.3f, 0.7f}, .specular = {0, 0, 0.1f}, .exponent = 33.3f};
  expect_read(m);
  m = {};
  m.conductor = ConductorModel{.eta = {0.1f, 1.3f, 2}, .k = {3.3f, 0, 1}};
  expect_read(m);
  m = {};
  m.subsurface =
      SubsurfaceModel{.absorption = {3, 0.123f, 46}, .reduced_scattering = {2290, 2390, 1970.123f}};
  m.ior = 1.3f;
  expect_read(m);
  m = {};
  m.unlit = true;
  expect_read(m);
}

TEST_F(WriteMaterials, SayOnlyWhatIsNotTheDefault) {
  EXPECT_EQ(material_of(Material()), json::object());
  Material m;
  m.transmission.emplace().factor = 0.1f;
  EXPECT_EQ(material_of(m).dump(),
            R"({"extensions":{"KHR_materials_transmission":{"transmissionFactor":0.1}}})");
}

// Any float comes back from the factor and the strength.
TEST_F(WriteMaterials, EmissionOfAnyStrength) {
  for (const float strength : {1e-30f, 0.9f, 1.0f, 1.1f, 3.3f, 12345.67f, 3e30f}) {
    Material m;
    m.emission = Rgb(0.7f, 0.123f, 1) * strength;
    EXPECT_EQ(again({scene_of(m), {}}).scene.materials[0].emission, m.emission) << strength;
  }
}

// In the words of the file, as long as they are right.
TEST_F(WriteMaterials, KeepNamesAndTransforms) {
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(path("p.png")))}}};
  builder.root["textures"] = {{{"source", 0}}};
  const json use = {
      {"index", 0},
      {"extensions", {{"KHR_texture_transform", {{"rotation", 0.3}, {"scale", {2, 3}}, {"texCoord", 1}}}}}};
  builder.root["materials"] = {
      {{"extensions", {{"PARIAN_materials_subsurface", {{"name", "marble"}, {"scale", 10}}}}},
       {"normalTexture", use}},
      {{"extensions", {{"PARIAN_materials_conductor", {{"name", "gold"}}}}}},
      {{"emissiveFactor", {0.5, 1, 0.25}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7}}}}}}};
  Loaded loaded = load_source(builder);
  for (Material& material : loaded.scene.materials) material.roughness = 0.5f;
  json root = written(loaded);
  for (json& material : root["materials"]) {
    EXPECT_EQ(material["pbrMetallicRoughness"]["roughnessFactor"], 0.5);
    material.erase("pbrMetallicRoughness");
  }
  EXPECT_EQ(root["materials"], builder.root["materials"]);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  loaded.scene.materials[0].subsurface->absorption *= 0.3f;
  loaded.scene.materials[1].conductor->k.x = 3;
  loaded.scene.materials[2].emission = {0.1f, 0, 0};
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

TEST_F(WriteMaterials, TextureTransforms) {
  const auto expect_near = [](const std::array<float, 6>& map) {
    const auto t = decompose(map);
    ASSERT_TRUE(t);
    const double c = std::cos(t->rotation), s = std::sin(t->rotation);
    const double again[] = {c * t->scale[0],  s * t->scale[1], t->offset[0],
                            -s * t->scale[0], c * t->scale[1], t->offset[1]};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(again[i], map[i], 1e-6);
  };
  expect_near({2, 0, 0.1f, 0, -3, 0.2f});
  expect_near({0, 1, 0, -1, 0, 0});
  expect_near({0.6f, 1.6f, 3, -0.8f, 1.2f, 4});
  expect_near({0.6f, -1.6f, 3, -0.8f, -1.2f, 4});
  EXPECT_FALSE(decompose({1, 0.5f, 0, 0, 1, 0}));
  Material m;
  m.base_color_texture = kUsed;
  m.base_color_texture.transform = {2, 0, 0.1f, 0, -3, 0.2f};
  expect_read(m);
  m.base_color_texture.transform = {1, 0.5f, 0, 0, 1, 0};
  EXPECT_THROW(written({scene_of(m), {}}), InputError);
}

// A texture that is changed leaves the file's to those whom Parian does not read.
TEST_F(WriteMaterials, ChangedTexturesAndSamplers) {
  GltfBuilder builder;
  builder.root["images"] = {{{"name", "i"}, {"uri", "data:image/png;base64," + base64(png(path("p.png")))}}};
  builder.root["samplers"] = {{{"minFilter", 9987}, {"name", "s"}}};
  builder.root["textures"] = {{{"source", 0}, {"sampler", 0}, {"name", "t"}}};
  builder.root["materials"] = {{{"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}},
                                {"occlusionTexture", {{"index", 0}}}}};
  Loaded loaded = load_source(builder);
  loaded.scene.textures[0].wrap_t = Wrap::clamp_to_edge;
  loaded.scene.textures[0].filter = Filter::nearest;
  const json root = written(loaded);
  EXPECT_EQ(root["materials"][0]["occlusionTexture"]["index"], 0);
  EXPECT_EQ(root["textures"][0], builder.root["textures"][0]);
  EXPECT_EQ(root["textures"][1]["name"], "t");
  EXPECT_EQ(root["samplers"][1],
            json::parse(R"({"minFilter": 9987, "name": "s", "wrapT": 33071, "magFilter": 9728})"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  // Another image, from a file: what nothing uses any more is gone.
  loaded.scene.materials.resize(1);
  write("other.png", png(path("p.png"), 5, 1));
  loaded.scene.images[0] = read_image(path("other.png"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: no rotation; the file's set of coordinates or its transform where there is to be none.
TEST_F(WriteMaterials, UsesOfTexturesThatChange) {
  Material m;
  m.normal_texture = kUsed;
  m.normal_texture.uv_set = 1;
  m.normal_texture.transform = {0.6f, 1.6f, 3, -0.8f, 1.2f, 4};
  Loaded loaded = again({scene_of(m), {}}, "first.glb");
  TextureRef& use = loaded.scene.materials[0].normal_texture;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(use.transform[i], m.normal_texture.transform[i], 1e-6f);
  use.uv_set = 0;
  use.transform = TextureRef().transform;
  EXPECT_EQ(written(loaded)["materials"][0]["normalTexture"], json::parse(R"({"index": 0})"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: an image of WebP as any other; other encodings of the image that was there before.
TEST_F(WriteMaterials, ImagesOfOtherTypes) {
  Material m;
  m.normal_texture = kUsed;
  Scene scene = scene_of(m);
  scene.images[0].name = write("a.webp", "RIFFsizeWEBPand so on");
  const json made = written({scene, {}});
  EXPECT_EQ(made["textures"][0], json::parse(R"({"extensions": {"EXT_texture_webp": {"source": 0}}})"));
  EXPECT_EQ(made["images"][0]["mimeType"], "image/webp");
  GltfBuilder builder;
  builder.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(path("p.png")))}},
                            {{"uri", "same.ktx2"}}};
  builder.root["textures"] = {{{"source", 0}, {"extensions", {{"KHR_texture_basisu", {{"source", 1}}}}}}};
  builder.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  builder.use_extension("KHR_texture_basisu");
  Loaded loaded = load_source(builder);
  write("other.png", png(path("p.png"), 5, 1));
  loaded.scene.images[0] = read_image(path("other.png"));
  EXPECT_EQ(written(loaded)["textures"], json::parse(R"([{"source": 0}])"));
}

}  // namespace
}  // namespace parian

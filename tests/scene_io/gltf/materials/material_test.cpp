// Materials, textures, images and the environment.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "scene_io/gltf/file/file.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

std::string decoded_base64(const std::string& text) {
  const SharedArray<std::byte> bytes = decode_data_uri("data:;base64," + text);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class GltfMaterial : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    image_ = png(path("scratch.png"));
    builder.root["images"] = {{{"bufferView", builder.add_bytes(image_)}}};
    builder.root["textures"] = {{{"source", 0}}};
  }

  Material material(const json& source) {
    builder.root["materials"] = {source};
    scene = load(builder.glb());
    return scene.materials.at(0);
  }

  GltfBuilder builder;
  std::string image_;
  Scene scene;
};

TEST_F(GltfMaterial, HasTheDefaultsOfGltf) {
  Material expected;
  EXPECT_EQ(material(json::object()), expected);
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_TRUE(scene.images.empty());  // none is used
}

TEST_F(GltfMaterial, ReadsFactors) {
  const Material m =
      material({{"name", "brass"},
                {"pbrMetallicRoughness",
                 {{"baseColorFactor", {.1, .2, .3, .4}}, {"metallicFactor", .5}, {"roughnessFactor", .6}}},
                {"emissiveFactor", {.7, .8, .9}},
                {"alphaMode", "MASK"},
                {"alphaCutoff", .25},
                {"doubleSided", true}});
  EXPECT_EQ(m.name, "brass");
  EXPECT_EQ(m.base_color, Rgb(.1f, .2f, .3f));
  EXPECT_EQ(m.alpha, .4f);
  EXPECT_EQ(m.metallic, .5f);
  EXPECT_EQ(m.roughness, .6f);
  EXPECT_EQ(m.emission, Rgb(.7f, .8f, .9f));
  EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
  EXPECT_EQ(m.alpha_cutoff, .25f);
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(material({{"alphaMode", "BLEND"}}).alpha_mode, AlphaMode::blend);
}

TEST_F(GltfMaterial, ReadsEveryTextureSlot) {
  const json first = {{"index", 0}}, second = {{"index", 0}, {"texCoord", 1}};
  const Material m = material(
      {{"pbrMetallicRoughness", {{"baseColorTexture", first}, {"metallicRoughnessTexture", second}}},
       {"normalTexture", {{"index", 0}, {"texCoord", 1}, {"scale", .5}}},
       {"emissiveTexture", second},
       {"occlusionTexture", {{"index", 0}}},
       {"extensions",
        {{"KHR_materials_specular", {{"specularTexture", second}, {"specularColorTexture", second}}}}}});
  EXPECT_EQ(m.base_color_texture, (TextureRef{.texture = 0}));
  const TextureRef uv1{.texture = 0, .uv_set = 1};
  EXPECT_EQ(m.metallic_roughness_texture, uv1);
  EXPECT_EQ(m.normal_texture, uv1);
  EXPECT_EQ(m.normal_scale, .5f);
  EXPECT_EQ(m.emission_texture, uv1);
  EXPECT_EQ(m.specular_texture, uv1);
  EXPECT_EQ(m.specular_color_texture, uv1);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0].width, 2);
}

TEST_F(GltfMaterial, ReadsExtensions) {
  const Material m = material(
      {{"emissiveFactor", {.5, .5, .5}},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10}}},
         {"KHR_materials_ior", {{"ior", 1.25}}},
         {"KHR_materials_unlit", json::object()},
         {"KHR_materials_specular", {{"specularFactor", .5}, {"specularColorFactor", {.25, 1, 3}}}}}}});
  EXPECT_EQ(m.emission, Rgb(5, 5, 5));
  EXPECT_EQ(m.ior, 1.25f);
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.specular, .5f);
  EXPECT_EQ(m.specular_color, Rgb(.25f, 1, 3));
  EXPECT_EQ(material({{"extensions", {{"KHR_materials_ior", {{"ior", 0}}}}}}).ior, 0);
}

TEST_F(GltfMaterial, ReadsSamplers) {
  builder.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}, {"minFilter", 9987}},
                              {{"magFilter", 9729}}};
  builder.root["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 0}, {"sampler", 1}}};
  material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
            {"emissiveTexture", {{"index", 1}}}});
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_EQ(scene.textures[0], (Texture{0, Wrap::clamp_to_edge, Wrap::mirrored_repeat, Filter::nearest}));
  EXPECT_EQ(scene.textures[1], (Texture{0, Wrap::repeat, Wrap::repeat, Filter::linear}));
}

TEST_F(GltfMaterial, ReadsTextureTransforms) {
  const auto transform = [&](const json& extension) {
    return material(
               {{"emissiveTexture",
                 {{"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", extension}}}}}})
        .emission_texture;
  };
  EXPECT_EQ(transform({{"offset", {.5, .25}}, {"scale", {2, 3}}}).transform,
            (std::array<float, 6>{2, 0, .5f, 0, 3, .25f}));
  // The extension's own example: the lower left quadrant, turned clockwise by 90 degrees. The corner (0, 0)
  // shows the image's lower left corner (0, 1); one step along u goes up the left side.
  const TextureRef quadrant =
      transform({{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {.5, .5}}});
  const auto map = [&](float u, float v) {
    const auto& t = quadrant.transform;
    return Vec2f(t[0] * u + t[1] * v + t[2], t[3] * u + t[4] * v + t[5]);
  };
  EXPECT_LT((map(0, 0) - Vec2f(0, 1)).length(), 1e-6f);
  EXPECT_LT((map(1, 0) - Vec2f(0, .5f)).length(), 1e-6f);
  EXPECT_LT((map(0, 1) - Vec2f(.5f, 1)).length(), 1e-6f);
  EXPECT_EQ(quadrant.uv_set, 1);
  EXPECT_EQ(transform({{"texCoord", 0}}).uv_set, 0);
  EXPECT_EQ(transform(json::object()), (TextureRef{.texture = 0, .uv_set = 1}));
  const Material m =
      material({{"extensions",
                 {{"KHR_materials_specular",
                   {{"specularTexture",
                     {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {3, 0}}}}}}}}}}}}});
  EXPECT_EQ(m.specular_texture.transform[2], 3);
}

TEST_F(GltfMaterial, SkipsTexturesItCannotPlace) {
  EXPECT_FALSE(material({{"emissiveTexture", {{"index", 0}, {"texCoord", 2}}}}).emission_texture);
  EXPECT_EQ(warnings.size(), 1u);
  builder.root["textures"] = {json::object()};
  EXPECT_FALSE(material({{"emissiveTexture", {{"index", 0}}}}).emission_texture);
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(GltfMaterial, ReadsImagesFromAnywhere) {
  write("my images/a.png", image_);
  const std::string data_uri = "data:image/png;base64," + base64(image_);
  for (const std::string& uri : std::vector<std::string>{"my%20images/a.png", data_uri}) {
    builder.root["images"] = {{{"uri", uri}}};
    material({{"emissiveTexture", {{"index", 0}}}});
    ASSERT_EQ(scene.images.size(), 1u);
    EXPECT_EQ(scene.images[0].height, 2);
  }
}

TEST_F(GltfMaterial, DecodesTheImagesInUseOnceEach) {
  write("broken.png", "not an image");
  write("other.png", png(path("scratch.png"), 5, 3));
  const int view = builder.root["images"][0]["bufferView"];
  builder.root["images"] = {
      {{"uri", "broken.png"}}, {{"uri", "other.png"}}, {{"bufferView", view}}, {{"bufferView", view}}};
  builder.root["textures"] = {{{"source", 0}}, {{"source", 2}}, {{"source", 3}}, {{"source", 1}}};
  const Material m =
      material({{"pbrMetallicRoughness",
                 {{"baseColorTexture", {{"index", 1}}}, {"metallicRoughnessTexture", {{"index", 2}}}}},
                {"emissiveTexture", {{"index", 3}}}});
  ASSERT_EQ(scene.images.size(), 2u);
  const auto width = [&](const TextureRef& ref) {
    return scene.images[std::size_t(scene.textures[std::size_t(ref.texture)].image)].width;
  };
  EXPECT_EQ(width(m.base_color_texture), 2);
  EXPECT_EQ(width(m.metallic_roughness_texture), 2);
  EXPECT_EQ(width(m.emission_texture), 5);
}

TEST_F(GltfMaterial, PrefersWebpSources) {
  write("other.png", png(path("scratch.png"), 5, 3));
  builder.root["images"].push_back({{"uri", "other.png"}});
  builder.root["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
  material({{"emissiveTexture", {{"index", 0}}}});
  EXPECT_EQ(scene.images.at(0).width, 5);
}

// Made by cwebp without loss: 3 x 2 pixels.
TEST_F(GltfMaterial, DecodesWebpToTheTexel) {
  const std::string bytes = decoded_base64(
      "UklGRk4AAABXRUJQVlA4TEEAAAAvAkAAAC+gkI0kaF+RBTt/hTNR2kgKdB94+i8SjUJNAAKMUU19aVy++Q88SvZ3"
      "7djMbUEh2whwaveInNFF9D+eFQA=");
  builder.root["extensionsRequired"] = {"EXT_texture_webp"};
  builder.root["images"].push_back({{"bufferView", builder.add_bytes(bytes)}, {"mimeType", "image/webp"}});
  for (const bool fallback : {true, false}) {
    json texture = {{"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}};
    if (fallback) texture["source"] = 0;
    builder.root["textures"] = {texture};
    material({{"emissiveTexture", {{"index", 0}}}});
    ASSERT_EQ(scene.images.size(), 1u);
    const Image& image = scene.images[0];
    ASSERT_EQ(image.width, 3);
    ASSERT_EQ(image.height, 2);
    ASSERT_EQ(image.type, PixelType::u8);
    const std::vector<std::array<int, 3>> texels = {{255, 0, 0}, {0, 128, 0},     {0, 0, 64},
                                                    {1, 2, 3},   {250, 251, 252}, {17, 34, 51}};
    for (std::size_t i = 0; i < texels.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(int(image.pixels[i * std::size_t(image.channels) + c]), texels[i][c]) << i << " " << c;
  }
}

TEST_F(GltfMaterial, RefusesBrokenImages) {
  builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
  write("broken.png", image_.substr(0, image_.size() / 2));
  for (const json& image :
       {json{{"uri", "broken.png"}}, json{{"uri", "absent.png"}}, json{{"uri", "data:image/png;base64,AAAA"}},
        json{{"uri", "/dev/zero"}}, json{{"uri", "."}}}) {
    builder.root["images"] = {image};
    EXPECT_EQ(refusal(builder.glb()).substr(0, 9), "/images/0") << image;
  }
  builder.root["images"] = {json::object()};
  EXPECT_EQ(refusal(builder.glb()), "/images/0: expected either uri or bufferView");
}

TEST_F(GltfMaterial, ReadsTheEnvironmentOfTheDefaultScene) {
  const auto environment = [&](const json& source) {
    builder.root["extensions"]["EXT_lights_environment"]["environments"] = {source};
    builder.root["scenes"] = {{{"extensions", {{"EXT_lights_environment", {{"environment", 0}}}}}}};
    scene = load(builder.glb());
    return scene.environment;
  };
  Environment e = environment({{"source", 0}, {"intensity", 3}});
  EXPECT_EQ(e.radiance, Rgb(3, 3, 3));
  EXPECT_EQ(scene.images.at(std::size_t(e.image)).width, 2);
  EXPECT_EQ(e.rotation, Quatf(1, 0, 0, 0));
  // The image's centre, +x unturned, is turned to the front side.
  const std::vector<std::pair<const char*, Vec3f>> fronts = {
      {"+X", {1, 0, 0}}, {"-X", {-1, 0, 0}}, {"+Z", {0, 0, 1}}, {"-Z", {0, 0, -1}}};
  for (const auto& [name, axis] : fronts) {
    e = environment({{"source", 0}, {"frontside", name}});
    EXPECT_EQ(e.radiance, Rgb(1, 1, 1));
    EXPECT_LT((e.rotation.rotateVector(Vec3f(1, 0, 0)) - axis).length(), 1e-6f) << name;
    EXPECT_LT((e.rotation.rotateVector(Vec3f(0, 1, 0)) - Vec3f(0, 1, 0)).length(), 1e-6f) << name;
  }
  builder.root["scenes"] = {json::object()};
  EXPECT_EQ(load(builder.glb()).environment, Environment());
}

}  // namespace
}  // namespace parian

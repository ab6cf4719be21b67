#include "materials/bsdf.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A surface seen from wo, with a shading normal of its own.
Surface make_test_surface(const Vec3f& ng, const Vec3f& ns, const Vec3f& wo) {
  Surface s{};
  s.ng = ng;
  s.wo = wo;
  s.front = wo.dot(ng) >= 0;
  s.frame = make_frame(s.front ? ns : -ns);
  return s;
}

const Bsdf::AnyLobe kLobes[] = {Lambert{{0.8f, 0.8f, 0.8f}},
                                MetallicRoughness{{0.8f, 0.6f, 0.4f}, 1, {0, 0, 0}, 1, {0.3f}},
                                MetallicRoughness{{0.8f, 0.6f, 0.4f}, 0, {0.04f, 0.04f, 0.04f}, 1, {0.1f}}};

// Catches light that passes through the surface where shading and geometric normal disagree, in
// evaluation and in sampling, from the front and from the back.
TEST(Bsdf, LetsNoLightThroughBetweenTheNormals) {
  const Vec3f ng(0, 0, 1), ns = normalize(Vec3f(0.8f, 0, 0.6f));
  for (const Bsdf::AnyLobe& lobe : kLobes)
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = normalize(Vec3f(0.5f, 0.1f, 0.8f)) * side;
      const Surface surface = make_test_surface(ng, ns, wo);
      const Bsdf bsdf(surface, lobe);
      // Above the shading plane, below the surface; and the other way round.
      const Vec3f leaking = normalize(Vec3f(1, 0, -0.3f)) * side,
                  hidden = normalize(Vec3f(-1, 0, 0.3f)) * side;
      ASSERT_TRUE(leaking.dot(ns) * side > 0 && hidden.dot(ns) * side < 0);
      for (const Vec3f& wi : {leaking, hidden}) {
        EXPECT_TRUE(is_black(bsdf.eval(wi).f_cos));
        EXPECT_EQ(bsdf.eval(wi).pdf, 0);
      }
      EXPECT_FALSE(is_black(bsdf.eval(ns * side).f_cos));
      TestRandom random(1);
      int failed = 0;
      for (int i = 0; i < 5000; ++i) {
        const float u = random.next1();
        const auto s = bsdf.sample(u, random.next2());
        failed += !s;
        if (s) {
          ASSERT_TRUE(s->wi.dot(ng) * side > 0 && s->wi.dot(ns) * side > 0);
        }
      }
      EXPECT_GT(failed, 0) << "the normals differ by 53 degrees: some samples must leak";
    }
}

// Density and samples agree after the turn into the world, what is rejected included.
TEST(Bsdf, SamplesWithItsDensityInTheWorld) {
  const Vec3f ng = normalize(Vec3f(0.3f, -0.5f, 0.7f)), ns = normalize(ng + Vec3f(0.3f, 0.2f, 0));
  for (const Bsdf::AnyLobe& lobe : kLobes)
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = normalize(ng + Vec3f(0.2f, 0.5f, 0)) * side;
      const Surface surface = make_test_surface(ng, ns, wo);
      const Bsdf bsdf(surface, lobe);
      TestRandom random(2);
      const auto sample = [&]() -> std::optional<Vec3f> {
        const float u = random.next1();
        const auto s = bsdf.sample(u, random.next2());
        if (!s) return std::nullopt;
        const BsdfValue value = bsdf.eval(s->wi);
        EXPECT_NEAR(value.pdf / s->pdf, 1, 2e-3);
        EXPECT_NEAR(value.f_cos.x / s->pdf, s->weight.x, 2e-3 * s->weight.x + 1e-6);
        return s->wi;
      };
      const Vec3f n = ns * side;
      const SphereCells cells{
          .axis = normalize(n * (2 * n.dot(wo)) - wo), .zoom = 0.01, .tolerance = 1e-6, .depth = 5};
      EXPECT_TRUE(samples_directions(
          sample, [&](const Vec3f& w) { return bsdf.eval(w).pdf; }, cells, 100000, 6));
    }
}

TEST(Bsdf, SaysWhetherItLooksAtTheFirstNumber) {
  const Surface s = make_test_surface({0, 0, 1}, {0, 0, 1}, {0, 0, 1});
  EXPECT_FALSE(Bsdf(s, kLobes[0]).has_choice());
  EXPECT_TRUE(Bsdf(s, kLobes[1]).has_choice());
}

// --- make_bsdf ---

/// One quad in the xy plane with all attributes, seen in its middle from `wo`.
class MakeBsdf : public testing::Test {
 protected:
  MakeBsdf() {
    material_.base_color = {0.9f, 0.8f, 0.7f};
    material_.metallic = 0.4f;
    material_.roughness = 0.6f;
  }

  /// eval(wi) of make_bsdf() and of the lobe that is expected are the same.
  void expect(const Bsdf::AnyLobe& lobe) {
    scene_.materials = {material_};
    Primitive quad = make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    quad.uvs[1] = std::vector<Vec2f>(4, Vec2f(0.75f, 0.5f));
    if (vertex_color_) quad.colors = std::vector<Vec4f>(4, *vertex_color_);
    add_mesh(scene_, std::move(quad), 0);
    const World world = make_world(scene_);
    const Vec3f wo = normalize(Vec3f(0.3f, 0.2f, 0.9f)), wi = normalize(Vec3f(-0.5f, 0.1f, 0.6f));
    const Surface surface = make_surface(scene_, world, {1, 0, 0.5f, 0, 0, 0}, -wo);
    const BsdfValue made = make_bsdf(scene_, surface, Microfacets::single).eval(wi),
                    expected = Bsdf(surface, lobe).eval(wi);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(made.f_cos[k], expected.f_cos[k], 1e-5f * (1 + expected.f_cos[k])) << k;
    EXPECT_NEAR(made.pdf, expected.pdf, 1e-5f * (1 + expected.pdf));
    albedo_ = estimate_albedo(scene_, surface);
    base_color_ = eval_base_color(scene_, surface);
  }

  TextureRef texture(int channels, const std::vector<std::uint8_t>& texel) {
    return add_texture(scene_, make_image(1, 1, channels, PixelType::u8, texel));
  }

  Scene scene_;
  Material material_;
  std::optional<Vec4f> vertex_color_;
  Rgb albedo_{0, 0, 0}, base_color_{0, 0, 0};
};

/// alpha for a roughness.
Ggx ggx(float roughness) { return {roughness * roughness}; }
const Rgb kF0{0.04f, 0.04f, 0.04f};
// 188 of 255 in sRGB.
constexpr float kSrgb188 = 0.502886458f;

TEST_F(MakeBsdf, TakesTheFactors) { expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f, kF0, 1, ggx(0.6f)}); }

// Catches a base colour that is read as linear, and alpha that is mixed in.
TEST_F(MakeBsdf, ReadsTheBaseColourAsSrgbTimesFactorAndVertexColour) {
  material_.base_color_texture = texture(4, {188, 255, 0, 128});
  vertex_color_ = Vec4f(0.5f, 0.25f, 1, 0.1f);
  expect(MetallicRoughness{{0.9f * 0.5f * kSrgb188, 0.8f * 0.25f, 0}, 0.4f, kF0, 1, ggx(0.6f)});
  EXPECT_NEAR(base_color_.x, 0.45f * kSrgb188, 1e-6);
}

// Catches swapped channels (metallic is in B, roughness in G) and sRGB decoding of data.
TEST_F(MakeBsdf, ReadsRoughnessFromGAndMetallicFromBLinearly) {
  material_.metallic_roughness_texture = texture(3, {10, 204, 102});
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f * 0.4f, kF0, 1, ggx(0.6f * 0.8f)});
}

TEST_F(MakeBsdf, ReadsTheSpecularWeightFromAlphaLinearlyAndItsColourAsSrgb) {
  material_.specular = 0.5f;
  material_.specular_color = {1, 2, 40};
  material_.specular_texture = texture(4, {1, 2, 3, 102});
  material_.specular_color_texture = texture(3, {188, 255, 255});
  const float weight = 0.5f * 0.4f;
  expect(MetallicRoughness{
      {0.9f, 0.8f, 0.7f}, 0.4f, Rgb(0.04f * kSrgb188, 0.08f, 1) * weight, weight, ggx(0.6f)});
}

// KHR_materials_ior: 0 stands for infinity.
TEST_F(MakeBsdf, TakesTheReflectanceFromTheIndexOfRefraction) {
  material_.ior = 2;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f, Rgb(1.0f / 9), 1, ggx(0.6f)});
}
TEST_F(MakeBsdf, AnIndexOfZeroReflectsEverything) {
  material_.ior = 0;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f, Rgb(1), 1, ggx(0.6f)});
}
TEST_F(MakeBsdf, AnIndexOfOneReflectsAtTheHorizonOnly) {
  material_.ior = 1;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f, Rgb(0), 1, ggx(0.6f)});
}

TEST_F(MakeBsdf, WithoutSpecularIsLambert) {
  material_.metallic = 0;
  material_.specular = 0;
  material_.ior = 0;
  expect(Lambert{{0.9f, 0.8f, 0.7f}});
  EXPECT_EQ(albedo_, Rgb(0.9f, 0.8f, 0.7f));
}

TEST_F(MakeBsdf, AMetalKeepsItsCoatWhenSpecularIsZero) {
  material_.metallic = 1;
  material_.specular = 0;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 1, Rgb(0), 0, ggx(0.6f)});
}

TEST_F(MakeBsdf, ClampsASmoothSurfaceToTheNarrowestLobe) {
  material_.roughness = 0;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0.4f, kF0, 1, {Ggx::kMinAlpha}});
}

// Catches a lookup in the first uv set always, and a transform that is left out.
TEST_F(MakeBsdf, LooksTexturesUpInTheirUvSetAndTransform) {
  // Four texels; the first set is at (.5, .5) in the middle, the second at (.75, .5).
  const auto image =
      make_image<std::uint8_t>(4, 1, 3, PixelType::u8, {0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255});
  Texture nearest;
  nearest.filter = Filter::nearest;
  material_.base_color = {1, 1, 1};
  material_.base_color_texture = add_texture(scene_, image, nearest);
  material_.base_color_texture.uv_set = 1;
  expect(MetallicRoughness{{0, 0, 1}, 0.4f, kF0, 1, ggx(0.6f)});
}
TEST_F(MakeBsdf, AppliesTheTransformOfATexture) {
  const auto image =
      make_image<std::uint8_t>(4, 1, 3, PixelType::u8, {0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255});
  Texture nearest;
  nearest.filter = Filter::nearest;
  material_.base_color = {1, 1, 1};
  material_.base_color_texture = add_texture(scene_, image, nearest);
  material_.base_color_texture.transform = {0.5f, 0.1f, 0.1f, 0, 1, 0};  // u = .25 + .05 + .1
  expect(MetallicRoughness{{1, 0, 0}, 0.4f, kF0, 1, ggx(0.6f)});
}

TEST_F(MakeBsdf, AlbedoOfAnUnlitSurfaceIsItsColour) {
  material_.unlit = true;
  material_.metallic = 0;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0, kF0, 1, ggx(0.6f)});
  EXPECT_EQ(albedo_, Rgb(0.9f, 0.8f, 0.7f));
}

TEST_F(MakeBsdf, AlbedoOfADielectricIsBasePlusCoat) {
  material_.metallic = 0;
  expect(MetallicRoughness{{0.9f, 0.8f, 0.7f}, 0, kF0, 1, ggx(0.6f)});
  EXPECT_NEAR(albedo_.x, 0.9f * 0.96f + 0.04f, 1e-6);
}

}  // namespace
}  // namespace parian

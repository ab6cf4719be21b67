#include "renderer/scene/surface.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
  EXPECT_LE((a - b).length(), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", " << b.z << ")";
}

Hit hit_at(float u, float v, std::uint32_t triangle = 0) { return {1, u, v, 0, 0, triangle}; }

/// The surface of a scene of one primitive at a hit by a ray along d.
Surface surface_of(const Scene& scene, const Vec3f& d, const Hit& hit = hit_at(0.25f, 0.25f)) {
  static World world;  // the surface points into it
  world = make_world(scene);
  return make_surface(scene, world, hit, normalize(d));
}

Scene make_scene(Primitive primitive, const Transform& transform = {}, const Material& material = {}) {
  Scene scene;
  add_mesh(scene, std::move(primitive), add_material(scene, material), transform);
  return scene;
}

Primitive with_normals(Primitive p, std::vector<Vec3f> normals) {
  for (Vec3f& n : normals) n = n.normalized();
  p.normals = std::move(normals);
  return p;
}

const Primitive kTriangle = make_triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});

// --- Position and normals ---

TEST(Surface, KnowsItsFrontAndItsBack) {
  const Scene scene = make_scene(kTriangle, translate({0, 0, 5}));
  const Surface front = surface_of(scene, {0, 0.6f, -0.8f});
  expect_near(front.p, {1, 1, 5});
  expect_near(front.ng, {0, 0, 1});
  expect_near(front.wo, {0, -0.6f, 0.8f});
  expect_near(front.frame.z, {0, 0, 1});
  EXPECT_TRUE(front.front);
  const Surface back = surface_of(scene, {0, 0.6f, 0.8f});
  expect_near(back.ng, {0, 0, 1});
  expect_near(back.frame.z, {0, 0, -1});
  EXPECT_FALSE(back.front);
}

TEST(Surface, TakesTheVerticesByTheirWeights) {
  const Scene scene = make_scene(make_triangle({1, 2, 3}, {4, 2, 3}, {1, 8, 3}));
  expect_near(surface_of(scene, {0, 0, -1}, hit_at(0, 0)).p, {1, 2, 3});
  expect_near(surface_of(scene, {0, 0, -1}, hit_at(1, 0)).p, {4, 2, 3});
  expect_near(surface_of(scene, {0, 0, -1}, hit_at(0, 1)).p, {1, 8, 3});
  expect_near(surface_of(scene, {0, 0, -1}, hit_at(0.5f, 0.25f)).p, {2.5f, 3.5f, 3});
}

// A plane of normal (1, 0, 1) stretched by diag(1, 1, 4) has normal (4, 0, 1); without the inverse
// transpose it is 61.9 degrees off. The geometric normal and an interpolated one alike.
TEST(Surface, NormalsFollowANonUniformScale) {
  const Primitive flat = make_triangle({0, 0, 0}, {1, 0, -1}, {0, 1, 0});
  const Primitive smooth = with_normals(flat, std::vector<Vec3f>(3, Vec3f(1, 0, 1)));
  for (const Primitive& p : {flat, smooth}) {
    const Surface s = surface_of(make_scene(p, scale({1, 1, 4})), {-1, 0, -1});
    expect_near(s.ng, normalize(Vec3f(4, 0, 1)));
    expect_near(s.frame.z, normalize(Vec3f(4, 0, 1)));
  }
}

// Catches a mirrored solid that is turned inside out.
TEST(Surface, AMirroredSolidKeepsItsOutside) {
  for (const Vec3f& s :
       {Vec3f(1, 1, 1), Vec3f(-1, 1, 1), Vec3f(1, -2, 1), Vec3f(-1, -1, -3), Vec3f(2, -1, -1)}) {
    const Scene box = make_scene(make_box({-1, -1, -1}, {1, 1, 1}), scale(s));
    const Scene ball = make_scene(make_uv_sphere({0, 0, 0}, 1, 6), scale(s));
    for (const Scene& scene : {box, ball}) {
      const auto triangles = std::uint32_t(scene.meshes[0].primitives[0].triangles.size());
      for (std::uint32_t i = 0; i < triangles; ++i) {
        const Surface outside = surface_of(scene, {0.3f, 0.2f, -0.9f}, hit_at(0.3f, 0.3f, i));
        ASSERT_GT(outside.ng.dot(outside.p), 0) << i;
        ASSERT_NEAR(outside.ng.length(), 1, 1e-5);
        ASSERT_EQ(outside.front, outside.wo.dot(outside.ng) >= 0);
        ASSERT_GT(outside.frame.z.dot(outside.wo), 0);
      }
    }
  }
}

TEST(Surface, InterpolatesNormals) {
  const Scene scene = make_scene(with_normals(kTriangle, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}));
  const Vec3f n1 = Vec3f(1, 0, 1).normalized(), n2 = Vec3f(0, 1, 1).normalized();
  const Vec3f expected = (Vec3f(0, 0, 1) * 0.5f + n1 * 0.25f + n2 * 0.25f).normalized();
  expect_near(surface_of(scene, {0, 0, -1}).frame.z, expected);
  expect_near(surface_of(scene, {0, 0, 1}).frame.z, -expected);
  expect_near(surface_of(scene, {0, 0, -1}).ng, {0, 0, 1});
}

// A shading normal that faces away from the viewer cannot be shaded.
TEST(Surface, AShadingNormalTurnedAwayGivesWayToTheGeometricOne) {
  const Scene scene = make_scene(with_normals(kTriangle, std::vector<Vec3f>(3, Vec3f(2, 0, 1))));
  expect_near(surface_of(scene, {1, 0, -0.1f}).frame.z, {0, 0, 1});
  expect_near(surface_of(scene, {-1, 0, 0.1f}).frame.z, {0, 0, -1});
  expect_near(surface_of(scene, {-1, 0, -0.1f}).frame.z, Vec3f(2, 0, 1).normalized());
}

TEST(Surface, RayOriginsLieOnTheSideOfTheRay) {
  for (const float far : {0.0f, 1e4f}) {
    const Scene scene = make_scene(kTriangle, translate({far, -far, far}));
    const Surface s = surface_of(scene, {0, 0, -1});
    EXPECT_GT(s.offset, 0);
    EXPECT_LT(s.offset, 1e-5f * (1 + far));
    EXPECT_GT(ray_origin(s, {0, 0.6f, 0.8f}).z, s.p.z);
    EXPECT_LT(ray_origin(s, {0, 0.6f, -0.8f}).z, s.p.z);
  }
}

// --- Degenerate input ---

void expect_finite(const Surface& s) {
  EXPECT_TRUE(is_finite(s.p) && is_finite(s.ng) && is_finite(s.frame.x) && is_finite(s.frame.y) &&
              is_finite(s.frame.z) && std::isfinite(s.offset));
  EXPECT_NEAR(s.frame.z.length(), 1, 1e-5);
  EXPECT_NEAR(s.ng.length(), 1, 1e-5);
}

// Catches 0/0 in a normal, at a pole of a sphere or where three normals cancel.
TEST(Surface, OfADegenerateTriangleIsFinite) {
  expect_finite(surface_of(make_scene(make_triangle({1, 1, 1}, {1, 1, 1}, {2, 1, 1})), {0, 0, -1}));
  expect_finite(surface_of(make_scene(make_triangle({1, 1, 1}, {1, 1, 1}, {1, 1, 1})), {0, 0, -1}));
  const Scene opposed = make_scene(with_normals(kTriangle, {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}}));
  expect_finite(surface_of(opposed, {0, 0, -1}, hit_at(0.5f, 0)));
  expect_near(surface_of(opposed, {0, 0, -1}, hit_at(0.5f, 0)).frame.z, {0, 0, 1});
}

// The square of the cross product of short or long edges leaves the range of float.
TEST(Surface, NormalsOfTinyAndHugeTrianglesAreUnit) {
  for (const float size : {1e-12f, 1e-11f, 1e-10f, 1e-8f, 1e-4f, 1.0f, 1e4f, 1e8f, 1e10f})
    for (const bool scaled : {false, true}) {
      Primitive p = make_triangle({0, 0, 0}, {scaled ? 1 : size, 0, 0}, {0, scaled ? 1 : size, 0});
      if (scaled) p = with_normals(p, std::vector<Vec3f>(3, Vec3f(0.6f, 0, 0.8f)));
      const Surface s = surface_of(make_scene(p, scaled ? scale(Vec3f(size)) : Transform{}), {0, 0, -1});
      expect_near(s.ng, {0, 0, 1});
      expect_near(s.frame.z, scaled ? Vec3f(0.6f, 0, 0.8f) : Vec3f(0, 0, 1));
    }
}

// --- Attributes ---

TEST(Surface, InterpolatesUvsAndColoursWhereTheyAreNeeded) {
  Material material;
  Scene scene;
  material.base_color_texture = add_texture(scene, make_image<std::uint8_t>(1, 1, 1, PixelType::u8, {255}));
  Primitive p = kTriangle;
  p.uvs[0] = std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}};
  p.uvs[1] = std::vector<Vec2f>{{2, 2}, {4, 2}, {2, 8}};
  p.colors = std::vector<Vec4f>{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}};
  add_mesh(scene, p, add_material(scene, material));
  const Surface s = surface_of(scene, {0, 0, -1}, hit_at(0.5f, 0.25f));
  EXPECT_EQ(s.uvs[0], Vec2f(0.5f, 0.25f));
  EXPECT_EQ(s.uvs[1], Vec2f(3, 3.5f));
  EXPECT_EQ(s.color, Vec4f(0.25f, 0.5f, 0.25f, 0.75f));
  EXPECT_EQ(surface_of(make_scene(kTriangle), {0, 0, -1}).color, Vec4f(1));
}

// --- Normal maps ---

/// A quad in the xy plane whose image is upright (u along +x, v along -y), with a normal map of one texel.
/// `mirrored`: u runs along -x.
Scene make_mapped(const std::vector<std::uint8_t>& texel, bool tangents, bool mirrored,
                  const Transform& transform = {}) {
  Scene scene;
  Material material;
  material.normal_texture = add_texture(scene, make_image(1, 1, 3, PixelType::u8, texel));
  Primitive p = make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  if (mirrored) p.uvs[0] = std::vector<Vec2f>{{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  p.normals = std::vector<Vec3f>(4, Vec3f(0, 0, 1));
  // MikkTSpace: w makes cross(n, t) w point up the image.
  if (tangents) p.tangents = std::vector<Vec4f>(4, mirrored ? Vec4f(-1, 0, 0, -1) : Vec4f(1, 0, 0, 1));
  add_mesh(scene, p, add_material(scene, material), transform);
  return scene;
}

// The flat texel of 8 bits, (128, 128, 255), tilts a normal by .32 degrees at most.
TEST(NormalMap, FlatLeavesTheNormal) {
  for (const bool tangents : {false, true}) {
    const Surface s = surface_of(make_mapped({128, 128, 255}, tangents, false), {0, 0, -1});
    EXPECT_LT(std::acos(std::min(1.0f, s.frame.z.z)), 0.0056f);
    const Surface back = surface_of(make_mapped({128, 128, 255}, tangents, false), {0, 0, 1});
    EXPECT_LT(std::acos(std::min(1.0f, -back.frame.z.z)), 0.0056f);
  }
}

// Red is to the right of the image, green up (glTF 2.0, 3.9.3): with tangents of the file or without, on a
// mirrored map and under a mirrored node, seen from the front and from the back. Catches a flipped green
// channel and each lost sign.
TEST(NormalMap, RedIsRightAndGreenIsUpInTheImage) {
  // 2 c - 1 = (.6, 0, .8) and (0, .6, .8), rounded to 8 bits.
  const std::vector<std::uint8_t> right{204, 128, 230}, up{128, 204, 230};
  for (const bool tangents : {false, true})
    for (const bool mirrored_map : {false, true})
      for (const Vec3f& s :
           {Vec3f(1, 1, 1), Vec3f(-1, 1, 1), Vec3f(1, -1, 1), Vec3f(-2, -2, 2), Vec3f(3, 3, -3)})
        for (const float side : {1.0f, -1.0f}) {
          // Where the image's right and top point in the world; the front of a face flipped in z stays its
          // outside.
          const Vec3f x(s.x < 0 ? -1 : 1, 0, 0), y(0, s.y < 0 ? -1 : 1, 0), z(0, 0, s.z < 0 ? -1 : 1);
          const Vec3f image_right = mirrored_map ? -x : x;
          const auto normal = [&](const std::vector<std::uint8_t>& texel) {
            return surface_of(make_mapped(texel, tangents, mirrored_map, scale(s)), z * -side).frame.z;
          };
          SCOPED_TRACE(testing::Message() << "tangents " << tangents << ", mirrored " << mirrored_map
                                          << ", scale " << s << ", side " << side);
          expect_near(normal(right), (image_right * 0.6f + z * 0.8f) * side, 0.01f);
          expect_near(normal(up), (y * 0.6f + z * 0.8f) * side, 0.01f);
        }
}

TEST(NormalMap, ScaleAppliesToXAndY) {
  Scene scene = make_mapped({204, 128, 230}, false, false);
  scene.materials[0].normal_scale = 0.5f;
  expect_near(surface_of(scene, {0, 0, -1}).frame.z, normalize(Vec3f(0.3f, 0, 0.8f)), 0.01f);
  scene.materials[0].normal_scale = 0;
  expect_near(surface_of(scene, {0, 0, -1}).frame.z, {0, 0, 1});
}

TEST(NormalMap, WithoutTangentsOrUvsIsLeftOut) {
  Scene degenerate = make_mapped({204, 128, 230}, false, false);
  degenerate.meshes[0].primitives[0].uvs[0] = std::vector<Vec2f>(4, Vec2f(0.5f, 0.5f));
  expect_near(surface_of(degenerate, {0, 0, -1}).frame.z, {0, 0, 1});
  degenerate.meshes[0].primitives[0].uvs[0] = {};
  expect_near(surface_of(degenerate, {0, 0, -1}).frame.z, {0, 0, 1});
  Scene black = make_mapped({128, 128, 128}, false, false);
  expect_finite(surface_of(black, {0, 0, -1}));
}

// A normal that deviates by tan d = .75, and 2 / (1 + sqrt(1 + .75^2 / 8 tan^2 theta)) by hand. Catches
// shadowing by the angle to the mapped normal, a lost side, and light from below.
TEST(NormalMap, BumpsShadowEachOther) {
  const struct {
    float theta;
    double share;
  } cases[] = {{0, 1}, {kPi / 4, 0.98301}, {kPi / 3, 0.95219}, {1.4f, 0.70571}, {1.55f, 0.14505}};
  for (const float side : {1.0f, -1.0f}) {
    const Surface s = surface_of(make_mapped({204, 128, 230}, false, false), Vec3f(0, 0, -side));
    ASSERT_TRUE(s.bumpy);
    for (const auto& c : cases) {
      const Vec3f w(std::sin(c.theta), 0, std::cos(c.theta));
      EXPECT_NEAR(bump_shadowing(s, w * side), c.share, 0.01) << c.theta;
      // What is transmitted alike.
      EXPECT_NEAR(bump_shadowing(s, -w * side), c.share, 0.01) << c.theta;
    }
    EXPECT_EQ(bump_shadowing(s, Vec3f(1, 0, 0) * side), 0);
    EXPECT_EQ(bump_shadowing(s, normalize(Vec3f(1, 0, -0.1f)) * side), 0);
    EXPECT_EQ(bump_shadowing(s, normalize(Vec3f(-1, 0, 0.1f)) * side), 0);
  }
  const Surface flat = surface_of(make_mapped({128, 128, 255}, false, false), {0, 0, -1});
  EXPECT_NEAR(bump_shadowing(flat, normalize(Vec3f(1, 0, 0.1f))), 1, 1e-3);
}

// What mirrors or refracts has its normal bent instead.
TEST(NormalMap, BumpsOfWhatMirrorsDoNotShadow) {
  Scene scene = make_mapped({204, 128, 230}, false, false);
  scene.materials[0].conductor.emplace();
  EXPECT_FALSE(surface_of(scene, {0, 0, -1}).bumpy);
  EXPECT_FALSE(surface_of(make_scene(kTriangle), {0, 0, -1}).bumpy);
}

// --- Emission and coverage ---

TEST(EvalEmission, MultipliesTheSrgbTexture) {
  Scene scene;
  Material m = make_emitter({2, 4, 8});
  const std::array<Vec2f, 2> uvs{Vec2f(0.5f, 0.5f), Vec2f(0.5f, 0.5f)};
  EXPECT_EQ(eval_emission(scene, m, uvs, 1), Rgb(2, 4, 8));
  m.emission_texture = add_texture(scene, make_image<std::uint8_t>(1, 1, 3, PixelType::u8, {255, 188, 0}));
  expect_near(eval_emission(scene, m, uvs, 1), {2, 4 * 0.502886f, 0});
}

// glTF 2.0, 3.9.4: alpha is factor x texture x vertex colour; MASK cuts at alpha >= cutoff.
TEST(EvalCoverage, IsAlphaOrItsMask) {
  Scene scene;
  Material m;
  m.alpha = 0.8f;
  m.alpha_mode = AlphaMode::blend;
  m.base_color_texture =
      add_texture(scene, make_image<std::uint8_t>(1, 1, 4, PixelType::u8, {255, 255, 255, 128}));
  Primitive p = kTriangle;
  p.uvs[0] = std::vector<Vec2f>(3, Vec2f(0, 0));
  p.colors = std::vector<Vec4f>{{1, 1, 1, 1}, {1, 1, 1, 0}, {1, 1, 1, 1}};
  add_mesh(scene, p, add_material(scene, m));
  const auto coverage = [&](float u, float v) {
    const World world = make_world(scene);
    return eval_coverage(scene, world.parts[0], 0, u, v);
  };
  const float alpha = 0.8f * 128 / 255;
  EXPECT_NEAR(coverage(0, 0), alpha, 1e-6);
  EXPECT_NEAR(coverage(0.5f, 0.25f), alpha * 0.5f, 1e-6);
  scene.materials[0].alpha_mode = AlphaMode::mask;
  scene.materials[0].alpha_cutoff = 0.4f;
  EXPECT_EQ(coverage(0, 0), 1);
  EXPECT_EQ(coverage(0.5f, 0.25f), 0);
  scene.materials[0].alpha_cutoff = 0.8f * (128.0f * (1.0f / 255));
  EXPECT_EQ(coverage(0, 0), 1) << "at the cutoff it is there";
}

}  // namespace
}  // namespace parian

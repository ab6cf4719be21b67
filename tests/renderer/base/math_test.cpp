#include "renderer/base/math.h"

#include <gtest/gtest.h>

#include "tests/support/statistics.h"

namespace parian {
namespace {

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-6f) {
  EXPECT_LE((a - b).length(), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", " << b.z << ")";
}

// Without the inverse transpose this is off by 61.9 degrees.
TEST(Affine, NormalOfAStretchedSurface) {
  const Affine stretch{{1, 0, 0}, {0, 1, 0}, {0, 0, 4}, {7, 8, 9}};
  expect_near(normalize(stretch.normal({1, 0, 1})), normalize(Vec3f(4, 0, 1)));
}

// Catches the plain cofactor matrix, which turns the outside of a mirrored surface inwards.
TEST(Affine, MirroredNormalsStayOutside) {
  const Affine mirror{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  expect_near(mirror.normal({1, 0, 0}), {-1, 0, 0});
  expect_near(mirror.normal({0, 0, 1}), {0, 0, 1});
  const Affine point_mirror{{-2, 0, 0}, {0, -2, 0}, {0, 0, -2}, {0, 0, 0}};
  expect_near(normalize(point_mirror.normal({0, 0, 1})), {0, 0, -1});
}

TEST(Affine, NormalsStayPerpendicularAndOutside) {
  TestRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const Affine m{random.direction() * 3, random.direction(), random.direction() * 0.3f, random.direction()};
    if (std::abs(m.determinant()) < 0.05f) continue;
    const Vec3f n = random.direction();
    const Frame frame = make_frame(n);
    const Vec3f mapped = normalize(m.normal(n));
    EXPECT_NEAR(mapped.dot(normalize(m.vector(frame.x))), 0, 1e-5);
    EXPECT_NEAR(mapped.dot(normalize(m.vector(frame.y))), 0, 1e-5);
    EXPECT_GT(mapped.dot(m.vector(n)), 0);
  }
}

TEST(Affine, TakesTheRowsOfARowVectorMatrix) {
  const Affine a = to_affine(Mat4d(1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 10, 0, 11, 12, 13, 1));
  expect_near(a.point({1, 0, 0}), {12, 14, 16});
  expect_near(a.point({0, 1, 1}), {22, 25, 29});
  expect_near(a.vector({0, 0, 1}), {7, 8, 10});
  EXPECT_FLOAT_EQ(a.determinant(), -3);
}

// Frisvad's frame loses a vector near z = -1, and copysign without care flips at z = -0.
TEST(MakeFrame, IsOrthonormalAndRightHandedEverywhere) {
  const auto check = [](const Vec3f& z) {
    const Frame f = make_frame(z);
    EXPECT_EQ(f.z, z);
    EXPECT_NEAR(f.x.length(), 1, 2e-6);
    EXPECT_NEAR(f.y.length(), 1, 2e-6);
    EXPECT_NEAR(f.x.dot(f.y), 0, 2e-6);
    EXPECT_NEAR(f.x.dot(f.z), 0, 2e-6);
    EXPECT_NEAR(f.y.dot(f.z), 0, 2e-6);
    EXPECT_NEAR(f.x.cross(f.y).dot(f.z), 1, 4e-6);
    const Vec3f w = normalize(Vec3f(1, 2, 3));
    expect_near(f.to_world(f.to_local(w)), w, 3e-6f);
    expect_near(f.to_local(z), {0, 0, 1}, 3e-6f);
  };
  TestRandom random(2);
  for (int i = 0; i < 10000; ++i) check(random.direction());
  for (const float z : {1.0f, -1.0f}) check({0, 0, z});
  for (const float z : {0.0f, -0.0f}) check({1, 0, z}), check({0, -1, z});
  for (const float small : {1e-1f, 1e-2f, 1e-3f, 1e-4f, 1e-6f, 1e-20f})
    for (const float sign : {1.0f, -1.0f}) {
      check(Vec3f(small, -0.5f * small, sign).normalized());
      check(Vec3f(1, small, sign * small).normalized());
    }
}

TEST(Luminance, OfWhiteIsOne) { EXPECT_NEAR(luminance({1, 1, 1}), 1, 1e-6); }

TEST(ErrorGamma, BoundsRoundedSums) {
  EXPECT_FLOAT_EQ(error_gamma(1), 0x1p-24f);
  EXPECT_GT(error_gamma(8), 8 * 0x1p-24f);
  EXPECT_LT(error_gamma(8), 8.001f * 0x1p-24f);
}

// Caught: a quadrant exchanged, a coefficient that lost its last digits.
TEST(AngleOf, IsTheArcTangentInEveryQuadrant) {
  TestRandom random(5);
  for (int i = 0; i < 200000; ++i) {
    const float size = std::pow(10.0f, 40 * random.next1() - 20);
    const Vec2f p = (random.next2() * 2 - Vec2f(1)) * size;
    ASSERT_NEAR(angle_of(p.x, p.y), std::atan2(double(p.y), double(p.x)), 4e-7) << p.x << " " << p.y;
  }
  EXPECT_EQ(angle_of(0, 0), 0);
  EXPECT_NEAR(angle_of(-1, 0), kPi, 4e-7);
  EXPECT_NEAR(angle_of(-1, -0.0f), -kPi, 4e-7);
  EXPECT_NEAR(angle_of(0, -3), -kPi / 2, 4e-7);
  EXPECT_NEAR(angle_of(2, 2), kPi / 4, 4e-7);
}

}  // namespace
}  // namespace parian

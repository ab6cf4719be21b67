// The tree alone: probabilities, samples, and that no light which reaches a receiver is lost.
#include "renderer/light/light_tree.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A light with what its bounds are made of: a triangle, or a point or spot where the corners are the same.
struct TestLight {
  Vec3f corners[3];
  LightBounds bounds;
};

TestLight make_triangle_light(const Vec3f& a, const Vec3f& b, const Vec3f& c, bool two_sided) {
  TestLight light{{a, b, c}, {}};
  for (const Vec3f& corner : light.corners) light.bounds.box.extendBy(corner);
  light.bounds.axis = Vec3f(Vec3d(b - a).cross(Vec3d(c - a)).normalized());
  light.bounds.two_sided = two_sided;
  light.bounds.intensity = 1;
  return light;
}

TestLight make_spot(const Vec3f& p, const Vec3f& axis, float inner, float outer) {
  TestLight light{{p, p, p}, {}};
  light.bounds.box.extendBy(p);
  light.bounds.axis = axis;
  light.bounds.cos_o = std::cos(inner);
  light.bounds.cos_e = std::cos(outer - inner);
  light.bounds.intensity = 1;
  return light;
}

Vec3f random_point(TestRandom& random) {
  const Vec2f xy = random.next2();
  return Vec3f(xy.x, xy.y, random.next1()) * 2.0f - Vec3f(1);
}

/// Lights of all kinds in the cube of half side `scale` about `offset`, of intensities from 1e-12 to 1; some
/// of no size at all.
std::vector<TestLight> make_lights(int count, TestRandom& random, float scale = 1,
                                   const Vec3f& offset = Vec3f(0)) {
  std::vector<TestLight> lights;
  for (int i = 0; i < count; ++i) {
    const Vec3f p = offset + random_point(random) * scale;
    const float size = scale * std::pow(10.0f, -4 * random.next1());
    if (i % 5 == 0) {
      const float inner = 1.5f * random.next1() * random.next1();
      lights.push_back(make_spot(p, random.direction(), i % 10 ? inner : kPi, i % 10 ? inner + 0.05f : kPi));
      if (i % 20 == 0) lights.back().bounds.range = scale;
    } else {
      lights.push_back(
          make_triangle_light(p, p + random.direction() * size, p + random.direction() * size, i % 3 == 0));
    }
    lights.back().bounds.intensity = std::pow(10.0f, -12 * random.next1() * random.next1());
  }
  return lights;
}

LightTree make_tree(const std::vector<TestLight>& lights) {
  std::vector<LightBounds> bounds;
  for (const TestLight& light : lights) bounds.push_back(light.bounds);
  return LightTree(bounds);
}

double next_number(TestRandom& random) {
  const double high = random.next1();
  return high + 0x1p-24 * double(random.next1());
}

Receiver random_receiver(TestRandom& random, int i, float scale = 1, const Vec3f& offset = Vec3f(0)) {
  const Vec3f p = offset + random_point(random) * (scale * std::pow(10.0f, 1 - 2 * random.next1()));
  return {p, i % 4 == 0 ? Vec3f(0) : random.direction()};
}

// --- Probabilities ---

TEST(LightTree, ProbabilitiesAddUpToOne) {
  TestRandom random(1);
  for (const int count : {1, 2, 8, 9, 100, 2000}) {
    const LightTree tree = make_tree(make_lights(count, random));
    for (int i = 0; i < 50; ++i) {
      const Receiver to = random_receiver(random, i);
      double sum = 0;
      for (int light = 0; light < count; ++light) sum += tree.probability(to, light);
      ASSERT_NEAR(sum, 1, 1e-9) << count;
    }
  }
}

TEST(LightTree, SamplesFollowTheirProbabilities) {
  TestRandom random(2);
  for (const int count : {2, 7, 60, 1000}) {
    const LightTree tree = make_tree(make_lights(count, random));
    for (int i = 0; i < 4; ++i) {
      const Receiver to = random_receiver(random, i);
      constexpr int kSamples = 40000;
      std::vector<double> observed(count, 0), expected(count, 0), rest(16, 0);
      for (int light = 0; light < count; ++light) expected[light] = tree.probability(to, light) * kSamples;
      for (int k = 0; k < kSamples; ++k) {
        const LightTree::Choice chosen = tree.sample(to, next_number(random));
        ASSERT_NEAR(chosen.probability * kSamples, expected[chosen.light], 1e-9 * expected[chosen.light]);
        ASSERT_TRUE(chosen.remainder >= 0 && chosen.remainder < 1);
        ++observed[chosen.light];
        ++rest[std::size_t(chosen.remainder * 16)];
      }
      EXPECT_TRUE(chi_square(observed, expected, 32)) << count;
      EXPECT_TRUE(chi_square(rest, std::vector<double>(16, kSamples / 16.0), 32)) << count;
    }
  }
}

TEST(LightTree, TakesAllNumbersBelowOne) {
  TestRandom random(3);
  const LightTree tree = make_tree(make_lights(500, random));
  for (int i = 0; i < 200; ++i)
    for (const double u : {0.0, 0x1p-48, 0.5, 1 - 0x1p-48, 0x1.fffffffffffffp-1}) {
      const LightTree::Choice chosen = tree.sample(random_receiver(random, i), u);
      ASSERT_TRUE(chosen.light >= 0 && chosen.light < 500 && chosen.probability > 0);
      ASSERT_TRUE(chosen.remainder >= 0 && chosen.remainder < 1);
    }
}

// --- Bounds ---

/// Whether light from a point of the light goes to the receiver's receiving side.
bool reaches(const TestLight& light, const Vec3d& from, const Receiver& to) {
  const Vec3d way = Vec3d(to.p) - from;
  const double length = way.length();
  if (length == 0 || length > light.bounds.range) return false;
  if (to.n != Vec3f(0) && Vec3d(to.n).dot(way) >= 0) return false;
  double cosine = Vec3d(light.bounds.axis).dot(way) / length;
  if (light.bounds.two_sided) cosine = std::abs(cosine);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) <
         std::acos(double(light.bounds.cos_o)) + std::acos(double(light.bounds.cos_e));
}

/// Counts the lights whose corners or centre reach the receiver, and those of them that are never chosen.
void count_reaching(const LightTree& tree, const std::vector<TestLight>& lights, const Receiver& to,
                    int& reaching, int& lost) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto& [a, b, c] = lights[i].corners;
    const Vec3d center = (Vec3d(a) + Vec3d(b) + Vec3d(c)) / 3.0;
    if (!reaches(lights[i], Vec3d(a), to) && !reaches(lights[i], Vec3d(b), to) &&
        !reaches(lights[i], Vec3d(c), to) && !reaches(lights[i], center, to))
      continue;
    ++reaching;
    lost += !(tree.probability(to, int(i)) > 0);
  }
}

// By brute force, at all scales. Catches cones without the second side, a cone or horizon of the wrong sign,
// an edge of a light that its bounds leave out, and receivers inside of the bounds.
TEST(LightTree, NeverLosesALightThatReachesTheReceiver) {
  TestRandom random(4);
  for (const float scale : {1e-6f, 1.0f, 1e6f})
    for (const Vec3f& offset : {Vec3f(0), Vec3f(1e4f, -1e4f, 1e4f)}) {
      const std::vector<TestLight> lights = make_lights(300, random, scale, offset);
      const LightTree tree = make_tree(lights);
      int reaching = 0, lost = 0;
      for (int i = 0; i < 300; ++i) {
        Receiver to = random_receiver(random, i, scale, offset);
        // In the plane of a light, or next to it.
        const TestLight& near = lights[std::size_t(i)];
        if (i % 3 == 0) to.p = near.corners[0] + (near.corners[1] - near.corners[2]) * 3.0f;
        if (i % 7 == 0) to.p = near.corners[0];
        if (i % 6 == 0) to.n = near.bounds.axis;
        count_reaching(tree, lights, to, reaching, lost);
      }
      EXPECT_EQ(lost, 0) << scale << " " << offset.x;
      // With the offset, a small scene is but a few points.
      if (scale >= 1) {
        EXPECT_GT(reaching, 10000);
      }
    }
}

// Single precision knows the angles of a narrow cone to a few percent.
TEST(LightTree, FindsNarrowSpotsAtTheirEdge) {
  TestRandom random(9);
  for (int i = 0; i < 200; ++i) {
    const Vec3f p = random_point(random), axis = random.direction();
    const float inner = 0.02f * random.next1(), outer = inner + 0.001f + 0.002f * random.next1();
    const LightTree tree = make_tree({make_spot(p, axis, inner, outer), make_spot(p, -axis, kPi, kPi)});
    const Frame frame = make_frame(axis);
    const double angle = double(outer) - 2e-5;
    const Receiver to{p + axis * float(3 * std::cos(angle)) + frame.x * float(3 * std::sin(angle)), -axis};
    EXPECT_GT(tree.probability(to, 0), 0) << inner << " " << outer;
  }
}

/// Twenty lights around each of the points, all facing along `axis`.
std::vector<TestLight> make_groups(const Vec3f& first, const Vec3f& second, const Vec3f& first_axis,
                                   const Vec3f& second_axis) {
  TestRandom random(5);
  std::vector<TestLight> lights;
  for (int i = 0; i < 40; ++i) {
    const Vec3f p = (i < 20 ? first : second) + random_point(random) * 0.2f;
    const Frame frame = make_frame(i < 20 ? first_axis : second_axis);
    lights.push_back(make_triangle_light(p, p + frame.x * 0.01f, p + frame.y * 0.01f, false));
  }
  return lights;
}

double probability_of_first(const LightTree& tree, const Receiver& to) {
  double sum = 0;
  for (int i = 0; i < 20; ++i) sum += tree.probability(to, i);
  return sum;
}

// A probability that does not depend on the receiver's normal, or on the sides of lights, would be 1/2.
TEST(LightTree, LeavesOutWhatCannotReachTheReceiver) {
  const Vec3f up(0, 1, 0), down(0, -1, 0), above(0, 2, 0), below(0, -2, 0);
  const LightTree facing = make_tree(make_groups(above, below, down, up));
  EXPECT_NEAR(probability_of_first(facing, {Vec3f(0), up}), 1, 1e-9);
  EXPECT_NEAR(probability_of_first(facing, {Vec3f(0), down}), 0, 1e-9);
  EXPECT_NEAR(probability_of_first(facing, {Vec3f(0), Vec3f(0)}), 0.5, 0.1) << "both sides receive";
  const LightTree averted = make_tree(make_groups(above, below, down, down));
  EXPECT_NEAR(probability_of_first(averted, {Vec3f(0), Vec3f(0)}), 1, 1e-9);

  std::vector<TestLight> limited = make_groups(above, below, down, up);
  for (int i = 0; i < 20; ++i) limited[std::size_t(i)].bounds.range = 1;
  EXPECT_NEAR(probability_of_first(make_tree(limited), {Vec3f(0), Vec3f(0)}), 0, 1e-9) << "out of range";
}

// Far away probabilities are as the irradiance: intensity, both cosines, square of the distance.
TEST(LightTree, WeighsSmallLightsByTheirIrradiance) {
  const Vec3f down(0, -1, 0), x(0.001f, 0, 0), z(0, 0, 0.001f);
  const auto lamp = [&](const Vec3f& p, float intensity) {
    TestLight light = make_triangle_light(p, p + x, p + z, false);
    light.bounds.axis = down;
    light.bounds.intensity = intensity;
    return light;
  };
  const LightTree tree = make_tree({lamp({0, 1, 0}, 1), lamp({0, 2, 0}, 3), lamp({1, 1, 0}, 2)});
  const Receiver to{Vec3f(0), {0, 1, 0}};
  const double sum = 1 + 0.75 + 0.5;
  EXPECT_NEAR(tree.probability(to, 0), 1 / sum, 0.002);
  EXPECT_NEAR(tree.probability(to, 1), 0.75 / sum, 0.002);
  EXPECT_NEAR(tree.probability(to, 2), 0.5 / sum, 0.002);
  EXPECT_NEAR(tree.importance(to), sum, 0.004);
}

// --- Degenerate sets of lights ---

TEST(LightTree, LightsOfNoIntensityAreNotChosen) {
  TestRandom random(6);
  std::vector<TestLight> lights = make_lights(30, random);
  for (int i = 0; i < 30; i += 2) lights[std::size_t(i)].bounds.intensity = 0;
  const LightTree tree = make_tree(lights);
  for (int i = 0; i < 100; ++i) {
    const Receiver to = random_receiver(random, i);
    EXPECT_EQ(tree.probability(to, 4), 0);
    EXPECT_EQ(tree.sample(to, next_number(random)).light % 2, 1);
  }
  for (TestLight& light : lights) light.bounds.intensity = 0;
  EXPECT_TRUE(make_tree(lights).empty());
  EXPECT_TRUE(LightTree().empty());
  EXPECT_TRUE(LightTree(std::vector<LightBounds>{}).empty());
}

TEST(LightTree, CoincidentLightsAreChosenAlike) {
  const TestLight one = make_triangle_light({0, 1, 0}, {0.1f, 1, 0}, {0, 1, 0.1f}, true);
  const LightTree tree = make_tree(std::vector<TestLight>(512, one));
  EXPECT_LE(tree.depth(), 10);
  for (int i = 0; i < 512; ++i) EXPECT_NEAR(tree.probability({Vec3f(0), {0, 1, 0}}, i), 1.0 / 512, 1e-9);
}

// Ever closer and weaker lights, of which the heuristic cuts off one after the other.
TEST(LightTree, DepthIsBounded) {
  std::vector<TestLight> lights;
  for (int i = 0; i < 4000; ++i) {
    const float at = std::pow(0.97f, float(i));
    lights.push_back(make_spot({at, 0, 0}, {0, 1, 0}, 0.1f, 0.2f));
    lights.back().bounds.intensity = at * at;
  }
  const LightTree tree = make_tree(lights);
  EXPECT_LE(tree.depth(), LightTree::kMaxDepth);
  double sum = 0;
  for (int i = 0; i < 4000; ++i) sum += tree.probability({{0.3f, 1, 0}, Vec3f(0)}, i);
  EXPECT_NEAR(sum, 1, 1e-9);
}

TEST(LightTree, IsTheSameForAnyNumberOfBuilds) {
  TestRandom random(7);
  const std::vector<TestLight> lights = make_lights(20000, random);  // enough to be built in parallel
  const LightTree a = make_tree(lights), b = make_tree(lights);
  for (int i = 0; i < 20000; i += 7) {
    const Receiver to = random_receiver(random, i);
    ASSERT_EQ(a.probability(to, i), b.probability(to, i));
  }
}

TEST(NightlyLightTree, BuildsAMillionLights) {
  TestRandom random(8);
  const std::vector<TestLight> lights = make_lights(1000000, random);
  const auto start = std::chrono::steady_clock::now();
  const LightTree tree = make_tree(lights);
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  std::printf("%.2f s, %.0f MB, depth %d\n", taken.count(), double(tree.bytes()) / 1e6, tree.depth());
  EXPECT_LE(tree.depth(), LightTree::kMaxDepth);
  int reaching = 0, lost = 0;
  count_reaching(tree, lights, {Vec3f(0), {0, 1, 0}}, reaching, lost);
  EXPECT_EQ(lost, 0);
}

}  // namespace
}  // namespace parian

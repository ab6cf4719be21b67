// Animations: what lies between their keys, and which of them counts.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfAnimation : public GltfTest {
 protected:
  /// Adds an animation of one channel of node 0.
  template <class T>
  void animate(const std::string& path, const std::string& interpolation, const std::vector<float>& times,
               const std::vector<T>& values, bool normalized = false) {
    const int input = builder.add(times, "SCALAR");
    const int output = builder.add(values, path == "rotation" ? "VEC4" : "VEC3", normalized);
    json animation;
    animation["samplers"] = {{{"input", input}, {"output", output}, {"interpolation", interpolation}}};
    animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", path}}}}};
    builder.root["animations"].push_back(std::move(animation));
  }

  Transform at(double seconds) {
    settings.at = seconds;
    return load(builder.glb()).nodes.at(0).transform;
  }

  void expect_rotation(const Quatf& q, double degrees_about_z) const {
    const double half = degrees_about_z * std::numbers::pi / 360;
    EXPECT_NEAR(q.r, std::cos(half), 1e-6);
    EXPECT_NEAR(q.v.x, 0, 1e-6);
    EXPECT_NEAR(q.v.y, 0, 1e-6);
    EXPECT_NEAR(q.v.z, std::sin(half), 1e-6);
  }

  GltfBuilder builder{.root = {{"asset", {{"version", "2.0"}}},
                               {"nodes", {{{"translation", {9, 9, 9}}, {"scale", {2, 2, 2}}}}}},
                      .binary = {}};
  const float half_root = float(std::sqrt(0.5));
};

TEST_F(GltfAnimation, IsNotAppliedWithoutATime) {
  animate<float>("translation", "LINEAR", {0, 1}, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(load(builder.glb()).nodes[0].transform.translation, Vec3f(9, 9, 9));
  EXPECT_TRUE(warnings.empty());
}

TEST_F(GltfAnimation, SaysThatThereIsNone) {
  EXPECT_EQ(at(1).translation, Vec3f(9, 9, 9));
  EXPECT_EQ(warnings, std::vector<std::string>{path("scene.glb") + ": there are no animations"});
}

TEST_F(GltfAnimation, Steps) {
  animate<float>("translation", "STEP", {1, 2, 4}, {1, 0, 5, 2, 0, 5, 4, 0, 5});
  const std::vector<std::pair<double, float>> expected = {{0, 1}, {1, 1},   {1.999, 1}, {2, 2},
                                                          {3, 2}, {3.9, 2}, {4, 4},     {100, 4}};
  for (const auto& [time, x] : expected) EXPECT_EQ(at(time).translation, Vec3f(x, 0, 5)) << time;
  EXPECT_EQ(at(1).scale, Vec3f(2, 2, 2));  // what is not animated stays
}

TEST_F(GltfAnimation, InterpolatesLinearly) {
  animate<float>("scale", "LINEAR", {1, 2, 4}, {1, 0, -1, 2, 4, -2, 4, 0, -3});
  EXPECT_EQ(at(0).scale, Vec3f(1, 0, -1));  // before the first key
  EXPECT_EQ(at(1).scale, Vec3f(1, 0, -1));
  EXPECT_EQ(at(1.25).scale, Vec3f(1.25f, 1, -1.25f));
  EXPECT_EQ(at(3).scale, Vec3f(3, 2, -2.5f));
  EXPECT_EQ(at(9).scale, Vec3f(4, 0, -3));  // after the last
  EXPECT_EQ(at(3).translation, Vec3f(9, 9, 9));
}

TEST_F(GltfAnimation, HoldsASingleKey) {
  animate<float>("translation", "LINEAR", {2}, {1, 2, 3});
  for (const double time : {0.0, 2.0, 3.0}) EXPECT_EQ(at(time).translation, Vec3f(1, 2, 3));
}

// Tangents are per second, so that they count by the duration, 2; those at the ends are not used.
TEST_F(GltfAnimation, InterpolatesBySplines) {
  animate<float>("translation", "CUBICSPLINE", {1, 3},
                 {100, 100, 100, 0, 1, 5, 1, 0, 0, -1, 0, 0, 4, 1, 5, 100, 100, 100});
  EXPECT_EQ(at(0).translation, Vec3f(0, 1, 5));
  EXPECT_EQ(at(1).translation, Vec3f(0, 1, 5));
  // At a quarter: 2 * 9/64 * 1 + 10/64 * 4 + 2 * -3/64 * -1.
  EXPECT_FLOAT_EQ(at(1.5).translation.x, 1);
  EXPECT_FLOAT_EQ(at(2).translation.x, 2.5f);
  EXPECT_FLOAT_EQ(at(2).translation.y, 1);
  EXPECT_FLOAT_EQ(at(2).translation.z, 5);
  EXPECT_EQ(at(4).translation, Vec3f(4, 1, 5));
}

// A chord that is only made unit would be at 21.6 degrees.
TEST_F(GltfAnimation, TurnsEvenly) {
  animate<float>("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, half_root, half_root});
  expect_rotation(at(0.25).rotation, 22.5);
  expect_rotation(at(0.5).rotation, 45);
  expect_rotation(at(1).rotation, 90);
}

TEST_F(GltfAnimation, TurnsTheShorterWay) {
  animate<float>("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, -half_root, -half_root});
  expect_rotation(at(0.25).rotation, 22.5);
  builder.root.erase("animations");
  animate<float>("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 0, -1});  // the same rotation
  expect_rotation(at(0.25).rotation, 0);
}

TEST_F(GltfAnimation, ReadsRotationsOfEveryType) {
  animate<std::int8_t>("rotation", "LINEAR", {0, 1}, {0, 0, 0, 127, 0, 0, 90, 90}, true);
  expect_rotation(at(0.5).rotation, 45);
  builder.root.erase("animations");
  animate<std::int16_t>("rotation", "STEP", {0, 1}, {0, 0, 0, 32767, 0, 0, -32768, 0}, true);
  EXPECT_EQ(at(1).rotation, Quatf(0, 0, 0, -1));
  builder.root.erase("animations");
  animate<std::uint16_t>("rotation", "STEP", {0}, {0, 0, 65535, 65535}, true);
  expect_rotation(at(1).rotation, 90);
  builder.root.erase("animations");
  animate<std::uint8_t>("rotation", "STEP", {0}, {0, 0, 255, 255}, true);
  expect_rotation(at(1).rotation, 90);
}

TEST_F(GltfAnimation, MakesSplinesOfRotationsUnit) {
  const float r = half_root;
  animate<float>("rotation", "CUBICSPLINE", {0, 1},
                 {9, 9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, r, r, 9, 9, 9, 9});
  const Quatf half = at(0.5).rotation;  // the mean of both, made unit
  expect_rotation(half, 45);
  EXPECT_NEAR(half.length(), 1, 1e-6);
}

TEST_F(GltfAnimation, LaterAnimationsOverrideEarlierOnes) {
  animate<float>("translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  animate<float>("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 3, 3});
  animate<float>("translation", "LINEAR", {0, 2}, {0, 0, 0, 0, 4, 0});
  const Transform transform = at(1);
  EXPECT_EQ(transform.translation, Vec3f(0, 2, 0));
  EXPECT_EQ(transform.scale, Vec3f(3, 3, 3));
}

TEST_F(GltfAnimation, IgnoresChannelsWithoutANode) {
  animate<float>("translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0});
  json& channels = builder.root["animations"][0]["channels"];
  json other = channels[0];
  other["target"] = {{"path", "pointer"}};
  channels.insert(channels.begin(), other);
  EXPECT_EQ(at(0.5).translation, Vec3f(0.5f, 0, 0));
  channels[1]["target"]["path"] = "weights";  // and the numbers of the others stay
  EXPECT_EQ(refusal(builder.glb()),
            "/animations/0/channels/1/target/node: expected a node whose mesh has morph targets");
}

TEST_F(GltfAnimation, RefusesWhatItCannotPlay) {
  const auto refused = [&](const json::json_pointer& place, const json& value, const std::string& expected) {
    GltfBuilder broken = builder;
    broken.root[place] = value;
    const std::string message = refusal(broken.glb());
    EXPECT_EQ(message.substr(0, expected.size()), expected) << place << " = " << value << ": " << message;
  };
  using Place = json::json_pointer;
  settings.at = 0.5;
  animate<float>("rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0, 1, 0});
  const int unordered = builder.add<float>({0, 0}, "SCALAR"),
            negative = builder.add<float>({-1, 1}, "SCALAR"), one = builder.add<float>({0}, "SCALAR"),
            nan = builder.add<float>({0, NAN}, "SCALAR"),
            bytes = builder.add<std::uint8_t>({0, 1}, "SCALAR", true),
            zeros = builder.add<float>({0, 0, 0, 0, 0, 0, 0, 0}, "VEC4"),
            plain = builder.add<std::int8_t>({0, 0, 0, 1, 0, 0, 0, 1}, "VEC4"),
            three = builder.add<float>({0, 0, 0, 1, 1, 1}, "VEC3"),
            one_turn = builder.add<float>({0, 0, 0, 1}, "VEC4");
  ASSERT_EQ(refusal(builder.glb()), "");
  const Place input("/animations/0/samplers/0/input"), output("/animations/0/samplers/0/output");
  const std::string rising = ": expected rising times of at least 0, since /animations/0/samplers/0/input";
  refused(input, unordered, fmt::format("/accessors/{}{}", unordered, rising));
  refused(input, negative, fmt::format("/accessors/{}{}", negative, rising));
  refused(input, nan, fmt::format("/accessors/{}: expected finite numbers, element 1 holds nan", nan));
  refused(input, bytes, "/animations/0/samplers/0/input: expected an accessor of SCALAR, float");
  refused(input, three, "/animations/0/samplers/0/input: expected an accessor of SCALAR, float");
  refused(input, one, "/animations/0/samplers/0/output: expected 1 elements for 1 times, not 2");
  refused(output, one_turn, "/animations/0/samplers/0/output: expected 2 elements for 2 times, not 1");
  refused(output, three, "/animations/0/samplers/0/output: expected an accessor of VEC4");
  refused(output, plain, "/animations/0/samplers/0/output: expected an accessor of VEC4");
  refused(output, zeros, "/animations/0/samplers/0/output: expected a rotation at 0.5 s, not zero");
  const Place path("/animations/0/channels/0/target/path");
  refused(path, "scale", "/animations/0/samplers/0/output: expected an accessor of VEC3, float");
  refused(path, "color", "/animations/0/channels/0/target/path: expected one of \"translation\"");
  refused(path, "weights", "/animations/0/channels/0/target/node: expected a node whose mesh has morph");
  const Place spline("/animations/0/samplers/0/interpolation");
  refused(spline, "CUBICSPLINE", "/animations/0/samplers/0/output: expected 6 elements for 2 times, not 2");
  refused(spline, "CUBIC", "/animations/0/samplers/0/interpolation: expected one of \"LINEAR\"");
  refused(Place("/animations/0/samplers/0"),
          {{"input", one}, {"output", three}, {"interpolation", "CUBICSPLINE"}},
          "/animations/0/samplers/0/output: expected an accessor of VEC4");
  refused(Place("/animations/0/samplers/0"),
          {{"input", one}, {"output", one_turn}, {"interpolation", "CUBICSPLINE"}},
          "/animations/0/samplers/0/input: expected at least 2 times");
  refused(Place("/animations/0/channels/0/sampler"), 1,
          "/animations/0/channels/0/sampler: expected an index into /animations/0/samplers");
  refused(Place("/animations/0/channels/1"), builder.root["animations"][0]["channels"][0],
          "/animations/0/channels/1/target: expected a node and path that no channel before it");
  refused(Place("/nodes/0"), {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}},
          "/animations/0/channels/0/target/node: expected a node without a matrix");
}

}  // namespace
}  // namespace parian

// The table of properties: every one takes its whole range, gives back what it took, and refuses the rest.
#include "editing/properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "scene_io/metals.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

using edit::Property;
using edit::PropertyKind;
using edit::PropertyValue;

const double kNan = std::numeric_limits<double>::quiet_NaN();

/// One element of each type, with what its properties depend on.
Scene one_of_each() {
  Scene scene;
  scene.shapes.resize(1);
  scene.lights.resize(1);
  scene.cameras.resize(1);
  scene.materials.resize(1);
  return scene;
}

PropertyValue with(const Property& p, double number) {
  if (p.kind == PropertyKind::integer) return int(number);
  if (p.kind == PropertyKind::color) return Rgb(float(number));
  return number;
}

/// Whether a value came back, to the rounding of float and of degrees.
bool is_same(const PropertyValue& a, const PropertyValue& b) {
  const double* number = std::get_if<double>(&a);
  if (!number || !std::holds_alternative<double>(b)) return a == b;
  return std::abs(*number - std::get<double>(b)) <= 1e-6 * std::abs(*number);
}

void expect_taken(const Property& p, const Scene& before, const PropertyValue& value) {
  Scene scene = before;
  ASSERT_NO_THROW(p.set(scene, 0, value)) << p.name;
  EXPECT_NO_THROW(validate(scene, "edited")) << p.name;
  EXPECT_TRUE(is_same(value, p.get(scene, 0))) << p.name;
}

void expect_refused(const Property& p, const Scene& before, const PropertyValue& value) {
  Scene scene = before;
  try {
    p.set(scene, 0, value);
    ADD_FAILURE() << p.name << " takes what it must not";
  } catch (const UsageError& error) {
    const std::string reason = error.what();
    EXPECT_EQ(reason.find(std::string(p.label) + ": expected "), 0u) << reason;
  }
  EXPECT_TRUE(scene == before) << p.name;
}

void check_numbers(const Property& p, const Scene& scene) {
  // What lies beside the range as a float; of the largest, infinity.
  const auto above = [](double x) { return double(std::nextafter(float(x), kInfinity)) * (1 + 1e-9); };
  const bool cone = p.name == "inner_angle" || p.name == "outer_angle", bounded = p.high < 1e30;
  // A colour with its strength apart comes back with a brightest component of 1, and a metal has none of
  // 1e38.
  if (!cone) expect_taken(p, scene, with(p, bounded ? p.high : 1e6));
  if (!cone && p.name != "radius_bottom" && p.name != "ior") expect_taken(p, scene, with(p, p.low));
  if (p.kind == PropertyKind::integer) return;
  expect_refused(p, scene, with(p, kNan));
  expect_refused(p, scene, with(p, double(kInfinity)));
  expect_refused(p, scene, with(p, -double(kInfinity)));
  if (bounded) expect_refused(p, scene, with(p, above(p.high)));
  if (p.low > -1e30) expect_refused(p, scene, with(p, p.low == 0 ? -1e-30 : -above(-p.low)));
  if (p.kind == PropertyKind::color) expect_refused(p, scene, Rgb(0.5f, 0.5f, -1));
}

void check(const Property& p, const Scene& scene) {
  EXPECT_FALSE(p.label.empty());
  EXPECT_NO_THROW(p.get(scene, 0)) << p.name;
  switch (p.kind) {
    case PropertyKind::number:
    case PropertyKind::angle:
    case PropertyKind::integer:
    case PropertyKind::color:
      EXPECT_GT(p.step, 0) << p.name;
      check_numbers(p, scene);
      expect_refused(p, scene, std::string("1"));
      break;
    case PropertyKind::toggle:
      for (const bool on : {true, false}) expect_taken(p, scene, on);
      expect_refused(p, scene, 1.0);
      break;
    case PropertyKind::choice:
      EXPECT_GE(p.choices.size(), 2u);
      for (const std::string& choice : p.choices) {
        // "custom" changes nothing; a metal has two spellings.
        if (choice != "custom" && choice != "aluminum") expect_taken(p, scene, choice);
      }
      expect_refused(p, scene, std::string("none of these"));
      break;
    case PropertyKind::text:
      expect_taken(p, scene, std::string("a name"));
      expect_refused(p, scene, true);
  }
  expect_taken(p, scene, p.get(scene, 0));
}

std::set<std::string> check_all(const std::vector<Property>& properties, const Scene& scene) {
  std::set<std::string> names;
  for (const Property& p : properties) {
    check(p, scene);
    EXPECT_TRUE(names.insert(std::string(p.name)).second) << p.name << " is there twice";
  }
  return names;
}

// Caught: NaN let through, here and in the lists below.
TEST(Properties, OfShapes) {
  const std::pair<ShapeKind, std::set<std::string>> kinds[] = {
      {ShapeKind::sphere, {"name", "radius"}},
      {ShapeKind::cylinder, {"name", "radius_bottom", "radius_top", "height"}},
      {ShapeKind::box, {"name", "size.x", "size.y", "size.z"}},
      {ShapeKind::plane, {"name", "size.x", "size.z"}}};
  for (const auto& [kind, names] : kinds) {
    Scene scene = one_of_each();
    scene.shapes[0].kind = kind;
    EXPECT_EQ(check_all(edit::shape_properties(scene.shapes[0]), scene), names);
  }
}

TEST(Properties, OneRadiusOfACylinderMayBeZero) {
  Scene scene = one_of_each();
  scene.shapes[0].kind = ShapeKind::cylinder;
  const auto properties = edit::shape_properties(scene.shapes[0]);
  edit::find_property(properties, "radius_top").set(scene, 0, 0.0);
  EXPECT_THROW(edit::find_property(properties, "radius_bottom").set(scene, 0, 0.0), UsageError);
  EXPECT_EQ(scene.shapes[0].radius_bottom, Shape{}.radius_bottom);
}

TEST(Properties, OfLights) {
  const std::set<std::string> all = {"name", "kind", "color", "intensity"};
  const std::pair<const char*, std::set<std::string>> units[] = {
      {"W/sr", {"range"}},
      {"W/sr", {"range", "inner_angle", "outer_angle"}},
      {"W/m^2", {}},
      {"W/(m^2 sr)", {"width", "height"}},
      {"W/(m^2 sr)", {"diameter"}}};
  for (int kind = 0; kind < 5; ++kind) {
    Scene scene = one_of_each();
    scene.lights[0].kind = LightKind(kind);
    const auto properties = edit::light_properties(scene.lights[0]);
    std::set<std::string> expected = units[kind].second;
    expected.insert(all.begin(), all.end());
    EXPECT_EQ(check_all(properties, scene), expected);
    EXPECT_EQ(edit::find_property(properties, "intensity").unit, units[kind].first);
  }
}

TEST(Properties, TheInnerConeStaysBelowTheOuter) {
  Scene scene = one_of_each();
  scene.lights[0].kind = LightKind::spot;
  const auto properties = edit::light_properties(scene.lights[0]);
  const Property &inner = edit::find_property(properties, "inner_angle"),
                 &outer = edit::find_property(properties, "outer_angle");
  outer.set(scene, 0, 90.0);
  EXPECT_EQ(scene.lights[0].outer_angle, kPi / 2);
  inner.set(scene, 0, 60.0);
  EXPECT_FLOAT_EQ(scene.lights[0].inner_angle, kPi / 3);
  expect_refused(outer, scene, 60.0);
  outer.set(scene, 0, 61.0);
  expect_refused(inner, scene, 61.0);
}

// A light's numbers that its kind does not look at may be anything.
TEST(Properties, AnotherKindOfLightIsValid) {
  for (const char* kind : {"spot", "rectangle", "disk"}) {
    Scene scene = one_of_each();
    Light& light = scene.lights[0];
    light.inner_angle = light.outer_angle = 3;
    light.width = -1, light.height = float(kNan);
    edit::find_property(edit::light_properties(light), "kind").set(scene, 0, std::string(kind));
    EXPECT_NO_THROW(validate(scene, kind));
  }
}

TEST(Properties, OfCameras) {
  Scene scene = one_of_each();
  const auto names = [&] { return check_all(edit::camera_properties(scene.cameras[0]), scene); };
  EXPECT_EQ(names(), (std::set<std::string>{"name", "projection", "yfov", "aspect", "lens"}));
  const auto properties = edit::camera_properties(scene.cameras[0]);
  edit::find_property(properties, "lens").set(scene, 0, true);
  EXPECT_EQ(names().size(), 10u);
  edit::find_property(properties, "yfov").set(scene, 0, 60.0);
  EXPECT_FLOAT_EQ(scene.cameras[0].yfov, kPi / 3);
  edit::find_property(properties, "projection").set(scene, 0, std::string("orthographic"));
  EXPECT_EQ(names(), (std::set<std::string>{"name", "projection", "xmag", "ymag"}));
  // Those of a perspective are of this camera no more.
  expect_refused(edit::find_property(properties, "yfov"), scene, 50.0);
}

TEST(Properties, OfTheEnvironment) {
  Scene scene;
  const auto properties = edit::environment_properties();
  EXPECT_EQ(check_all(properties, scene), (std::set<std::string>{"color", "radiance", "rotation"}));
  edit::find_property(properties, "radiance").set(scene, 0, 2.0);
  edit::find_property(properties, "color").set(scene, 0, Rgb(1, 0.5f, 0.25f));
  EXPECT_EQ(scene.environment.radiance, Rgb(2, 1, 0.5f));
  edit::find_property(properties, "rotation").set(scene, 0, 90.0);
  const Vec3f turned = scene.environment.rotation.rotateVector(Vec3f(1, 0, 0));
  EXPECT_NEAR(turned.z, -1, 1e-6f);
}

/// Turns on every part of a material that its type has.
void turn_all_on(Scene& scene) {
  for (int round = 0; round < 2; ++round)  // some are there only with others
    for (const Property& p : edit::material_properties(scene.materials[0]))
      if (p.kind == PropertyKind::toggle && p.name != "unlit") p.set(scene, 0, true);
}

TEST(Properties, OfMaterials) {
  const std::pair<const char*, std::set<std::string>> types[] = {
      {"metallic-roughness",
       {"base_color",
        "metallic",
        "roughness",
        "ior",
        "specular",
        "specular_color",
        "transmission.factor",
        "volume.thickness",
        "volume.attenuation_color",
        "volume.attenuation_distance",
        "dispersion",
        "scatter.multiscatter_color",
        "scatter.anisotropy",
        "diffuse_transmission.factor",
        "clearcoat.factor",
        "sheen.color",
        "anisotropy.strength",
        "anisotropy.rotation",
        "iridescence.ior",
        "priority"}},
      {"phong", {"phong.diffuse", "phong.specular", "phong.exponent"}},
      {"conductor", {"conductor.metal", "conductor.eta", "conductor.k", "roughness"}},
      {"subsurface",
       {"subsurface.substance", "subsurface.absorption", "subsurface.reduced_scattering", "ior",
        "priority"}}};
  for (const auto& [type, expected] : types) {
    Scene scene = one_of_each();
    edit::find_property(edit::material_properties(scene.materials[0]), "type")
        .set(scene, 0, std::string(type));
    turn_all_on(scene);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    const std::set<std::string> names = check_all(edit::material_properties(scene.materials[0]), scene);
    for (const std::string& name : expected) EXPECT_TRUE(names.contains(name)) << type << ": " << name;
    for (const char* name : {"emission.color", "emission.strength", "alpha", "alpha_cutoff", "double_sided"})
      EXPECT_TRUE(names.contains(name)) << type << ": " << name;
    EXPECT_EQ(names.contains("base_color"),
              std::string_view(type) == "metallic-roughness" || std::string_view(type) == "subsurface");
  }
}

TEST(Properties, MaterialsByName) {
  Scene scene = one_of_each();
  const auto set = [&](const char* name, const char* value) {
    edit::find_property(edit::material_properties(scene.materials[0]), name)
        .set(scene, 0, std::string(value));
  };
  set("type", "conductor");
  set("conductor.metal", "gold");
  EXPECT_EQ(scene.materials[0].conductor, find_metal("gold"));
  set("type", "subsurface");
  set("subsurface.substance", "wholemilk");
  EXPECT_FALSE(scene.materials[0].conductor);
  EXPECT_FLOAT_EQ(scene.materials[0].subsurface->reduced_scattering.x, 2550);  // per metre
  EXPECT_FLOAT_EQ(scene.materials[0].ior, 1.3f);
}

// A subsurface body has no other inside beside it, and scattering none without its volume.
TEST(Properties, WhatDoesNotGoTogetherGoes) {
  Scene scene = one_of_each();
  turn_all_on(scene);
  ASSERT_TRUE(scene.materials[0].scatter);
  Scene other = scene;
  const auto properties = edit::material_properties(scene.materials[0]);
  edit::find_property(properties, "volume").set(scene, 0, false);
  EXPECT_FALSE(scene.materials[0].scatter);
  edit::find_property(properties, "type").set(other, 0, std::string("subsurface"));
  EXPECT_FALSE(other.materials[0].scatter);
  expect_refused(edit::find_property(properties, "transmission.factor"), other, 0.5);
}

TEST(Properties, AnIndexIsZeroOrAtLeastOne) {
  Scene scene = one_of_each();
  const auto properties = edit::material_properties(scene.materials[0]);
  const Property& ior = edit::find_property(properties, "ior");
  expect_taken(ior, scene, 0.0);
  expect_taken(ior, scene, 1.0);
  expect_refused(ior, scene, 0.99);
}

TEST(Properties, EmissionKeepsItsColour) {
  Scene scene = one_of_each();
  const auto properties = edit::material_properties(scene.materials[0]);
  edit::find_property(properties, "emission.color").set(scene, 0, Rgb(1, 0.5f, 0));
  edit::find_property(properties, "emission.strength").set(scene, 0, 8.0);
  EXPECT_EQ(scene.materials[0].emission, Rgb(8, 4, 0));
  EXPECT_EQ(edit::find_property(properties, "emission.color").get(scene, 0), PropertyValue(Rgb(1, 0.5f, 0)));
}

TEST(Properties, UnknownNamesAndIndicesAreRefused) {
  Scene scene = one_of_each();
  const auto properties = edit::shape_properties(scene.shapes[0]);
  try {
    edit::find_property(properties, "weight");
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "property: expected one of name, radius, not weight");
  }
  EXPECT_THROW(edit::find_property(properties, "radius").set(scene, 1, 1.0), UsageError);
  EXPECT_THROW(edit::find_property(properties, "radius").get(scene, -1), UsageError);
}

}  // namespace
}  // namespace parian

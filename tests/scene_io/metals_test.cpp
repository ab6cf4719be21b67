#include "scene_io/metals.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace parian {
namespace {

float reflectance(float n, float k) { return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k); }

/// At normal incidence, from air.
Rgb reflectance(const char* name) {
  const ConductorModel m = find_metal(name).value();
  return {reflectance(m.eta.x, m.k.x), reflectance(m.eta.y, m.k.y), reflectance(m.eta.z, m.k.z)};
}

TEST(Metals, ReflectAsTheyLook) {
  const Rgb silver = reflectance("silver");
  EXPECT_GT(std::min({silver.x, silver.y, silver.z}), 0.95f);
  const Rgb aluminium = reflectance("aluminium");
  for (const float channel : {aluminium.x, aluminium.y, aluminium.z}) EXPECT_NEAR(channel, 0.914f, 0.01f);
  for (const char* name : {"gold", "copper", "brass"}) {
    const Rgb r = reflectance(name);
    EXPECT_GT(r.x, 0.85f) << name;
    EXPECT_GT(r.x, r.y + 0.05f) << name;
    EXPECT_GT(r.y, r.z + 0.05f) << name;
  }
  EXPECT_GT(reflectance("gold").y, reflectance("copper").y);  // yellow, not red
  for (const char* name :
       {"iron", "chromium", "nickel", "cobalt", "titanium", "platinum", "tungsten", "zinc"}) {
    const Rgb r = reflectance(name);
    for (const float channel : {r.x, r.y, r.z}) EXPECT_NEAR(channel, 0.67f, 0.2f) << name;
    EXPECT_LT(std::max({r.x, r.y, r.z}) - std::min({r.x, r.y, r.z}), 0.15f) << name;  // grey
  }
}

TEST(Metals, AreListedByTheNamesTheyAreFoundBy) {
  const std::vector<std::string> names = metal_names();
  EXPECT_EQ(names.size(), 14u);
  for (const std::string& name : names) EXPECT_TRUE(find_metal(name)) << name;
  EXPECT_EQ(find_metal("aluminum"), find_metal("aluminium"));
  EXPECT_FALSE(find_metal("Gold"));
  EXPECT_FALSE(find_metal(""));
}

}  // namespace
}  // namespace parian

#include "materials/layered.h"

#include <gtest/gtest.h>

#include "materials/metallic_roughness.h"
#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

/// A dielectric of base colour .8 and roughness alpha, without any extension.
Layered plain(float metallic, float alpha) {
  const Rgb base(0.8f, 0.8f, 0.8f);
  return {metallic,      base, {base, Rgb(0, 0, 0)}, 0, {1.5f, base, {alpha}, true, Rgb(0.04f), 1},
          {alpha, alpha}};
}

struct Named {
  const char* name;
  Layered lobe;
};

std::vector<Named> variants() {
  std::vector<Named> all{{"plain", plain(0.3f, 0.3f)}};
  const auto add = [&](const char* name, float metallic, const auto& change) {
    all.push_back({name, plain(metallic, 0.3f)});
    change(all.back().lobe);
  };
  add("half transmission", 0.2f, [](Layered& l) { l.transmission = 0.5f; });
  add("half refraction", 0, [](Layered& l) {
    l.transmission = 0.5f;
    l.dielectric.thin = false;
  });
  add("half refraction from inside", 0, [](Layered& l) {
    l.transmission = 0.5f;
    l.dielectric.thin = false;
    l.dielectric.eta = 1 / 1.5f;
  });
  add("diffuse transmission", 0, [](Layered& l) { l.diffuse = {Rgb(0.3f), Rgb(0.2f, 0.4f, 0.6f)}; });
  add("coat", 0.5f, [](Layered& l) {
    l.coat = 1;
    l.coat_ggx = {0.1f};
  });
  add("coat with a normal", 0, [](Layered& l) {
    l.coat = 0.7f;
    l.coat_ggx = {0.2f};
    l.coat_normal = normalize(Vec3f(0.3f, -0.2f, 1));
  });
  add("sheen", 0, [](Layered& l) { l.sheen = {Rgb(0.6f, 0.3f, 0.1f), 0.3f}; });
  add("anisotropy", 1, [](Layered& l) {
    l.facets.alpha_x = 0.8f;
    l.tangent = {0.6f, 0.8f};
  });
  add("iridescence", 0.5f, [](Layered& l) {
    l.iridescence = 1;
    l.film_ior = 1.4f;
    l.film_thickness = 350;
  });
  return all;
}

// Without extensions it is the metallic-roughness lobe.
TEST(Layered, IsTheBaseWhereNothingIsAdded) {
  for (const float metallic : {0.0f, 0.4f, 1.0f}) {
    const Layered lobe = plain(metallic, 0.3f);
    const MetallicRoughness reference{Rgb(0.8f), metallic, Rgb(0.04f), 1, Ggx{0.3f}};
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      const Vec3f wo = at_cosine(cosine), wi = at_cosine(0.4f, 3.0f);
      EXPECT_NEAR(lobe.eval(wo, wi).f_cos.x, reference.eval(wo, wi).f_cos.x, 1e-5);
    }
  }
}

// Samples follow the density, which is that of all parts together; weights are f / pdf.
TEST(Layered, SamplesWithItsDensity) {
  for (const auto& [name, lobe] : variants())
    for (const float cosine : {0.95f, 0.2f}) {
      const Vec3f wo = at_cosine(cosine);
      TestRandom random(std::uint32_t(cosine * 100));
      const auto sample = [&]() -> std::optional<Vec3f> {
        const float u = random.next1();
        const auto s = lobe.sample(wo, u, random.next2());
        if (!s) return std::nullopt;
        const BsdfValue value = lobe.eval(wo, s->wi);
        EXPECT_NEAR(value.pdf / s->pdf, 1, 1e-3);
        EXPECT_NEAR(value.f_cos.x / s->pdf, s->weight.x, 1e-3 * s->weight.x + 1e-6);
        return s->wi;
      };
      const SphereCells cells{.rings = 24, .sectors = 16, .tolerance = 1e-6, .depth = 6};
      EXPECT_TRUE(samples_directions(
          sample, [&](const Vec3f& wi) { return lobe.eval(wo, wi).pdf; }, cells, 60000, 20))
          << name << " at " << cosine;
    }
}

// A furnace: no variant gives back more than it gets (but for the coupling of glTF's coat and base at grazing
// angles, which these angles leave out).
TEST(Layered, AddsNoEnergy) {
  for (const auto& [name, lobe] : variants())
    for (const float cosine : {0.95f, 0.5f}) {
      TestRandom random(2);
      constexpr int kSamples = 40000;
      double sum = 0;
      for (int i = 0; i < kSamples; ++i) {
        const float u = random.next1();
        if (const auto s = lobe.sample(at_cosine(cosine), u, random.next2())) sum += s->weight.x / kSamples;
      }
      EXPECT_LT(sum, 1.0) << name << " at " << cosine;
      EXPECT_GT(sum, 0.4) << name << " at " << cosine;
    }
}

// Stretched facets spread the highlight along their direction.
TEST(Layered, AnisotropySpreadsAlongTheTangent) {
  Layered lobe = plain(1, 0.1f);
  lobe.facets.alpha_x = 0.6f;
  lobe.tangent = {0, 1};  // along the frame's y
  const Vec3f wo(0, 0, 1), along = at_cosine(0.8f, kPi / 2), across = at_cosine(0.8f, 0);
  EXPECT_GT(lobe.eval(wo, along).f_cos.x, 10 * lobe.eval(wo, across).f_cos.x);
}

// KHR_materials_clearcoat: at normal incidence the base keeps 1 - .04 of its light.
TEST(Layered, ACoatTakesItsShareOfTheBase) {
  Layered lobe = plain(0, 0.5f);
  const Vec3f wo(0, 0, 1), wi = at_cosine(0.3f);
  const float before = lobe.eval(wo, wi).f_cos.x;
  lobe.coat = 1;
  lobe.coat_ggx = {1e-3f};  // nothing of it that far from the mirror direction
  EXPECT_NEAR(lobe.eval(wo, wi).f_cos.x / before, 0.96, 1e-3);
}

}  // namespace
}  // namespace parian

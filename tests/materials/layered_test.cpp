#include "materials/layered.h"

#include <gtest/gtest.h>

#include "materials/metallic_roughness.h"
#include "tests/materials/support/lobe_list.h"
#include "tests/materials/support/lobes.h"

namespace parian {
namespace {

// Without extensions it is the metallic-roughness lobe.
TEST(Layered, IsTheBaseWhereNothingIsAdded) {
  for (const float metallic : {0.0f, 0.4f, 1.0f}) {
    const Layered lobe = make_layered_lobe(metallic, 0.3f);
    const MetallicRoughness reference{Rgb(0.8f), metallic, Rgb(0.04f), 1, Ggx{0.3f}};
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      const Vec3f wo = at_cosine(cosine), wi = at_cosine(0.4f, 3.0f);
      EXPECT_NEAR(lobe.eval(wo, wi).f_cos.x, reference.eval(wo, wi).f_cos.x, 1e-5);
    }
  }
}

// Stretched facets spread the highlight along their direction.
TEST(Layered, AnisotropySpreadsAlongTheTangent) {
  Layered lobe = make_layered_lobe(1, 0.1f);
  lobe.facets.alpha_x = 0.6f;
  lobe.tangent = {0, 1};  // along the frame's y
  const Vec3f wo(0, 0, 1), along = at_cosine(0.8f, kPi / 2), across = at_cosine(0.8f, 0);
  EXPECT_GT(lobe.eval(wo, along).f_cos.x, 10 * lobe.eval(wo, across).f_cos.x);
}

// KHR_materials_clearcoat: at normal incidence the base keeps 1 - .04 of its light.
TEST(Layered, ACoatTakesItsShareOfTheBase) {
  Layered lobe = make_layered_lobe(0, 0.5f);
  const Vec3f wo(0, 0, 1), wi = at_cosine(0.3f);
  const float before = lobe.eval(wo, wi).f_cos.x;
  lobe.coat = 1;
  lobe.coat_ggx = {1e-3f};  // nothing of it that far from the mirror direction
  EXPECT_NEAR(lobe.eval(wo, wi).f_cos.x / before, 0.96, 1e-3);
}

// What is below the coat, and the coat, have the coat's Fresnel share at wo alone (KHR_materials_clearcoat):
// f(wo, wi) / f(wi, wo) is the ratio of these shares, up to 4.4 and 20 between the normal and 3 degrees above
// the horizon.
TEST(Layered, ACoatIsNotReciprocal) {
  Layered under = make_layered_lobe(0, 0.5f);
  under.coat = 1;
  under.coat_ggx = {1e-3f};  // nothing of it that far from the mirror direction
  Layered coat = under;
  coat.coat_ggx = {0.5f};
  coat.diffuse.reflected = coat.dielectric.f0 = Rgb(0);
  coat.dielectric.f90 = 0;
  const auto share = [](double mu) { return 0.04 + 0.96 * std::pow(1 - mu, 5); };
  for (const auto& [a, b] : {std::pair(1.0f, 0.05f), {0.7f, 0.3f}, {0.4f, 0.1f}}) {
    const auto asymmetry = [a = at_cosine(a), b = at_cosine(b, 2)](const Layered& lobe) {
      return lobe.eval(a, b).f_cos.x / b.z / (lobe.eval(b, a).f_cos.x / a.z);
    };
    EXPECT_NEAR(asymmetry(under) / ((1 - share(a)) / (1 - share(b))), 1, 1e-3) << a << " " << b;
    EXPECT_NEAR(asymmetry(coat) / (share(a) / share(b)), 1, 1e-3) << a << " " << b;
  }
  EXPECT_NEAR((1 - share(1)) / (1 - share(0.05)), 4.42, 0.01);
  EXPECT_NEAR(share(0.05) / share(1), 19.6, 0.1);
}

// A diffuse sheet takes the Fresnel share of its coat at wo alone where light is transmitted: there is no
// half vector. Up to 15 between the normal and the horizon, half of that within 3 degrees of it.
TEST(Layered, DiffuseTransmissionUnderACoatIsNotReciprocal) {
  Layered lobe = make_layered_lobe(0, 0.5f);
  lobe.diffuse = {Rgb(0), Rgb(0.8f)};
  const auto below = [](double mu) { return 0.96 * (1 - std::pow(1 - mu, 5)); };
  for (const auto& [a, b] : {std::pair(1.0f, 0.05f), {0.7f, 0.3f}, {0.4f, 0.1f}}) {
    const double forth = lobe.eval(at_cosine(a), at_cosine(-b)).f_cos.x / b,
                 back = lobe.eval(at_cosine(b), at_cosine(-a)).f_cos.x / a;
    EXPECT_NEAR(forth / back / (below(a) / below(b)), 1, 1e-4) << a << " " << b;
  }
  EXPECT_NEAR(below(1) / below(0.05), 4.42, 0.01);
}

// What a thin film reflects does not get through, and what meets it beyond the critical angle does not
// either: nothing is lost or made but what smooth facets lose. Without the film's share in the
// transmission 1.16, and .2 to .36 left from inside.
TEST(Layered, AFilmOnGlassTakesFromWhatGetsThrough) {
  for (const bool thin : {false, true})
    for (const float eta : {1.5f, 1 / 1.5f})
      for (const float cosine : {1.0f, 0.7f, 0.3f}) {
        if (thin && eta < 1) continue;
        Layered lobe = make_layered_lobe(0, 0.01f, Rgb(1, 1, 1));
        lobe.dielectric = make_glass_lobe(eta, 0.01f, thin);
        lobe.transmission = 1;
        lobe.iridescence = 1;
        lobe.film_ior = 2;
        lobe.film_thickness = 69;
        const Statistics s = sampled_albedo(lobe, cosine, 20000);
        // The channel is one of three, of which the brightest counts for what is transmitted.
        EXPECT_LE(s.mean(), 1 + 4 * s.standard_error()) << thin << eta << cosine;
        EXPECT_GE(s.mean(), 0.9 - 4 * s.standard_error()) << thin << eta << cosine;
      }
}

}  // namespace
}  // namespace parian

/// Every lobe by name, for tests that all of them must pass.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "materials/bsdf.h"

namespace parian {

/// A lobe of whatever type, with what a test must know of it.
struct TestLobe {
  /// In which variable its density above the surface is smooth at any roughness: the half vector, or the
  /// direction, about its mirror direction or the normal.
  enum class Above { half_vector, about_mirror, about_normal };
  /// And below it: the half vector of the mirrored direction, or that of refraction.
  enum class Below { nothing, mirrored, refracted };

  std::string name;
  float alpha;  // of its narrowest part
  std::function<BsdfValue(const Vec3f&, const Vec3f&)> eval;
  std::function<std::optional<BsdfSample>(const Vec3f&, float, const Vec2f&)> sample;
  Above above = Above::half_vector;
  Below below = Below::nothing;
  float eta = 1;              // where it refracts
  Vec3f axis{0, 0, 1};        // of the half vectors of its narrowest part
  float alpha_along = alpha;  // where facets are stretched, along `tangent`
  Vec2f tangent{1, 0};
  float most_weight = 1.001f;  // of a sample
  bool reciprocal = true;
  /// The lobe seen from the other side of the surface, z turned over.
  std::function<BsdfValue(const Vec3f&, const Vec3f&)> eval_behind = eval;
};

template <Lobe T>
TestLobe make_test_lobe(std::string name, float alpha, const T& lobe) {
  return {std::move(name), alpha, [lobe](const Vec3f& wo, const Vec3f& wi) { return lobe.eval(wo, wi); },
          [lobe](const Vec3f& wo, float u1, const Vec2f& u2) { return lobe.sample(wo, u1, u2); }};
}

/// An interface of glass; seen from inside where eta < 1.
inline Dielectric make_glass_lobe(float eta, float alpha, bool thin = false) {
  const float r = (eta - 1) / (eta + 1);
  return {eta, Rgb(1, 1, 1), {alpha}, thin, Rgb(r * r), 1};
}

/// A glTF surface without extensions.
inline Layered make_layered_lobe(float metallic, float alpha, const Rgb& base = Rgb(0.8f)) {
  return {metallic,      base, {base, Rgb(0, 0, 0)}, 0, {1.5f, base, {alpha}, true, Rgb(0.04f), 1},
          {alpha, alpha}};
}

/// A glTF surface with all extensions. Only its coat is narrow where alpha is small.
inline Layered make_whole_lobe(float alpha) {
  Layered lobe = make_layered_lobe(0.2f, std::max(0.2f, alpha));
  lobe.coat = 0.7f;
  lobe.coat_ggx = {alpha};
  lobe.sheen = {Rgb(0.6f, 0.3f, 0.1f), 0.3f};
  lobe.facets.alpha_x = std::max(0.5f, alpha);
  lobe.tangent = {0.6f, 0.8f};
  lobe.iridescence = 0.8f;
  lobe.film_ior = 1.4f;
  lobe.film_thickness = 350;
  lobe.transmission = 0.5f;
  lobe.diffuse = {Rgb(0.3f), Rgb(0.2f, 0.4f, 0.6f)};
  return lobe;
}

/// All lobes, and each extension of glTF alone and all of them. Where there are two roughnesses, alpha is the
/// smaller.
inline std::vector<TestLobe> make_lobes(float alpha) {
  using Below = TestLobe::Below;
  std::vector<TestLobe> all;
  const auto add = [&](const char* name, const auto& lobe) -> TestLobe& {
    return all.emplace_back(make_test_lobe(name, alpha, lobe));
  };
  const auto eval_of = [](const auto& lobe) {
    return [lobe](const Vec3f& wo, const Vec3f& wi) { return lobe.eval(wo, wi); };
  };
  const Rgb white(1, 1, 1), brown(0.9f, 0.5f, 0.1f), glass_f0(0.04f);

  add("Lambert", Lambert{brown});
  const DiffuseTransmissionLobe leaf{{0.1f, 0.4f, 0.2f}, {0.3f, 0.5f, 0.1f}};
  add("DiffuseTransmission", leaf).below = Below::mirrored;
  add("SubsurfaceExit", SubsurfaceExit{1.4f, SubsurfaceExit::make_inverse_c(1.4f), brown}).reciprocal = false;
  TestLobe& cloth = add("Sheen", Sheen{white, std::max(alpha, Sheen::kMinAlpha)});
  cloth.above = TestLobe::Above::about_normal;
  cloth.most_weight = 100;  // uniform samples of a rim of some degrees
  // The power whose width is alpha.
  const float exponent = std::min(1e6f, std::max(0.0f, 2 / (alpha * alpha) - 2));
  const Phong glossy{{0, 0, 0}, white, exponent},
      mixed_phong{{0.4f, 0.2f, 0.1f}, {0.3f, 0.5f, 0.6f}, exponent};
  for (const auto& [name, phong] : {std::pair("PhongGlossy", glossy), {"PhongMixed", mixed_phong}}) {
    TestLobe& lobe = add(name, phong);
    lobe.above = TestLobe::Above::about_mirror;
    lobe.most_weight = 2.001f;  // (n + 2) / (n + 1)
  }

  // What a smooth metal gives the horizon back is rarely sampled.
  const float smooth = alpha < 0.1f ? 500.0f : 4.0f;
  const Conductor gold{{.143f, .422f, .965f}, {3.983f, 2.347f, 6.40f}, {alpha}};
  add("Conductor", gold);
  add("CompensatedConductor", make_compensated(gold)).most_weight = smooth;
  const MetallicRoughness metal{brown, 1, {0, 0, 0}, 1, {alpha}}, coated{brown, 0, glass_f0, 1, {alpha}},
      mixed{brown, 0.5f, {0.2f, 0.1f, 0}, 0.7f, {alpha}};
  // Each component has a chance of a tenth at least.
  add("Metal", metal);
  add("CoatedBase", coated).most_weight = 11;
  add("HalfMetal", mixed).most_weight = 11;
  add("CompensatedMetal", make_compensated(metal)).most_weight = smooth;
  add("CompensatedCoatedBase", make_compensated(coated)).most_weight = 11;
  add("CompensatedHalfMetal", make_compensated(mixed)).most_weight = smooth;

  const auto glass = [&](const char* name, float eta, bool thin, bool compensated) {
    const auto make = [&](float index) {
      const Dielectric lobe = make_glass_lobe(index, alpha, thin);
      return compensated ? make_compensated(lobe) : lobe;
    };
    TestLobe& lobe = add(name, make(eta));
    lobe.below = thin ? Below::mirrored : Below::refracted;
    if (!thin) lobe.eta = eta;
    lobe.eval_behind = eval_of(make(thin ? eta : 1 / eta));
    lobe.reciprocal = !compensated;
    if (compensated) lobe.most_weight = 5;  // what is left is scaled by what is lost
  };
  glass("Glass", 1.5f, false, false);
  glass("GlassFromInside", 1 / 1.5f, false, false);
  glass("Diamond", 2.4f, false, false);
  glass("ThinGlass", 1.5f, true, false);
  glass("CompensatedGlass", 1.5f, false, true);
  glass("CompensatedGlassFromInside", 1 / 1.5f, false, true);
  glass("CompensatedThinGlass", 1.5f, true, true);

  const auto layered = [&](const char* name, float metallic, const auto& change) -> TestLobe& {
    Layered lobe = make_layered_lobe(metallic, alpha);
    change(lobe);
    TestLobe& added = add(name, lobe);
    added.most_weight = 25;  // each part has a chance of 5% at least, all of them together 1
    if (lobe.transmits()) added.below = Below::mirrored;
    if (lobe.transmission > 0 && !lobe.dielectric.thin) {
      added.below = Below::refracted;
      added.eta = lobe.dielectric.eta;
      lobe.dielectric.eta = 1 / lobe.dielectric.eta;
      added.eval_behind = eval_of(lobe);
    }
    return added;
  };
  layered("LayeredPlain", 0.3f, [](Layered&) {});
  const auto coat = [&](Layered& l) {
    l.coat = 0.7f;
    l.coat_ggx = {alpha};
  };
  layered("LayeredCoat", 0.5f, coat).reciprocal = false;
  const Vec3f coat_normal = normalize(Vec3f(0.3f, -0.2f, 1));
  TestLobe& leaning = layered("LayeredCoatLeaning", 0, [&](Layered& l) {
    coat(l);
    l.facets = {0.5f, 0.5f};
    l.coat_normal = coat_normal;
  });
  leaning.axis = coat_normal;
  leaning.reciprocal = false;
  layered("LayeredSheen", 0, [](Layered& l) { l.sheen = {Rgb(0.6f, 0.3f, 0.1f), 0.3f}; });
  TestLobe& stretched = layered("LayeredAnisotropy", 1, [&](Layered& l) {
    l.facets.alpha_x = alpha + (1 - alpha) * 0.3f;
    l.tangent = {0.6f, 0.8f};
  });
  stretched.alpha_along = alpha + (1 - alpha) * 0.3f;
  stretched.tangent = {0.6f, 0.8f};
  layered("LayeredIridescence", 0.5f, [](Layered& l) {
    l.iridescence = 0.8f;
    l.film_ior = 1.4f;
    l.film_thickness = 350;
  });
  layered("LayeredDiffuseTransmission", 0, [](Layered& l) {
    l.diffuse = {Rgb(0.3f), Rgb(0.2f, 0.4f, 0.6f)};
  }).reciprocal = false;
  layered("LayeredThinTransmission", 0.2f, [](Layered& l) { l.transmission = 0.5f; });
  for (const auto& [name, eta] :
       {std::pair("LayeredRefraction", 1.5f), {"LayeredRefractionFromInside", 1 / 1.5f}})
    layered(name, 0, [eta = eta](Layered& l) {
      l.transmission = 0.5f;
      l.dielectric.thin = false;
      l.dielectric.eta = eta;
    });
  layered("LayeredEverything", 0, [&](Layered& l) { l = make_whole_lobe(alpha); }).reciprocal = false;
  layered("CompensatedLayered", 0.3f, [](Layered& l) { l = make_compensated(l); }).most_weight = smooth + 25;
  TestLobe& everything =
      layered("CompensatedEverything", 0, [&](Layered& l) { l = make_compensated(make_whole_lobe(alpha)); });
  everything.reciprocal = false;
  return all;
}

/// A lobe within a Bsdf: the shading frame is that of the world, and the geometric normal leans by 30
/// degrees. Lifted: the surface pretends to be curved, so that light from below the geometric horizon counts.
/// Bumpy: a normal map makes the difference.
struct Leaning {
  Bsdf::AnyLobe lobe;
  bool lifted = false, bumpy = false;

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    const Surface s = surface(wo);
    return Bsdf(s, lobe).eval(wi);
  }
  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    const Surface s = surface(wo);
    return Bsdf(s, lobe).sample(u1, u2);
  }

 private:
  Surface surface(const Vec3f& wo) const {
    static const Part part{};
    Surface s{};
    s.part = &part;
    s.ng = s.smooth_normal = normalize(Vec3f(0.4f, -0.3f, 0.87f));
    s.wo = wo;
    s.front = wo.dot(s.ng) >= 0;
    s.frame = make_frame({0, 0, 1});
    s.lifted = lifted;
    s.bumpy = bumpy;
    return s;
  }
};
static_assert(Lobe<Leaning>);

/// Lobes of each kind within a Bsdf.
inline std::vector<TestLobe> make_leaning_lobes(float alpha) {
  std::vector<TestLobe> all;
  const auto add = [&](const char* name, const Bsdf::AnyLobe& lobe, float most_weight, bool lifted = false,
                       bool bumpy = false) -> TestLobe& {
    TestLobe& added = all.emplace_back(make_test_lobe(name, alpha, Leaning{lobe, lifted, bumpy}));
    added.most_weight = most_weight;
    return added;
  };
  const Rgb brown(0.9f, 0.5f, 0.1f);
  const MetallicRoughness metal{brown, 1, {0, 0, 0}, 1, {alpha}}, coated{brown, 0, Rgb(0.04f), 1, {alpha}};
  add("BsdfLambert", Lambert{brown}, 1);
  add("BsdfMetal", metal, 1.001f);
  add("BsdfMetalLifted", metal, 1.001f, true);
  add("BsdfCoatedBaseLifted", coated, 11, true);
  add("BsdfCoatedBaseBumpy", coated, 11, false, true);
  add("BsdfEverything", make_whole_lobe(alpha), 25).below = TestLobe::Below::mirrored;
  TestLobe& glass = add("BsdfGlass", make_glass_lobe(1.5f, alpha), 1.001f);
  glass.below = TestLobe::Below::refracted;
  glass.eta = 1.5f;
  return all;
}

}  // namespace parian

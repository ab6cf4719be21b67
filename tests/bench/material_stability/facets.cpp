/// Facets and lobes.
#include "materials/dielectric.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "materials/sheen.h"
#include "tests/bench/material_stability/report.h"
#include "tests/bench/material_stability/textbook.h"
#include "tests/materials/support/lobes.h"

namespace parian {
namespace {

/// A facet normal of the lobe's core and rim, and its cosine and D in long double.
void compare_ggx() {
  TestRandom random(4);
  for (const float alpha : {1e-4f, 1e-3f, 1e-2f}) {
    Largest cosine_form, tangent_form, parian;
    for (int i = 0; i < kTries; ++i) {
      const float tangent = alpha * between(random, 1e-3, 10);
      const Vec2f p = unit_circle(random.next1()) * tangent;
      const Vec3f h = normalize(Vec3f(p.x, p.y, 1));
      const Imath::Vec3<Real> exact(h.x, h.y, h.z);
      const Real truth = textbook_ggx<Real>(exact.z / exact.length(), alpha);
      cosine_form.add(double(textbook_ggx(h.z, alpha) / truth - 1));
      tangent_form.add(double(textbook_ggx_tan(h.z, alpha) / truth - 1));
      parian.add(double(Ggx{alpha}.d(h) / truth - 1));
    }
    const std::string where = fmt::format("alpha {}, to 10 alpha from the peak", number(alpha));
    print_row("D of GGX, relative", where, "`a2 / (pi sq(c*c * (a2 - 1) + 1))`", cosine_form.text(),
              parian.text());
    print_row("D of GGX, relative", where, "`tan2 = (1 - c*c) / (c*c)`", tangent_form.text(), parian.text());
  }
}

void compare_smooth_facets() {
  const Vec3f wo = at_cosine(0.5f), mirror(-wo.x, -wo.y, wo.z);
  const MetallicRoughness lobe{Rgb(1), 1, Rgb(0), 1, {Ggx::kMinAlpha}};
  for (const float alpha : {1e-20f, 0.0f}) {
    Largest naive;
    naive.add(textbook_ggx(normalize(wo + mirror).z, alpha));
    print_row("D of GGX at the peak", fmt::format("alpha {}", number(alpha)), "as above", naive.text(),
              fmt::format("alpha 1e-4: a white metal reflects {}",
                          number(sampled_albedo(lobe, 0.5f, kTries).mean())));
  }
}

/// Weights of a white dielectric: with the facets' density as it is defined, and with what cancels taken out.
void compare_grazing_facets() {
  TestRandom random(5);
  Largest naive, parian;
  for (const float alpha : {Ggx::kMinAlpha, 1e-3f, 1e-2f, 0.1f, 1.0f})
    for (const float cosine : {1.0f, 0.1f, 1e-2f, 1e-3f, 1e-4f, 1e-6f}) {
      const Ggx ggx{alpha};
      const Vec3f wo = at_cosine(cosine);
      for (int i = 0; i < kTries / 20; ++i) {
        const float corners[] = {0, 0.5f, kBelowOne};
        const Vec2f u = i < 9 ? Vec2f(corners[i / 3], corners[i % 3]) : random.next2();
        const Vec3f m = ggx.sample_visible_normal(wo, u), wi = m * (2 * wo.dot(m)) - wo;
        const auto s = MetallicRoughness{Rgb(1), 0, Rgb(0.04f), 1, ggx}.sample(wo, 0, u);
        if (s) parian.add(s->weight.x);
        if (wi.z <= 0) continue;
        // Facets are chosen with probability 1/2.
        const Vec3f h = normalize(wo + wi);
        const float f = 0.04f + 0.96f * schlick_weight(wo.dot(h));
        const float f_cos = f * ggx.d(h) * ggx.g2(wo, wi) / (4 * wo.z) + (1 - f) * kInvPi * wi.z;
        naive.add(f_cos / (0.5f * ggx.pdf_visible_normal(wo, h) / (4 * wo.dot(h)) + 0.5f * kInvPi * wi.z));
      }
    }
  print_row("largest weight of a white dielectric", "alpha 1e-4 to 1, cosines 1e-6 to 1",
            "`G1 D max(0, wo.h) / cos / (4 wo.h)`", naive.text(), parian.text());
}

/// The same lobe, its facets sampled by D(h) cos h alone (Walter et al. 2007), and as they are seen.
void compare_facet_sampling() {
  TestRandom random(6);
  for (const float cosine : {0.1f, 1e-2f, 1e-4f}) {
    const float alpha = 0.5f;
    const Ggx ggx{alpha};
    const Vec3f wo = at_cosine(cosine);
    Largest naive, parian;
    for (int i = 0; i < kTries; ++i) {
      const Vec2f u = random.next2();
      const float c = std::sqrt((1 - u.x) / (1 + (alpha * alpha - 1) * u.x));
      const Vec3f h = at_cosine(c, 2 * kPi * u.y), wi = h * (2 * wo.dot(h)) - wo;
      if (wo.dot(h) > 0 && wi.z > 0) naive.add(ggx.g2(wo, wi) * wo.dot(h) / (wo.z * h.z));
      const auto s = MetallicRoughness{Rgb(1), 1, Rgb(0), 1, ggx}.sample(wo, 0, u);
      if (s) parian.add(s->weight.x);
    }
    print_row("largest weight of a white metal", fmt::format("alpha .5, cosine {}", number(cosine)),
              "facets by D cos", naive.text(), parian.text());
  }
}

void compare_phong() {
  TestRandom random(7);
  for (const float n : {1e2f, 1e4f, 1e6f}) {
    Largest naive, parian;
    for (int i = 0; i < kTries / 4; ++i) {
      const Vec3f wo = at_cosine(0.2f + 0.8f * random.next1(), 6 * random.next1()),
                  mirror(-wo.x, -wo.y, wo.z);
      const float angle = 3 / std::sqrt(n) * random.next1();
      const Vec2f p = unit_circle(random.next1()) * std::sin(angle);
      const Vec3f wi = make_frame(mirror).to_world({p.x, p.y, std::cos(angle)});
      if (wi.z <= 0) continue;
      const Imath::Vec3<Real> a(mirror.x, mirror.y, mirror.z), b(wi.x, wi.y, wi.z);
      const Real truth = std::pow(a.dot(b) / (a.length() * b.length()), Real(n));
      naive.add(double(std::pow(mirror.dot(wi), n) / truth - 1));
      const float f_cos = Phong{Rgb(0), Rgb(1), n}.eval(wo, wi).f_cos.x;
      parian.add(double(f_cos / (wi.z * (n + 2) / (2 * pi<Real>)) / truth - 1));
    }
    print_row("power of the cosine, relative", fmt::format("n {}", number(n)), "`pow(dot(mirror, wi), n)`",
              naive.text(), parian.text());
  }
}

void compare_sheen_base() {
  const Vec3f grazing = at_cosine(0.01f);
  print_row("what white sheen leaves the base", "roughness .07, cosine .01", "`1 - E`",
            number(1 - sheen_albedo(0.01f, Sheen::kMinAlpha)),
            number(Sheen{Rgb(1), Sheen::kMinAlpha}.base_scale(grazing, grazing)));
}

void compare_sheen() {
  TestRandom random(8);
  Largest naive, parian;
  const float alpha = Sheen::kMinAlpha;
  for (int i = 0; i < kTries; ++i) {
    const Vec3f h = at_cosine(0.3f * random.next1(), 6 * random.next1());
    const Imath::Vec3<Real> exact(h.x, h.y, h.z);
    const Real truth = textbook_sheen<Real>(exact.z / exact.length(), alpha);
    naive.add(double(textbook_sheen(h.z, alpha) / truth - 1));
    parian.add(double(Sheen{Rgb(1), alpha}.d(h) / truth - 1));
  }
  print_row("D of sheen, relative", "roughness .07", "`pow(1 - c*c, 1 / (2 alpha))`", naive.text(),
            parian.text());
}

void compare_energy() {
  for (const auto& [metallic, roughness, cosine] :
       {std::tuple(1.0f, 1.0f, 1.0f), {1.0f, 0.5f, 0.5f}, {0.0f, 0.1f, 0.05f}}) {
    const MetallicRoughness lobe{Rgb(1), metallic, Rgb(0.04f), 1, {roughness * roughness}};
    print_row(fmt::format("what a white {} reflects, true: 1", metallic == 1 ? "metal" : "dielectric"),
              fmt::format("roughness {}, cosine {}", roughness, cosine), "single scattering",
              number(sampled_albedo(lobe, cosine, kTries).mean()),
              number(sampled_albedo(make_compensated(lobe), cosine, kTries).mean()));
  }
  const Dielectric glass{1.5f, Rgb(1), {1}, false, Rgb(0.04f), 1};
  print_row("what clear rough glass reflects and transmits, true: 1", "index 1.5, roughness 1, cosine .5",
            "single scattering", number(sampled_albedo(glass, 0.5f, kTries).mean()),
            number(sampled_albedo(make_compensated(glass), 0.5f, kTries).mean()));
}

/// Rough interfaces whose index is nearly matched: the density of a ray that a facet refracts by the half
/// vector of the two rays, which is nearly a difference of opposites, over that by the facet itself.
void compare_matched_index() {
  TestRandom random(12);
  fmt::print("\n| index less 1 | mean off by | standard deviation | refused |\n|---|---|---|---|\n");
  for (const float delta : {1e-1f, 1e-2f, 1e-3f, 1e-4f, 1e-5f, 1e-6f}) {
    const float eta = 1 + delta, alpha = 0.1f;
    const Dielectric lobe{eta, Rgb(1), {alpha}, false, Rgb(0), 1};
    Statistics ratio;
    int lost = 0, count = 0;
    for (int i = 0; i < kTries / 10; ++i) {
      const Vec3f wo = at_cosine(0.3f + 0.7f * random.next1());
      const Vec2f u = random.next2();
      const Vec3f h = lobe.ggx.sample_visible_normal(wo, u);
      const auto wi = lobe.sample_transmitted(wo, u);
      if (!wi) continue;
      ++count;
      const auto t = lobe.eval_transmitted(wo, *wi);
      if (!(t.pdf > 0)) {
        ++lost;
        continue;
      }
      const double c = wo.dot(h), ct = double(textbook_refracted_cosine<Real>(c, eta));
      const double along = c - eta * ct;
      const double pdf =
          double(lobe.ggx.pdf_visible_normal(wo, h)) * double(eta) * eta * ct / (along * along);
      ratio.add(t.pdf / pdf);
    }
    fmt::print("| {} | {} | {} | {} |\n", number(delta), number(std::abs(ratio.mean() - 1)),
               number(std::sqrt(ratio.variance())), percent(double(lost) / count));
  }
}

}  // namespace

void compare_facets() {
  print_head("facets and lobes");
  compare_ggx();
  compare_smooth_facets();
  compare_grazing_facets();
  compare_facet_sampling();
  compare_phong();
  compare_sheen_base();
  compare_energy();
}

void compare_without_failure() {
  print_head("no failure");
  compare_sheen();
  compare_matched_index();
}

}  // namespace parian

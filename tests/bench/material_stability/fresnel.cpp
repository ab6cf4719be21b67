/// Fresnel and refraction.
#include "renderer/scene/fresnel.h"
#include "tests/bench/material_stability/report.h"
#include "tests/bench/material_stability/textbook.h"

namespace parian {
namespace {

void compare_dielectric() {
  TestRandom random(1);
  Largest near_one[2], critical[2], cosine[2];
  int below_one[2] = {0, 0}, total = 0;
  for (int i = 0; i < kTries; ++i) {
    float eta = 1 + (i % 2 ? 1.0f : -1.0f) * between(random, 1e-6, 1e-2);
    float c = i % 4 < 2 ? random.next1() : between(random, 1e-5, 1);
    Real truth = textbook_dielectric<Real>(c, eta);
    near_one[0].add(double(textbook_dielectric(c, eta) - truth));
    near_one[1].add(double(fresnel_dielectric(c, eta) - truth));

    eta = 1 / (1.05f + random.next1());
    c = float(std::sqrt(1 - Real(eta) * eta)) + (i % 2 ? 1.0f : -1.0f) * between(random, 1e-8, 1e-2);
    truth = textbook_dielectric<Real>(c, eta);
    const float naive = textbook_dielectric(c, eta), parian = fresnel_dielectric(c, eta);
    critical[0].add(double(naive - truth));
    critical[1].add(double(parian - truth));
    const Real t = textbook_refracted_cosine<Real>(c, eta);
    cosine[0].add(double(textbook_refracted_cosine(c, eta) - t));
    cosine[1].add(double(refracted_cosine(c, eta) - t));
    if (truth == 1) {
      ++total;
      below_one[0] += naive != 1;
      below_one[1] += parian != 1;
    }
  }
  const char* const form = "`sqrt(1 - (1 - c*c) / (eta*eta))`";
  print_row("Fresnel, dielectric", "index within 1e-6 to .01 of 1", form, near_one[0].text(),
            near_one[1].text());
  print_row("Fresnel, dielectric", "cosine within 1e-8 to .01 of the critical", form, critical[0].text(),
            critical[1].text());
  print_row("cosine of the refracted ray", "the same", form, cosine[0].text(), cosine[1].text());
  print_row("total reflections that are below 1", "the same", form, percent(double(below_one[0]) / total),
            percent(double(below_one[1]) / total));
}

void compare_conductor() {
  TestRandom random(2);
  Largest metal[2], faint[2];
  for (int i = 0; i < kTries; ++i) {
    const float c = i % 2 ? random.next1() : between(random, 1e-5, 1);
    float n = between(random, 0.03, 4), k = between(random, 1, 20);
    Real truth = textbook_conductor<Real>(c, n, k);
    metal[0].add(double(textbook_conductor(c, n, k) - truth));
    metal[1].add(double(fresnel_conductor(c, n, k) - truth));
    n = between(random, 1e-4, 0.9);
    k = between(random, 1e-6, 1e-2);
    truth = textbook_conductor<Real>(c, n, k);
    faint[0].add(double(textbook_conductor(c, n, k) - truth));
    faint[1].add(double(fresnel_conductor(c, n, k) - truth));
  }
  const char* const form = "`a = sqrt((m + t) / 2)`";
  print_row("Fresnel, conductor", "index .03 to 4, k 1 to 20", form, metal[0].text(), metal[1].text());
  print_row("Fresnel, conductor", "index 1e-4 to .9, k 1e-6 to .01", form, faint[0].text(), faint[1].text());
}

/// The direction of refraction with each thing that is easily wrong.
void compare_refraction() {
  TestRandom random(3);
  Largest length[4], snell[4];
  int wrong_side[4] = {0, 0, 0, 0}, refracted = 0;
  while (refracted < kTries) {
    const Vec3f h = random.direction();
    Vec3f wo = random.direction();
    if (wo.dot(h) < 0) wo = -wo;
    const float eta = refracted % 2 ? 1 + random.next1() : 1 / (1 + random.next1());
    const std::optional<Vec3f> parian = refract(wo, h, eta);
    if (!parian) continue;
    ++refracted;
    const float c = wo.dot(h), t = textbook_refracted_cosine(c, eta), mu = 1 / eta;
    const Vec3f d = -wo;
    const Vec3f forms[] = {d * mu + h * (mu * c + t), d * mu + h * (mu * c - t * t), d * mu + h * (c - t),
                           *parian};
    const double sine = Vec3d(wo).cross(Vec3d(h)).length();
    for (int k = 0; k < 4; ++k) {
      length[k].add(forms[k].length() - 1);
      snell[k].add(eta * Vec3d(forms[k]).cross(Vec3d(h)).length() - sine);
      wrong_side[k] += forms[k].dot(h) > 1e-6f;
    }
  }
  const char* const forms[] = {"`mu d + (mu c + c_t) h`", "`c_t` without its root", "`mu d + (c - c_t) h`"};
  const auto text = [&](int k) {
    return fmt::format("{}, {}, {}", length[k].text(), snell[k].text(),
                       percent(double(wrong_side[k]) / kTries));
  };
  for (int k = 0; k < 3; ++k)
    print_row("refracted ray: length, Snell's law, share on the wrong side", "any, index .5 to 2", forms[k],
              text(k), text(3));
}

void compare_schlick() {
  Largest naive, parian;
  for (float c = 0; c <= 1; c += 1e-4f) {
    const Real truth = textbook_dielectric<Real>(c, 1 / 1.5f);
    naive.add(double(0.04f + 0.96f * schlick_weight(c) - truth));
    parian.add(double(fresnel_dielectric(c, 1 / 1.5f) - truth));
  }
  print_row("Fresnel, from inside", "index 1.5", "Schlick at the angle inside", naive.text(), parian.text());
}

}  // namespace

void compare_fresnel() {
  print_head("Fresnel and refraction, largest error");
  compare_dielectric();
  compare_conductor();
  compare_schlick();
  compare_refraction();
}

}  // namespace parian

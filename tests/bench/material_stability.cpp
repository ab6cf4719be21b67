/// Where materials and light transport go wrong: the formula as textbooks have it in single precision (or the
/// step that is easily left out), and what Parian gives, each against long double or a closed form. Prints
/// the tables of docs/stability.md.
///
/// usage: material_stability
#include <fmt/format.h>

#include <functional>
#include <string>
#include <vector>

#include "integrators/boundary.h"
#include "materials/bsdf.h"
#include "renderer/base/distribution.h"
#include "renderer/light/light_table.h"
#include "renderer/shapes/sphere.h"
#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"
#include "tests/materials/support/lobes.h"

namespace {

using namespace parian;

using Real = long double;
constexpr int kTries = 1000000;

// The textbook's formulas: in float what is tried, in long double the reference.

template <class T>
constexpr T pi = std::numbers::pi_v<T>;

template <class T>
T textbook_refracted_cosine(T c, T eta) {
  const T sine2 = (1 - c * c) / (eta * eta);
  return sine2 < 1 ? std::sqrt(1 - sine2) : 0;
}

template <class T>
T textbook_dielectric(T c, T eta) {
  const T t = textbook_refracted_cosine(c, eta);
  if (t == 0) return 1;
  const T s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
  return (s * s + p * p) / 2;
}

template <class T>
T textbook_conductor(T c, T n, T k) {
  const T s2 = 1 - c * c, t = n * n - k * k - s2, modulus = std::sqrt(t * t + 4 * n * n * k * k);
  const T a2 = (modulus + t) / 2, ac = 2 * std::sqrt(a2) * c;
  const T s = (modulus - ac + c * c) / (modulus + ac + c * c);
  const T p = s * (c * c * modulus - ac * s2 + s2 * s2) / (c * c * modulus + ac * s2 + s2 * s2);
  return (s + p) / 2;
}

template <class T>
T textbook_ggx(T c, T alpha) {
  const T a2 = alpha * alpha, t = c * c * (a2 - 1) + 1;
  return a2 / (pi<T> * t * t);
}

/// With the tangent, from 1 - cos^2.
template <class T>
T textbook_ggx_tan(T c, T alpha) {
  const T a2 = alpha * alpha, c2 = c * c, t = a2 + (1 - c2) / c2;
  return a2 / (pi<T> * c2 * c2 * t * t);
}

template <class T>
T textbook_sheen(T c, T alpha) {
  return (2 + 1 / alpha) * std::pow(1 - c * c, 1 / (2 * alpha)) / (2 * pi<T>);
}

/// Per solid angle, of directions to a sphere.
template <class T>
T textbook_cone_pdf(T radius, T distance) {
  const T ratio = radius / distance;
  return 1 / (2 * pi<T> * (1 - std::sqrt(1 - ratio * ratio)));
}

template <class T>
T textbook_power_heuristic(T a, T b) {
  return a * a / (a * a + b * b);
}

/// Beer and Lambert: what a medium leaves that has the colour after a distance of 1.
template <class T>
T textbook_transmittance(T color, T distance) {
  const T sigma = -std::log(color);
  return std::exp(-sigma * distance);
}

// What is printed.

/// In three digits: 3e-8, 0.031, 12.
std::string number(double x) {
  if (x == 0 || (std::abs(x) >= 1e-2 && std::abs(x) < 1000)) return fmt::format("{:.3g}", x);
  const std::string s = fmt::format("{:.1e}", x);
  const std::size_t e = s.find('e'), digits = s.compare(e - 2, 2, ".0") == 0 ? e - 2 : e;
  return fmt::format("{}e{}", s.substr(0, digits), std::stoi(s.substr(e + 1)));
}

/// The largest of many numbers, and how many were none.
class Largest {
 public:
  void add(double x) {
    ++count_;
    if (std::isfinite(x))
      largest_ = std::max(largest_, std::abs(x));
    else
      ++broken_;
  }
  std::string text() const {
    if (broken_ == count_) return "not finite";
    std::string s = number(largest_);
    if (broken_ > 0) s += fmt::format("; {}% not finite", number(100.0 * broken_ / count_));
    return s;
  }

 private:
  double largest_ = 0;
  int count_ = 0, broken_ = 0;
};

void print_head(const char* measure) {
  fmt::print("\n| {} | where | naive form | naive | Parian |\n|---|---|---|---|---|\n", measure);
}

void print_row(const std::string& what, const std::string& where, const std::string& form,
               const std::string& naive, const std::string& parian) {
  fmt::print("| {} | {} | {} | {} | {} |\n", what, where, form, naive, parian);
}

std::string percent(double share) { return number(100 * share) + "%"; }

/// Evenly in the logarithm.
float between(TestRandom& random, double low, double high) {
  return float(low * std::pow(high / low, double(random.next1())));
}

// Fresnel and refraction.

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

// Facets.

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

// Sampling and weights.

void compare_weights() {
  TestRandom random(9);
  Largest naive, parian;
  for (int i = 0; i < kTries; ++i) {
    const float a = between(random, 1e-30, 1e30), b = a * between(random, 1e-4, 1e4);
    const Real truth = textbook_power_heuristic<Real>(a, b);
    naive.add(double(textbook_power_heuristic(a, b) - truth));
    parian.add(double(power_heuristic(a, b) - truth));
  }
  print_row("power heuristic", "densities 1e-30 to 1e30", "`a*a / (a*a + b*b)`", naive.text(), parian.text());
}

void compare_numbers() {
  int ones[2] = {0, 0};
  constexpr int kLast = 1000;
  for (std::uint32_t i = 0; i < kLast; ++i) {
    const std::uint32_t x = 0xffffffffu - i;
    ones[0] += float(x) * 0x1p-32f >= 1;
    ones[1] += to_unit_float(x) >= 1;
  }
  print_row("random numbers in [0, 1) that are 1", "of 2^32", "`x * 2^-32`", fmt::format("{}", ones[0]),
            fmt::format("{}", ones[1]));
}

void compare_cosine_hemisphere() {
  TestRandom random(10);
  Largest naive, parian;
  for (int i = 0; i < kTries; ++i) {
    const float u = 1 - float(1 + i % 1000) * 0x1p-24f, v = random.next1();
    const double truth = std::sqrt(1 - double(u));
    const Vec2f p = unit_circle(v) * std::sqrt(u);
    naive.add(std::sqrt(1 - p.x * p.x - p.y * p.y) / truth - 1);
    parian.add(sample_cosine_hemisphere({u, v}).z / truth - 1);
  }
  print_row("cosine of a cosine-distributed direction, relative", "the last 1000 numbers below 1",
            "`sqrt(1 - x*x - y*y)`", naive.text(), parian.text());
}

void compare_sphere_light() {
  for (const float distance : {0.5f, 1e2f, 1e3f, 1e4f}) {
    Largest naive, parian;
    const Real ratio = 1 / Real(distance), sine2 = ratio * ratio;
    const Real truth =
        distance < 1 ? 1 / (4 * pi<Real>) : (1 + std::sqrt(1 - sine2)) / (2 * pi<Real> * sine2);
    naive.add(double(textbook_cone_pdf(1.0f, distance) / truth - 1));
    parian.add(double(pdf_directions({0, 0, 0}, 1, {0, 0, distance}) / truth - 1));
    print_row("density of directions to a sphere, relative",
              fmt::format("{} radii from its centre", number(distance)), "`1 - sqrt(1 - sq(R / d))`",
              naive.text(), parian.text());
  }
}

/// A ball of triangles with those at the poles that have no area, as a light.
void compare_degenerate_lights() {
  constexpr int kRings = 8;
  Primitive ball = make_uv_sphere({0, 0, 0}, 1, kRings);
  std::vector<Triangle> triangles(ball.triangles.begin(), ball.triangles.end());
  for (std::uint32_t i = 0; i < 2 * kRings; ++i) {
    const std::uint32_t bottom = kRings * (2 * kRings + 1) + i;
    triangles.push_back({i, i + 1, i});
    triangles.push_back({i, i + 1, i + 2 * kRings + 2});
    triangles.push_back({bottom - 2 * kRings - 1, bottom + 1, bottom});
  }
  ball.triangles = triangles;

  const Vec3f p(3, 2, 1);
  TestRandom random(11);
  int broken[2] = {0, 0};
  for (int i = 0; i < kTries; ++i) {
    const Triangle& t = triangles[std::size_t(random.next1() * float(triangles.size()))];
    const Vec2f b = sample_triangle(random.next2());
    const Vec3f a = ball.positions[t[0]], e1 = ball.positions[t[1]] - a, e2 = ball.positions[t[2]] - a;
    const Vec3f cross = e1.cross(e2), to_light = a + e1 * b.x + e2 * b.y - p;
    const float cosine = std::abs(normalize(to_light).dot(normalize(cross)));
    broken[0] += !std::isfinite(to_light.length2() / (0.5f * cross.length() * cosine));
  }
  Scene scene;
  Material emitter = make_emitter(Rgb(1));
  emitter.double_sided = true;
  add_mesh(scene, std::move(ball), add_material(scene, emitter));
  const World world = make_world(scene);
  const LightTable lights(scene, world);
  for (int i = 0; i < kTries; ++i) {
    Sampler sampler(SamplerKind::independent, 1, 0, 0, std::uint32_t(i));
    const Vec2f u = sampler.next2();
    const auto s = lights.sample({p, {0, 0, 0}}, u, sampler);
    broken[1] += s && !(is_finite(s->wi) && std::isfinite(s->pdf) && s->pdf > 0);
  }
  print_row("light samples that are not finite", "a ball with the triangles at its poles",
            "`d*d / (area * cos)`, any triangle", percent(double(broken[0]) / kTries),
            percent(double(broken[1]) / kTries));
}

void compare_sums() {
  const std::vector<float> texels(std::size_t(1) << 24, 0.1f);
  float sum = 0;
  for (const float x : texels) sum += x;
  const double truth = double(0.1f) * double(texels.size());
  print_row("power of an environment, relative", "2^24 texels of .1", "summed in float",
            number(sum / truth - 1), number(Distribution1D(texels).total() / truth - 1));
}

// Media.

void compare_transmittance() {
  Largest coloured[2], black[2];
  for (const float color : {0.0f, 1e-30f, 1e-3f, 0.5f, 1.0f})
    for (const float distance : {0.0f, 1e-6f, 1e-3f, 1.0f, 1e6f, kInfinity}) {
      const Real truth = color == 1 || distance == 0 ? 1
                         : color == 0 || distance == kInfinity
                             ? 0
                             : std::exp(std::log(Real(color)) * Real(distance));
      Material m = make_lambert(Rgb(0));
      m.volume.emplace();
      m.volume->thickness = m.volume->attenuation_distance = 1;
      m.volume->attenuation_color = Rgb(color);
      const Medium medium = make_medium(m);
      Largest* const largest = color == 0 ? black : coloured;
      largest[0].add(double(textbook_transmittance(color, distance) - truth));
      largest[1].add(double(transmittance(&medium, distance).x - truth));
    }
  const char* const form = "`exp(log(color) * d)`";
  print_row("transmittance", "colours 1e-30 to 1, distances 0 to infinity", form, coloured[0].text(),
            coloured[1].text());
  print_row("transmittance", "colour 0", form, black[0].text(), black[1].text());
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

// Pictures.

Material make_glass(float ior, int priority = 0) {
  Material m;
  m.metallic = m.roughness = 0;
  m.ior = ior;
  m.priority = priority;
  m.transmission.emplace();
  m.transmission->factor = 1;
  m.volume.emplace();
  m.volume->thickness = 1;
  return m;
}

std::string probe(const Scene& scene, std::uint32_t seed, std::uint32_t spp, int max_depth = 100) {
  const Mean mean =
      mean_of(render(scene, independent_settings(16, 16, spp, seed), with(Strategy::bsdf, max_depth)), 0);
  return fmt::format("{:.5f} +- {:.0e}", mean.value, mean.error);
}

double reflectance(double n1, double n2) { return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2)); }

void compare_radiance_scaling() {
  Scene emitter;
  add_shape(emitter, make_sphere(2), add_material(emitter, make_glass(1.5f)));
  add_shape(emitter, make_sphere(1), add_material(emitter, make_emitter(Rgb(1))));
  add_probe(emitter, {0, 0, 0}, {0, 0, 1}, 5, 1e-3f);
  const double t = 1 - reflectance(1, 1.5);
  print_row(fmt::format("radiance of an emitter in glass, true: {:.5f}", t / 2.25), "index 1.5, head on",
            "`1 - F` at the interface", fmt::format("{:.5f}", t), probe(emitter, 1, 2048));
  Scene camera;
  add_mesh(camera, make_box({-40, -5, -40}, {40, 5, 40}), add_material(camera, make_glass(1.5f)));
  camera.environment.radiance = Rgb(1, 1, 1);
  add_probe(camera, {0, 0, 0}, {0, -1, 0}, 1, 1e-3f);
  print_row(fmt::format("a sky of 1 from inside glass, true: {:.5f}", t * 2.25), "index 1.5, head on",
            "`1 - F` at the interface", fmt::format("{:.5f}", t), probe(camera, 2, 8192, 1));
}

/// Glass on water that emits at its bottom; `gap` of air between.
Scene glass_on_water(float gap) {
  Scene scene;
  add_mesh(scene, make_box({-40, 0, -40}, {40, 1, 40}), add_material(scene, make_glass(1.5f, 1)));
  add_mesh(scene, make_box({-40, -1, -40}, {40, -gap, 40}), add_material(scene, make_glass(1.33f)));
  add_mesh(scene, make_quad({0, -0.5f, 0}, {30, 0, 0}, {0, 0, -30}),
           add_material(scene, make_emitter({1, 1, 1})));
  add_probe(scene, {0, 1, 0}, {0, 1, 0}, 3, 1e-3f);
  return scene;
}

void compare_contact() {
  const double r1 = reflectance(1, 1.5), r2 = reflectance(1.5, 1.33);
  const double truth = (1 - r1) * (1 - r2) / (1 - r1 * r2) / (1.33 * 1.33);
  print_row(fmt::format("radiance of an emitter in water under glass, true: {:.5f}", truth),
            "the two in one place", "one boundary after the other (a gap of .01)",
            probe(glass_on_water(0.01f), 3, 2048), probe(glass_on_water(0), 4, 2048));
}

void compare_roulette() {
  // Weights of survivors that do not make up for the others: the n-th bounce counts with rho^n times the
  // probability of getting there.
  double naive = 0, reached = 1;
  for (int n = 0; n < 100; ++n) {
    naive += std::pow(0.9, n) * reached;
    reached *= std::pow(0.9, n + 1);
  }
  Scene scene;
  Material wall = make_lambert(Rgb(0.9f));
  wall.emission = Rgb(1);
  add_mesh(scene, make_box({-1, -1, -1}, {1, 1, 1}, false), add_material(scene, wall));
  add_eye(scene, {0.1f, 0.2f, 0.3f}, {1, 0.3f, 0.2f}, 1);
  print_row("radiance in a furnace of albedo .9, true: 10", "roulette by weight",
            "survivors' weights not divided", number(naive), probe(scene, 5, 4096, 1000));
}

struct Terminator {
  double deviation = 0, black = 0;
  std::string text() const { return fmt::format("{:.1f}%, {:.1f}%", 100 * deviation, 100 * black); }
};

/// A ball lit from the side: the pixels of a mesh of it against those of the ball itself.
Terminator compare_pixels(const std::function<double(int, int)>& mesh, const Picture& ball) {
  Terminator t;
  double sum = 0;
  for (int y = 0; y < ball.height; ++y)
    for (int x = 0; x < ball.width; ++x) {
      const double truth = ball.at(x, y)[0], value = mesh(x, y);
      sum += truth;
      t.deviation += std::abs(value - truth);
      t.black += (truth > 0.1 && value < 0.01) / double(ball.width * ball.height);
    }
  t.deviation /= sum;
  return t;
}

void compare_terminator() {
  const Vec3f sun_direction = normalize(Vec3f(-1, -0.2f, -0.1f));
  constexpr int kSize = 96, kSpp = 16;
  constexpr float kHalf = 0.6f;
  for (const int rings : {6, 12}) {
    const auto make_scene = [&](bool mesh) {
      Scene scene;
      const int white = add_material(scene, make_lambert({1, 1, 1}));
      if (mesh)
        add_mesh(scene, make_uv_sphere({0, 0, 0}, 1, rings), white);
      else
        add_shape(scene, make_sphere(1), white);
      Light sun;
      sun.kind = LightKind::directional;
      sun.intensity = kPi;
      add_light(scene, sun, look_along({0, 0, 0}, sun_direction));
      add_probe(scene, {0, 0, 0}, {0, 0, 1}, 3, kHalf);
      return scene;
    };
    const auto settings = independent_settings(kSize, kSize, kSpp);
    const Scene scene = make_scene(true);
    const Picture ball = render(make_scene(false), settings, with(Strategy::mis, 1)),
                  mesh = render(scene, settings, with(Strategy::mis, 1));
    // Lit where both normals say so: the ball is convex, nothing else is in the way.
    const World world = make_world(scene);
    const Accel accel(scene, world, AccelSettings{});
    TestRandom random(13);
    const auto naive = [&](int x, int y) {
      double value = 0;
      for (int i = 0; i < kSpp; ++i) {
        const Vec2f p = (Vec2f(float(x), float(y)) + random.next2()) * (2 * kHalf / kSize);
        const Ray ray{{p.x - kHalf, kHalf - p.y, 3}, {0, 0, -1}};
        Hit hit;
        if (!accel.intersect(ray, 0, hit)) continue;
        const Surface s = make_surface(scene, world, hit, ray.d);
        if (s.ng.dot(sun_direction) < 0) value -= std::min(0.0f, s.frame.z.dot(sun_direction)) / kSpp;
      }
      return value;
    };
    print_row("deviation from a ball, share that is black and should not be",
              fmt::format("{} rings of quads, lit from the side", rings), "shadow rays from the triangles",
              compare_pixels(naive, ball).text(),
              compare_pixels([&](int x, int y) { return mesh.at(x, y)[0]; }, ball).text());
  }
}

}  // namespace

int main() {
  print_head("Fresnel and refraction, largest error");
  compare_dielectric();
  compare_conductor();
  compare_schlick();
  compare_refraction();
  print_head("facets and lobes");
  compare_ggx();
  compare_smooth_facets();
  compare_grazing_facets();
  compare_facet_sampling();
  compare_phong();
  compare_sheen_base();
  compare_energy();
  print_head("samples and weights");
  compare_weights();
  compare_numbers();
  compare_cosine_hemisphere();
  compare_sphere_light();
  compare_degenerate_lights();
  compare_sums();
  print_head("media and pictures");
  compare_transmittance();
  compare_radiance_scaling();
  compare_contact();
  compare_roulette();
  compare_terminator();
  print_head("no failure");
  compare_sheen();
  compare_matched_index();
  return 0;
}

#include "renderer/scene/fresnel.h"

#include <gtest/gtest.h>

#include <complex>
#include <vector>

#include "tests/support/statistics.h"

namespace parian {
namespace {

float cos_degrees(double degrees) { return float(std::cos(degrees * std::numbers::pi / 180)); }

/// Born and Wolf 1.5.2, as the textbook has it, with the refracted angle.
long double dielectric(long double c, long double eta) {
  const long double sine2 = (1 - c) * (1 + c) / (eta * eta);
  if (sine2 >= 1) return 1;
  const long double t = std::sqrt(1 - sine2);
  const long double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
  return (s * s + p * p) / 2;
}

/// By the complex refracted cosine: another route than the tested one's.
long double conductor(long double c, long double eta, long double k) {
  using Complex = std::complex<long double>;
  const Complex n(eta, k), q = std::sqrt((n - 1.0L) * (n + 1.0L) + c * c);
  const Complex s = (c - q) / (c + q), p = (n * n * c - q) / (n * n * c + q);
  return (std::norm(s) + std::norm(p)) / 2;
}

/// Cosines in [0, 1], dense at both ends, and close to the critical angle of eta < 1.
std::vector<float> sweep(float eta) {
  std::vector<float> cosines{0, 1};
  for (int i = 0; i <= 2000; ++i) cosines.push_back(float(i) / 2000);
  for (float x = 0.5f; x > 1e-30f; x *= 0.7f) {
    cosines.push_back(x);
    cosines.push_back(1 - x);
  }
  if (eta < 1) {
    const float critical = float(std::sqrt((1.0L - eta) * (1.0L + eta)));
    float above = critical, below = critical;
    for (int i = 0; i < 200; ++i) {
      cosines.push_back(above = std::nextafter(above, 2.0f));
      cosines.push_back(below = std::nextafter(below, -1.0f));
    }
    for (float x = 1e-6f; x < 0.1f; x *= 1.3f) {
      cosines.push_back(critical + x);
      cosines.push_back(critical - x);
    }
  }
  std::erase_if(cosines, [](float c) { return c < 0 || c > 1; });
  return cosines;
}

// Catches Schlick in place of Fresnel (.070 at 60 degrees), and the index turned upside down.
TEST(Fresnel, DielectricTable) {
  const struct {
    float eta;
    double degrees, truth;
  } cases[] = {{1.5f, 0, .04},      {1.5f, 45, .050240},     {1.5f, 60, .089187}, {1.5f, 75, .253061},
               {1.5f, 85, .612800}, {1 / 1.5f, 40, .245291}, {1.3f, 0, .017013},  {1.3f, 60, .053400}};
  for (const auto& c : cases)
    EXPECT_NEAR(fresnel_dielectric(cos_degrees(c.degrees), c.eta), c.truth, 1e-6)
        << c.eta << " " << c.degrees;
  for (const auto& [eta, critical] : {std::pair(1 / 1.5f, 41.8103), {1 / 1.3f, 50.2849}}) {
    EXPECT_LT(fresnel_dielectric(cos_degrees(critical - 0.001), eta), 1);
    for (const double degrees : {critical + 0.001, 60.0, 89.0, 90.0})
      EXPECT_EQ(fresnel_dielectric(cos_degrees(degrees), eta), 1) << degrees;
    EXPECT_GT(refracted_cosine(cos_degrees(critical - 0.001), eta), 0);
    EXPECT_EQ(refracted_cosine(cos_degrees(critical + 0.001), eta), 0);
  }
}

// Within 1e-6 at all cosines that there are. Catches differences that cancel (eta near 1, up to 1e-3 near the
// critical angle with a root taken in single precision).
TEST(Fresnel, DielectricIsExactEverywhere) {
  for (const float eta :
       {0.3f,    0.5f,  1 / 1.5f, 0.75f, 1 / 1.3f, 0.9f, 0.99f, 0.9999f, 0.999999f, 1.000001f,
        1.0001f, 1.01f, 1.1f,     1.3f,  1.33f,    1.5f, 1.8f,  2.4f,    4.0f,      20.0f})
    for (const float c : sweep(eta)) {
      const float f = fresnel_dielectric(c, eta);
      ASSERT_NEAR(f, double(dielectric(c, eta)), 1e-6) << eta << " at " << c;
      ASSERT_TRUE(f >= 0 && f <= 1);
      const long double t2 = 1 - (1 - (long double)c) * (1 + (long double)c) / ((long double)eta * eta);
      ASSERT_NEAR(refracted_cosine(c, eta), double(std::sqrt(std::max(0.0L, t2))), 1e-6)
          << eta << " at " << c;
    }
}

TEST(Fresnel, WithoutAnInterfaceNothingIsReflected) {
  for (const float c : sweep(1)) {
    ASSERT_EQ(fresnel_dielectric(c, 1), 0) << c;
    ASSERT_NEAR(refracted_cosine(c, 1), c, 1e-7f * c + 1e-19f);
    ASSERT_NEAR(fresnel_conductor(c, 1, 0), 0, 1e-6) << c;
  }
}

// F of the way in is that of the way out (Stokes). Catches one side only being right.
TEST(Fresnel, DielectricIsTheSameFromBothSides) {
  for (const float eta : {1.1f, 1.5f, 2.4f})
    for (int i = 1; i <= 100; ++i) {
      const float c = float(i) / 100;
      // The cosine inside, rounded, is what limits this: close to the critical angle F depends on its root.
      EXPECT_NEAR(fresnel_dielectric(c, eta), fresnel_dielectric(refracted_cosine(c, eta), 1 / eta),
                  3e-6 / (c * c));
    }
}

// Catches the mean of the squares (gold's blue .67), and a's cancellation.
TEST(Fresnel, ConductorTable) {
  const struct {
    float eta, k;
    double at_0, at_60, at_80, at_85;
  } cases[] = {{.143f, 3.983f, .966688, .962220, .963216, .976093},
               {.422f, 2.347f, .775845, .780016, .860803, .919913},
               {.965f, 6.40f, .913880, .898845, .860724, .881298},
               {1, 1, .2, .307565, .618795, .778650}};
  for (const auto& c : cases) {
    EXPECT_NEAR(fresnel_conductor(1, c.eta, c.k), c.at_0, 1e-6) << c.eta;
    EXPECT_NEAR(fresnel_conductor(cos_degrees(60), c.eta, c.k), c.at_60, 1e-6) << c.eta;
    EXPECT_NEAR(fresnel_conductor(cos_degrees(80), c.eta, c.k), c.at_80, 1e-6) << c.eta;
    EXPECT_NEAR(fresnel_conductor(cos_degrees(85), c.eta, c.k), c.at_85, 1e-6) << c.eta;
  }
  const Rgb f = fresnel_conductor(1, Rgb(.143f, .422f, 1), Rgb(3.983f, 2.347f, 1));
  EXPECT_NEAR(f.x, .966688, 1e-6);
  EXPECT_NEAR(f.y, .775845, 1e-6);
  EXPECT_NEAR(f.z, .2, 1e-6);
}

TEST(Fresnel, ConductorIsExactEverywhere) {
  for (const float eta : {0.0f, 1e-4f, 0.05f, 0.143f, 0.5f, 0.9f, 1.0f, 1.5f, 3.0f, 10.0f})
    for (const float k : {0.0f, 1e-6f, 1e-3f, 0.1f, 1.0f, 2.347f, 6.4f, 20.0f})
      for (const float c : sweep(eta)) {
        if (k == 0 && c * c == 1 - eta * eta) continue;  // the reference is 0 / 0
        const float f = fresnel_conductor(c, eta, k);
        ASSERT_NEAR(f, double(conductor(c, eta, k)), 1e-6) << eta << " + i" << k << " at " << c;
        ASSERT_TRUE(f >= 0 && f <= 1);
      }
}

TEST(Fresnel, ConductorWithoutAbsorptionIsADielectric) {
  for (const float eta : {0.5f, 0.75f, 1.3f, 1.5f})
    for (const float c : sweep(eta)) {
      ASSERT_NEAR(fresnel_conductor(c, eta, 0), fresnel_dielectric(c, eta), 2e-6) << eta << " at " << c;
      if (refracted_cosine2_times_eta2(c, eta) < 0) {
        ASSERT_EQ(fresnel_conductor(c, eta, 0), 1) << eta << " at " << c;
      }
    }
  EXPECT_EQ(fresnel_conductor(0.5f, 0, 3), 1) << "a perfect conductor";
}

// No NaN for what a file may hold.
TEST(Fresnel, ConductorIsFiniteForAnyIndex) {
  for (const float eta : {0.0f, 1e-20f, 1.0f, 1e4f})
    for (const float k : {0.0f, 1e-30f, 1e-20f, 1.0f, 1e4f})
      for (const float c : {0.0f, 1e-30f, 1e-10f, 1e-4f, 0.5f, 1.0f}) {
        const float f = fresnel_conductor(c, eta, k);
        EXPECT_TRUE(f >= 0 && f <= 1) << eta << " + i" << k << " at " << c << ": " << f;
      }
}

/// The integral of F mu^k by the midpoint rule, in a variable in which the root at the critical angle is
/// smooth.
double moment(double eta, int k) {
  const double critical = std::sqrt(std::max(0.0, 1 - eta * eta));
  constexpr int kSteps = 100000;
  double sum = std::pow(critical, k + 1) / (k + 1);  // all is reflected there
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps, mu = critical + (1 - critical) * u * u;
    sum += double(dielectric(mu, eta)) * std::pow(mu, k) * 2 * u * (1 - critical) / kSteps;
  }
  return sum;
}

TEST(Fresnel, MomentsAreTheIntegrals) {
  for (const double eta : {0.5, 1 / 1.5, 1 / 1.3, 0.99, 1.01, 1.3, 1.5, 2.0})
    for (const int k : {0, 1, 2, 3}) EXPECT_NEAR(fresnel_moment(eta, k), moment(eta, k), 1e-9) << eta << k;
  for (const int k : {0, 1, 2}) EXPECT_EQ(fresnel_moment(1, k), 0);
}

// Of diffuse light, from inside and from outside. Catches a moment without its cosine, or that of the other
// side.
TEST(Fresnel, DiffuseReflectance) {
  for (const auto& [eta, inside, outside] :
       {std::tuple(1.3, .444457, .061132), {1.5, .596346, .091778}, {2.0, .790149, .160597}}) {
    EXPECT_NEAR(2 * fresnel_moment(1 / eta, 1), inside, 1e-6);
    EXPECT_NEAR(2 * fresnel_moment(eta, 1), outside, 1e-6);
    // What is in equilibrium on both sides.
    EXPECT_NEAR(1 - 2 * fresnel_moment(1 / eta, 1), (1 - 2 * fresnel_moment(eta, 1)) / (eta * eta), 1e-12);
  }
}

TEST(Fresnel, ExactDielectricIsTheOtherInDoublePrecision) {
  for (const double eta : {0.5, 1 / 1.3, 1.0, 1.0001, 1.5})
    for (const double c : {1.0, 0.9, 0.64, 0.5, 0.1, 1e-4})
      EXPECT_NEAR(fresnel_dielectric_exact(c, eta), double(dielectric(c, eta)), 1e-12) << eta << " at " << c;
}

// "+ refracted cosine" leaves on the wrong side; a lost square root or 1 / eta break the length.
TEST(Fresnel, RefractsBySnell) {
  TestRandom random(1);
  int refracted = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f h = random.direction();
    Vec3f wo = random.direction();
    if (wo.dot(h) < 0) wo = -wo;
    const float eta = i % 2 ? 1 + random.next1() : 1 / (1 + random.next1());
    const std::optional<Vec3f> t = refract(wo, h, eta);
    const double sine = Vec3d(wo).cross(Vec3d(h)).length();
    if (std::abs(sine - eta) > 1e-6) {
      ASSERT_EQ(t.has_value(), sine < eta) << sine << " " << eta;
    }
    if (!t) continue;
    ++refracted;
    ASSERT_NEAR(t->length(), 1, 2e-6);
    ASSERT_NEAR(eta * Vec3d(*t).cross(Vec3d(h)).length(), sine, 2e-6);
    ASSERT_LT(t->dot(h), 1e-6);
    ASSERT_NEAR(-t->dot(h), refracted_cosine(wo.dot(h), eta), 1e-6);
    // In the plane of wo and h, away from wo.
    ASSERT_NEAR(Vec3d(*t).dot(Vec3d(wo).cross(Vec3d(h))), 0, 1e-6);
    const Vec3f along = wo - h * wo.dot(h);
    ASSERT_LE(t->dot(along), 1e-6);
  }
  EXPECT_GT(refracted, 60000);
  const Vec3f n(0, 0, 1), wo(0.6f, 0, 0.8f);
  EXPECT_NEAR((*refract(wo, n, 1) + wo).length(), 0, 1e-6) << "straight on";
  EXPECT_NEAR(refract(wo, n, 1.5f)->x, -0.4, 1e-6);
  EXPECT_FALSE(refract(wo, n, 0.5f));
}

TEST(Fresnel, SchlickWeight) {
  EXPECT_EQ(schlick_weight(1), 0);
  EXPECT_EQ(schlick_weight(0), 1);
  EXPECT_EQ(schlick_weight(0.5f), 1.0f / 32);
  EXPECT_EQ(schlick_weight(1.00001f), 0);
}

}  // namespace
}  // namespace parian

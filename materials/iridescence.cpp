#include "materials/iridescence.h"

#include "renderer/scene/fresnel.h"

namespace parian {
namespace {

float square(float x) { return x * x; }

float schlick(float f0, float cosine) { return f0 + (1 - f0) * schlick_weight(cosine); }

/// One Gaussian of the fit to a colour matching function over the wave number (Belcour and Barla 2017,
/// section 4), and its Fourier transform, a damped cosine.
struct Gaussian {
  float value, mean, variance;  // mean in waves per metre

  /// `waves` is 2 pi times a path difference in metres.
  float transform(float waves) const {
    constexpr float kArea = 1.0685e-7f;  // of the matching functions
    return value / kArea * std::sqrt(2 * kPi * variance) * std::cos(mean * waves) *
           std::exp(-variance * square(waves));
  }
};

constexpr Gaussian kX0{5.4856e-13f, 1.6810e+06f, 4.3278e+09f}, kX1{9.7470e-14f, 2.2399e+06f, 4.5282e+09f},
    kY{4.4201e-13f, 1.7953e+06f, 9.3046e+09f}, kZ{5.2481e-13f, 2.2084e+06f, 6.6121e+09f};

/// The mean of cos(2 pi path / wavelength) over the spectrum as each channel sees it, path in nanometres. As
/// in the extension it is not scaled to white: (1.2, 0.95, 0.91) at path 0.
Rgb mean_cosine(float path) {
  const float waves = 2 * kPi * 1e-9f * path;
  const float x = kX0.transform(waves) + kX1.transform(waves), y = kY.transform(waves),
              z = kZ.transform(waves);
  return {3.2404542f * x - 1.5371385f * y - 0.4985314f * z, -0.9692660f * x + 1.8760108f * y + 0.0415560f * z,
          0.0556434f * x - 0.2040259f * y + 1.0572252f * z};
}

/// The extension's implementation notes, "Iridescence Fresnel".
Rgb film_reflectance(float cosine, float film_ior, float thickness_nm, const Rgb& base_f0) {
  const float inside = refracted_cosine(cosine, film_ior);
  const float r12 = schlick(square((film_ior - 1) / (film_ior + 1)), cosine), t121 = 1 - r12;
  const float path = 2 * film_ior * thickness_nm * inside;
  const Rgb cosine1 = mean_cosine(path), cosine2 = mean_cosine(2 * path);
  Rgb sum;
  for (int i = 0; i < 3; ++i) {
    // An f0 of 1 would be an infinite index.
    const float root = std::sqrt(std::min(base_f0[i], 0.9999f)), base_ior = (1 + root) / (1 - root);
    const float r23 = schlick(square((base_ior - film_ior) / (base_ior + film_ior)), inside);
    const float r123 = std::clamp(r12 * r23, 1e-5f, 0.9999f), rs = square(t121) * r23 / (1 - r123);
    // Each turn within the film shifts the wave by half a turn at the face to air, and by another where the
    // base is the rarer. So the shift is a sign. It is the channel's: the extension's code shifts X, Y and Z
    // by what belongs to red, green and blue, and is up to 0.4 off where these differ.
    const float per_turn = base_ior < film_ior ? std::sqrt(r123) : -std::sqrt(r123);
    sum[i] = r12 + rs + 2 * (rs - t121) * per_turn * (cosine1[i] + per_turn * cosine2[i]);
  }
  return sum;
}

}  // namespace

Rgb iridescent_reflectance(float cosine, float film_ior, float thickness_nm, const Rgb& base_f0) {
  Rgb result = base_f0 + (Rgb(1, 1, 1) - base_f0) * schlick_weight(cosine);
  // Khronos' renderer lets the film's index go to that of air over the same range instead, but Schlick's
  // reflectance of its face does not go to 0 with it: at 60 degrees a base of 0.07 would have 0.18.
  const float u = std::clamp(thickness_nm / 0.03f, 0.0f, 1.0f), presence = u * u * (3 - 2 * u);
  if (presence > 0) result += (film_reflectance(cosine, film_ior, thickness_nm, base_f0) - result) * presence;
  for (int i = 0; i < 3; ++i) result[i] = std::clamp(result[i], 0.0f, 1.0f);
  return result;
}

}  // namespace parian

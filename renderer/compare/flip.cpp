#include "renderer/compare/flip.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "renderer/base/parallel.h"
#include "renderer/compare/flip_color.h"
#include "renderer/compare/flip_kernels.h"

namespace parian {
namespace {

// Constants of the 2020 paper: the exponents of colour and feature differences, and the knee by which color
// differences above 40% of the largest one share the last 5% of the range.
constexpr float kColorExponent = 0.7f, kFeatureExponent = 0.5f, kKnee = 0.4f, kKneeValue = 0.95f;

// The ACES curve x (a x + b) / (x (c x + d) + e) of 0.6 times the radiance.
constexpr float kAcesScale = 0.6f, kA = 2.51f, kB = 0.03f, kC = 2.43f, kD = 0.59f, kE = 0.14f;

using PixelFunction = std::function<void(std::size_t)>;

void for_each_pixel(const Plane& plane, const PixelFunction& body) {
  const auto width = std::size_t(plane.width);
  parallel_for(std::size_t(plane.height), 8, [&](std::size_t y) {
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) body(i);
  });
}

// What is seen of one picture: its filtered colours in L*a*b*, Hunt adjusted, and how strong its edges and
// points are.
struct Appearance {
  Plane l, a, b, edge, point;
};

Plane filter(const Plane& plane, const Kernel& along_rows, const Kernel& along_columns) {
  return filter_columns(filter_rows(plane, along_rows), along_columns);
}

Plane gradient_length(const Plane& plane, const Kernel& derivative, const Kernel& gaussian) {
  Plane x = filter(plane, derivative, gaussian);
  const Plane y = filter(plane, gaussian, derivative);
  for_each_pixel(x, [&](std::size_t i) { x.values[i] = std::hypot(x.values[i], y.values[i]); });
  return x;
}

// Of a picture in [0, 1].
Appearance appearance(const RgbPlanes& picture, float pixels_per_degree) {
  const int width = picture.r.width, height = picture.r.height;
  // Luminance, red-green and blue-yellow, without YCxCz's factors and offset: all that follows is linear.
  Plane luminance(width, height), red_green(width, height), blue_yellow(width, height);
  for_each_pixel(luminance, [&](std::size_t i) {
    const Vec3f xyz = xyz_from_rgb({picture.r.values[i], picture.g.values[i], picture.b.values[i]});
    luminance.values[i] = xyz.y;
    red_green.values[i] = xyz.x - xyz.y;
    blue_yellow.values[i] = xyz.y - xyz.z;
  });
  const ContrastKernels contrast = contrast_kernels(pixels_per_degree);
  const FeatureKernels features = feature_kernels(pixels_per_degree);
  const auto blue = [&](int i) {
    return filter(blue_yellow, contrast.blue_yellow[i], contrast.blue_yellow[i]);
  };
  Appearance seen{filter(luminance, contrast.luminance, contrast.luminance),
                  filter(red_green, contrast.red_green, contrast.red_green), blue(0),
                  gradient_length(luminance, features.edge, features.gaussian),
                  gradient_length(luminance, features.point, features.gaussian)};
  const Plane blue1 = blue(1);
  const float weight[2] = {contrast.blue_yellow_weight[0], contrast.blue_yellow_weight[1]};
  for_each_pixel(luminance, [&](std::size_t i) {
    const float y = seen.l.values[i], difference = weight[0] * seen.b.values[i] + weight[1] * blue1.values[i];
    Vec3f rgb = rgb_from_xyz({y + seen.a.values[i], y, y - difference});
    for (int k = 0; k < 3; ++k) rgb[k] = std::clamp(rgb[k], 0.0f, 1.0f);
    const Vec3f lab = hunt_adjusted(lab_from_xyz(xyz_from_rgb(rgb)));
    seen.l.values[i] = lab.x;
    seen.a.values[i] = lab.y;
    seen.b.values[i] = lab.z;
  });
  return seen;
}

// Of the two colours of the screen that are farthest apart, green and blue.
float largest_color_difference() {
  const auto color = [](const Vec3f& rgb) { return hunt_adjusted(lab_from_xyz(xyz_from_rgb(rgb))); };
  return std::pow(hyab_distance(color({0, 1, 0}), color({0, 0, 1})), kColorExponent);
}

float remapped_color_difference(float difference, float largest) {
  const float knee = kKnee * largest;
  return difference < knee ? difference * kKneeValue / knee
                           : kKneeValue + (difference - knee) / (largest - knee) * (1 - kKneeValue);
}

Plane difference(const Appearance& a, const Appearance& b) {
  const float largest = largest_color_difference();
  Plane flip(a.l.width, a.l.height);
  for_each_pixel(flip, [&](std::size_t i) {
    const float distance = hyab_distance({a.l.values[i], a.a.values[i], a.b.values[i]},
                                         {b.l.values[i], b.a.values[i], b.b.values[i]});
    const float color = remapped_color_difference(std::pow(distance, kColorExponent), largest);
    const float feature =
        std::pow(std::sqrt(0.5f) * std::max(std::abs(a.edge.values[i] - b.edge.values[i]),
                                            std::abs(a.point.values[i] - b.point.values[i])),
                 kFeatureExponent);
    flip.values[i] = std::pow(color, 1 - feature);
  });
  return flip;
}

// Each value of the three planes through f.
template <class F>
RgbPlanes transformed(const RgbPlanes& picture, const F& f) {
  RgbPlanes result = picture;
  for (Plane* plane : {&result.r, &result.g, &result.b})
    for_each_pixel(*plane, [&](std::size_t i) { plane->values[i] = f(plane->values[i]); });
  return result;
}

// The radiance of which the ACES curve makes `shown`: the larger root of a quadratic equation.
float aces_inverse(float shown) {
  const float a = kA - shown * kC, b = kB - shown * kD, c = -shown * kE;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a) / kAcesScale;
}

RgbPlanes exposed(const RgbPlanes& picture, float stops) {
  const float scale = kAcesScale * std::exp2(stops);
  return transformed(picture, [&](float value) {
    // Far above what the curve takes to white, and far below what overflows in it.
    const float x = std::clamp(value * scale, -1e6f, 1e6f);
    return std::clamp(x * (kA * x + kB) / (x * (kC * x + kD) + kE), 0.0f, 1.0f);
  });
}

}  // namespace

Plane ldr_flip(const RgbPlanes& test, const RgbPlanes& reference, float pixels_per_degree) {
  const auto seen = [&](const RgbPlanes& picture) {
    return appearance(transformed(picture, [](float value) { return std::clamp(value, 0.0f, 1.0f); }),
                      pixels_per_degree);
  };
  return difference(seen(test), seen(reference));
}

ExposureRange exposure_range(const RgbPlanes& reference) {
  std::vector<float> luminances(reference.r.values.size());
  for (std::size_t i = 0; i < luminances.size(); ++i)
    luminances[i] = luminance({reference.r.values[i], reference.g.values[i], reference.b.values[i]});
  const auto median = [&] {
    const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
    std::nth_element(luminances.begin(), middle, luminances.end());
    return *middle;
  };
  float middle = median();
  if (!(middle > 0)) {
    std::erase_if(luminances, [](float value) { return !(value > 0); });
    if (luminances.empty()) return {};
    middle = median();
  }
  const float shown = aces_inverse(0.85f);
  ExposureRange range;
  range.start = std::log2(shown / *std::ranges::max_element(luminances));
  range.stop = std::log2(shown / middle);
  range.count = std::max(2, int(std::ceil(range.stop - range.start)));
  return range;
}

Plane hdr_flip(const RgbPlanes& test, const RgbPlanes& reference, const ExposureRange& exposures,
               float pixels_per_degree) {
  Plane largest(test.r.width, test.r.height);
  for (int i = 0; i < exposures.count; ++i) {
    const float stops =
        exposures.start + (exposures.stop - exposures.start) * float(i) / float(exposures.count - 1);
    const Plane flip = ldr_flip(exposed(test, stops), exposed(reference, stops), pixels_per_degree);
    for_each_pixel(flip,
                   [&](std::size_t k) { largest.values[k] = std::max(largest.values[k], flip.values[k]); });
  }
  return largest;
}

}  // namespace parian

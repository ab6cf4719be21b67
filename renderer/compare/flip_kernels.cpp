#include "renderer/compare/flip_kernels.h"

#include <cmath>
#include <numbers>

namespace parian {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;

// A term a sqrt(pi / b) exp(-pi^2 x^2 / b) of a contrast sensitivity function, x in degrees: table 1 of the
// paper.
struct Term {
  double a, b;
};
constexpr Term kLuminance{1, 0.0047}, kRedGreen{1, 0.0053}, kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};

// f at -radius, ..., radius.
template <class F>
std::vector<double> tabulate(int radius, const F& f) {
  std::vector<double> values;
  for (int i = -radius; i <= radius; ++i) values.push_back(f(double(i)));
  return values;
}

// Positive values divided by their sum, and negative ones by the absolute value of theirs.
Kernel normalized(const std::vector<double>& values) {
  double positive = 0, negative = 0;
  for (const double v : values) (v > 0 ? positive : negative) += std::abs(v);
  Kernel kernel;
  for (const double v : values) kernel.push_back(float(v > 0 ? v / positive : v < 0 ? v / negative : 0));
  return kernel;
}

}  // namespace

ContrastKernels contrast_kernels(float pixels_per_degree) {
  // Three standard deviations of the widest Gaussian.
  const int radius = int(std::ceil(3 * std::sqrt(kBlueYellow[0].b / (2 * kPi2)) * pixels_per_degree));
  const auto gaussian = [&](const Term& term) {
    return tabulate(radius, [&](double i) {
      const double x = i / pixels_per_degree;
      return std::exp(-kPi2 * x * x / term.b);
    });
  };
  ContrastKernels kernels;
  kernels.luminance = normalized(gaussian(kLuminance));
  kernels.red_green = normalized(gaussian(kRedGreen));
  double volumes[2];
  for (int i = 0; i < 2; ++i) {
    const std::vector<double> values = gaussian(kBlueYellow[i]);
    double sum = 0;
    for (const double v : values) sum += v;
    volumes[i] = kBlueYellow[i].a * std::sqrt(std::numbers::pi / kBlueYellow[i].b) * sum * sum;
    kernels.blue_yellow[i] = normalized(values);
  }
  for (int i = 0; i < 2; ++i) kernels.blue_yellow_weight[i] = float(volumes[i] / (volumes[0] + volumes[1]));
  return kernels;
}

FeatureKernels feature_kernels(float pixels_per_degree) {
  // Half of the width of the features, in degrees, that the eye is best at.
  const double sigma = 0.5 * 0.082 * pixels_per_degree;
  const int radius = int(std::ceil(3 * sigma));
  const auto gaussian = [&](double x) { return std::exp(-x * x / (2 * sigma * sigma)); };
  return {
      normalized(tabulate(radius, gaussian)),
      normalized(tabulate(radius, [&](double x) { return -x * gaussian(x); })),
      normalized(tabulate(radius, [&](double x) { return (x * x / (sigma * sigma) - 1) * gaussian(x); }))};
}

}  // namespace parian

/// The textbook's formulas, without care for rounding: in float what is tried, in long double the reference.
#pragma once

#include <cmath>
#include <numbers>

namespace parian {

using Real = long double;

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

}  // namespace parian

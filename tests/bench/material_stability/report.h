/// Rows of the tables, and what they measure.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/support/statistics.h"

namespace parian {

inline constexpr int kTries = 1000000;

/// In three digits: 3e-8, 0.031, 12.
inline std::string number(double x) {
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

inline void print_head(const char* measure) {
  fmt::print("\n| {} | where | naive form | naive | Parian |\n|---|---|---|---|---|\n", measure);
}

inline void print_row(const std::string& what, const std::string& where, const std::string& form,
                      const std::string& naive, const std::string& parian) {
  fmt::print("| {} | {} | {} | {} | {} |\n", what, where, form, naive, parian);
}

inline std::string percent(double share) { return number(100 * share) + "%"; }

/// Evenly in the logarithm.
inline float between(TestRandom& random, double low, double high) {
  return float(low * std::pow(high / low, double(random.next1())));
}

// Each prints the tables of its subject.
void compare_fresnel();
void compare_facets();
void compare_samples();
void compare_media();
void compare_without_failure();

}  // namespace parian

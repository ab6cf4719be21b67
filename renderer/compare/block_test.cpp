#include "renderer/compare/block_test.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace parian {
namespace {

constexpr int kBlocksPerSide = 4;
// Pictures without noise are equal but for rounding: relative to 1, or to the value where it is larger.
constexpr double kRounding = 1e-6;

std::optional<std::size_t> find_channel(const Picture& picture, const std::string& name) {
  const auto found = std::ranges::find(picture.channels, name);
  if (found == picture.channels.end()) return {};
  return std::size_t(found - picture.channels.begin());
}

// How many samples the pixels of a picture have, where it says so.
struct SampleCounts {
  std::optional<std::size_t> channel;
  double constant = 0;

  bool known() const { return channel || constant > 0; }
  double of(const float* pixel) const { return channel ? pixel[*channel] : constant; }
};

SampleCounts sample_counts(const Picture& picture) {
  SampleCounts counts{find_channel(picture, "samples"), 0};
  if (const auto found = picture.metadata.find("parian:spp"); found != picture.metadata.end())
    counts.constant = std::strtod(found->second.c_str(), nullptr);
  return counts;
}

// One of the two pictures, and where in it the channel in question and its variance are.
struct Side {
  const Picture& picture;
  SampleCounts samples;
  std::size_t channel = 0;
  std::optional<std::size_t> variance;
};

// The variance of the difference of a pixel, whose values are at t and r.
double variance_of_difference(const Side& test, const Side& reference, const float* t, const float* r) {
  if (test.variance && reference.variance) return double(t[*test.variance]) + r[*reference.variance];
  const bool scaled = test.samples.known() && reference.samples.known();
  const double ratio = scaled ? test.samples.of(t) / reference.samples.of(r) : 0;
  if (test.variance) return t[*test.variance] * (1 + ratio);
  return r[*reference.variance] * (scaled ? 1 + 1 / ratio : 1);
}

double score(const Side& test, const Side& reference, int x0, int y0, int x1, int y1) {
  double difference = 0, variance = 0;
  bool sound = true;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const float *t = test.picture.at(x, y), *r = reference.picture.at(x, y);
      const double value = r[reference.channel], v = variance_of_difference(test, reference, t, r);
      difference += t[test.channel] - value;
      variance += v + kRounding * kRounding * std::max(1.0, value * value);
      sound = sound && v >= 0;
    }
  return sound && std::isfinite(variance) ? difference / std::sqrt(variance) : NAN;
}

int blocks_per_side(const Picture& picture, int smallest_block) {
  for (int n = kBlocksPerSide; n > 1; --n)
    if (long(picture.width / n) * (picture.height / n) >= smallest_block) return n;
  return 1;
}

}  // namespace

bool BlockTest::accepts(const BlockScore& score) const { return std::abs(score.z) < limit; }

const BlockScore& BlockTest::worst() const {
  const auto less = [](const BlockScore& a, const BlockScore& b) {
    return !std::isnan(a.z) && (std::isnan(b.z) || std::abs(a.z) < std::abs(b.z));
  };
  return *std::ranges::max_element(scores, less);
}

std::optional<BlockTest> block_test(const Picture& test, const Picture& reference,
                                    const BlockTestOptions& options) {
  BlockTest result{VarianceFrom::both, false, 1, 0, {}};
  Side t{test, sample_counts(test), 0, {}}, r{reference, sample_counts(reference), 0, {}};
  for (const std::string name : {"R", "G", "B", "Y"}) {
    const auto in_test = find_channel(test, name), in_reference = find_channel(reference, name);
    t.variance = find_channel(test, "variance." + name);
    r.variance = find_channel(reference, "variance." + name);
    if (!in_test || !in_reference || !(t.variance || r.variance)) continue;
    t.channel = *in_test;
    r.channel = *in_reference;
    const int n = result.blocks_per_side = blocks_per_side(test, t.variance ? options.smallest_block : 1);
    result.variance = !t.variance   ? VarianceFrom::reference
                      : !r.variance ? VarianceFrom::test
                                    : VarianceFrom::both;
    const auto add = [&](int x0, int y0, int x1, int y1) {
      result.scores.push_back({name, x0, y0, x1, y1, score(t, r, x0, y0, x1, y1)});
    };
    const int w = test.width, h = test.height;
    add(0, 0, w, h);
    for (int i = 0; n > 1 && i < n * n; ++i)
      add(w * (i % n) / n, h * (i / n) / n, w * (i % n + 1) / n, h * (i / n + 1) / n);
  }
  if (result.scores.empty()) return {};
  result.other_is_exact = result.variance != VarianceFrom::both && !(t.samples.known() && r.samples.known());
  result.limit = two_sided_normal_quantile(options.significance / double(result.scores.size()));
  return result;
}

double two_sided_normal_quantile(double p) {
  // erfc(z / sqrt 2) falls from 1 to 0; halved as often as a double has bits and more.
  double low = 0, high = 40;
  for (int i = 0; i < 100; ++i) {
    const double z = (low + high) / 2;
    (std::erfc(z / std::numbers::sqrt2) > p ? low : high) = z;
  }
  return (low + high) / 2;
}

}  // namespace parian

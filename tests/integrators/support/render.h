/// Renders small scenes through a Session, and means of pictures with their standard errors.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "integrators/integrators.h"
#include "renderer/session/session.h"

namespace parian {

/// Settings whose samples are independent and stay in their pixels, so that the variance layer gives standard
/// errors.
inline RenderSettings independent_settings(int width, int height, std::uint32_t spp, std::uint32_t seed = 1) {
  RenderSettings s;
  s.width = width;
  s.height = height;
  s.spp = spp;
  s.seed = seed;
  s.sampler = SamplerKind::independent;
  s.filter = FilterKind::box;
  return s;
}

/// Settings of the path integrator.
inline IntegratorSettings with(Strategy strategy, int max_depth = 100) {
  IntegratorSettings s;
  s.strategy = strategy;
  s.max_depth = max_depth;
  return s;
}

/// The finished picture of a scene; no sample may be dropped.
inline Picture render(const Scene& scene, const RenderSettings& settings,
                      const IntegratorSettings& integrator = {}, const std::string& name = "path") {
  validate(scene, "test scene");
  Session session(std::make_shared<const Scene>(scene), settings, make_integrator(name, integrator));
  session.start();
  session.wait();
  EXPECT_EQ(session.stats().rays.dropped, 0u);
  return session.snapshot();
}

/// The index of a channel; the picture must have it.
inline std::size_t channel_of(const Picture& picture, const std::string& name) {
  for (std::size_t i = 0; i < picture.channels.size(); ++i)
    if (picture.channels[i] == name) return i;
  ADD_FAILURE() << "no channel " << name;
  return 0;
}

/// A mean with its standard error.
struct Mean {
  double value = 0, error = 0;
};

/// Mean of channel 0, 1 or 2 over an area. Its error adds up the pixels' variances (sums over thousands of
/// samples, never one pixel's own): right where samples are independent and the filter is a box.
inline Mean mean_of(const Picture& picture, int channel, const Tile& area) {
  const std::size_t variance = channel_of(picture, std::string("variance.") + "RGB"[channel]);
  double sum = 0, squares = 0;
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x) {
      sum += picture.at(x, y)[channel];
      squares += picture.at(x, y)[variance];
    }
  const double count = double(area.x1 - area.x0) * (area.y1 - area.y0);
  return {sum / count, std::sqrt(squares) / count};
}

inline Mean mean_of(const Picture& picture, int channel) {
  return mean_of(picture, channel, {0, 0, picture.width, picture.height});
}

/// |mean - truth| < 4.5 standard errors, these being small enough to see an error of `tolerance`, relative to
/// truth.
inline testing::AssertionResult mean_is(const Mean& mean, double truth, double tolerance) {
  const double allowed = 4.5 * mean.error;
  if (!(allowed <= tolerance * std::abs(truth)))
    return testing::AssertionFailure()
           << "too few samples: 4.5 standard errors are " << allowed << " of " << truth << ", tolerance "
           << tolerance * std::abs(truth) << ", mean " << mean.value;
  // Estimates without variance still round.
  if (std::abs(mean.value - truth) < allowed + 2e-6 * std::abs(truth)) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "mean " << mean.value << " +- " << mean.error << ", expected "
                                     << truth << " (" << 100 * (mean.value / truth - 1) << "%)";
}

/// Whether two independent estimates of the same value agree, and could tell a difference of `tolerance`.
inline testing::AssertionResult means_agree(const Mean& a, const Mean& b, double tolerance) {
  return mean_is({a.value, std::hypot(a.error, b.error)}, b.value, tolerance);
}

}  // namespace parian

#include "renderer/base/random.h"

#include <algorithm>

#include "renderer/base/vectorize.h"

namespace parian {
namespace {

constexpr int kLanes = 8;  // what a register holds

struct Lanes {
  std::uint32_t reversed_sample[kLanes]{}, state[kLanes]{};
  float x[2][kLanes], y[2][kLanes];
};

PARIAN_VECTORIZE void sobol_points(Lanes& lanes, std::uint32_t step) {
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < kLanes; ++i) {
      lanes.state[i] += step;
      const Vec2f p = scrambled_sobol(lanes.reversed_sample[i], hash32(lanes.state[i]));
      lanes.x[k][i] = p.x;
      lanes.y[k][i] = p.y;
    }
}

}  // namespace

void next2_twice(std::span<Sampler* const> samplers, Vec2f* first, Vec2f* second) {
  for (std::size_t done = 0; done < samplers.size(); done += kLanes) {
    const std::span<Sampler* const> some =
        samplers.subspan(done, std::min<std::size_t>(kLanes, samplers.size() - done));
    // A few are quicker one by one.
    if (some.size() < 3 || some[0]->kind_ != SamplerKind::sobol) {
      for (std::size_t i = 0; i < some.size(); ++i) {
        first[done + i] = some[i]->next2();
        second[done + i] = some[i]->next2();
      }
      continue;
    }
    Lanes lanes;
    for (std::size_t i = 0; i < some.size(); ++i) {
      lanes.reversed_sample[i] = some[i]->reversed_sample_;
      lanes.state[i] = some[i]->state_;
    }
    sobol_points(lanes, Sampler::kStep);
    for (std::size_t i = 0; i < some.size(); ++i) {
      some[i]->state_ = lanes.state[i];
      first[done + i] = {lanes.x[0][i], lanes.y[0][i]};
      second[done + i] = {lanes.x[1][i], lanes.y[1][i]};
    }
  }
}

}  // namespace parian

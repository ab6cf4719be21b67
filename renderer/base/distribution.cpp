#include "renderer/base/distribution.h"

#include <algorithm>
#include <utility>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

// What is done for each weight is dealt to threads by this number of weights.
constexpr std::size_t kBlock = 4096;

}  // namespace

Distribution1D::Distribution1D(std::span<const float> weights) : cdf_(weights.size() + 1) {
  // Sums over blocks, added up in their order: the same bits for any number of threads.
  const std::size_t count = weights.size(), blocks = (count + kBlock - 1) / kBlock;
  std::vector<double> sums(blocks);
  const auto for_each_block = [&](const auto& body) {
    parallel_for(blocks, 1, [&](std::size_t k) { body(k, k * kBlock, std::min(count, (k + 1) * kBlock)); });
  };
  const auto share = [&](std::size_t i) { return total_ > 0 ? weights[i] / total_ : 1.0 / double(count); };
  for_each_block([&](std::size_t k, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sums[k] += weights[i];
  });
  for (const double sum : sums) total_ += sum;
  if (blocks > 1) {
    for_each_block([&](std::size_t k, std::size_t first, std::size_t last) {
      sums[k] = 0;
      for (std::size_t i = first; i < last; ++i) sums[k] += share(i);
    });
    double before = 0;
    for (double& sum : sums) before += std::exchange(sum, before);
  } else {
    std::ranges::fill(sums, 0.0);
  }
  for_each_block([&](std::size_t k, std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i) {
      sum += share(i);
      cdf_[i + 1] = float(std::min(sums[k] + sum, 1.0));
    }
  });
  // Rounding must not leave a gap below 1; it goes to the last index that has any weight.
  for (std::size_t i = count; i > 0; --i) {
    cdf_[i] = 1;
    if (total_ == 0 || weights[i - 1] > 0) break;
  }
  few_.fill(2);
  if (size() <= kFew) {
    std::copy(cdf_.begin() + 1, cdf_.end(), few_.begin());
    return;
  }
  guide_.resize(cdf_.size());
  parallel_for((guide_.size() + kBlock - 1) / kBlock, 1, [&](std::size_t block) {
    int first = 0;
    for (std::size_t k = block * kBlock; k < std::min(guide_.size(), (block + 1) * kBlock); ++k)
      guide_[k] = std::uint32_t(first = search(float(double(k) / size()), first, size() - 1));
  });
}

/// The last index from `first` to `last` whose sum is at most u, by halving.
int Distribution1D::search(float u, int first, int last) const {
  for (int count = last - first + 1; count > 1;) {
    const int half = count / 2;
    if (cdf_[first + half] <= u) first += half;
    count -= half;
  }
  return first;
}

Distribution2D::Distribution2D(int nx, int ny, const std::function<float(int, int)>& weight)
    : nx_(nx), ny_(ny), columns_(ny) {
  parallel_for(std::size_t(ny), 8, [&](std::size_t y) {
    std::vector<float> row(nx);
    for (int x = 0; x < nx; ++x) row[x] = weight(x, int(y));
    columns_[y] = Distribution1D(row);
  });
  std::vector<float> sums(ny);
  for (int y = 0; y < ny; ++y) sums[y] = float(columns_[y].total());
  rows_ = Distribution1D(sums);
}

float Distribution2D::pdf(const Vec2f& p) const {
  const int x = std::clamp(int(p.x * float(nx_)), 0, nx_ - 1),
            y = std::clamp(int(p.y * float(ny_)), 0, ny_ - 1);
  return rows_.probability(y) * columns_[y].probability(x) * float(nx_) * float(ny_);
}

Distribution2D::Sample Distribution2D::sample(const Vec2f& u) const {
  const Distribution1D::Sample row = rows_.sample(u.y), column = columns_[row.index].sample(u.x);
  const Vec2f p((float(column.index) + column.remainder) / float(nx_),
                (float(row.index) + row.remainder) / float(ny_));
  return {p, row.probability * column.probability * float(nx_) * float(ny_)};
}

}  // namespace parian

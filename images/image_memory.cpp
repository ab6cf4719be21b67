#include "images/image_memory.h"

#include <algorithm>
#include <numeric>

#include "renderer/base/error.h"

namespace parian {
namespace {

constexpr std::size_t kLeastCache = ImageCache::kLeastBytes;

}  // namespace

void ImageMemory::keep(std::size_t bytes, const std::string& name) {
  const std::size_t left = cap_ - in_memory_;
  if (bytes > left || (cache_ && left - bytes < kLeastCache))
    throw InputError(name, "",
                     fmt::format("an environment map of {} bytes has to stay in memory; {} of the {} bytes "
                                 "for textures are left",
                                 bytes, cache_ ? left - std::min(left, kLeastCache) : left, cap_));
  in_memory_ += bytes;
  if (cache_) cache_->limit(cap_ - in_memory_);
}

ImagePlan ImageMemory::plan(const std::vector<std::size_t>& bytes, bool last) {
  std::vector<std::size_t> by_size(bytes.size());
  std::iota(by_size.begin(), by_size.end(), std::size_t(0));
  std::ranges::stable_sort(by_size, {}, [&](std::size_t i) { return bytes[i]; });
  const std::size_t left = cap_ - in_memory_;
  const bool all_fit = std::accumulate(bytes.begin(), bytes.end(), std::size_t(0)) <= left;
  const std::size_t share = all_fit && last && !cache_ ? 0 : std::max(cap_ / 4, kLeastCache);
  const std::size_t for_images = left - std::min(left, share);

  ImagePlan plan;
  std::size_t taken = 0, i = 0;
  for (; i < by_size.size() && taken + bytes[by_size[i]] <= for_images; ++i) {
    taken += bytes[by_size[i]];
    plan.in_memory.push_back(by_size[i]);
  }
  in_memory_ += taken;
  const std::size_t for_cache = cap_ - in_memory_;
  std::size_t group = 0;
  for (; i < by_size.size(); ++i) {
    if (plan.cached.empty() || group + bytes[by_size[i]] > for_cache) {
      plan.cached.emplace_back();
      group = 0;
    }
    plan.cached.back().push_back(by_size[i]);
    group += bytes[by_size[i]];
  }
  if (plan.cached.empty()) return plan;
  if (for_cache < kLeastCache)
    throw InputError("textures", "",
                     fmt::format("environment maps leave {} of {} bytes; expected {} for the others",
                                 for_cache, cap_, kLeastCache));
  if (!cache_) cache_.emplace();
  cache_->limit(for_cache);
  return plan;
}

ImageMemoryStatistics ImageMemory::statistics() const {
  if (!cache_) return {in_memory_, 0, {}};
  return {in_memory_, cap_ - in_memory_, cache_->statistics()};
}

}  // namespace parian

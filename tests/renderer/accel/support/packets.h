/// Packets of rays against the same rays one by one.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "renderer/accel/accel.h"

namespace parian {

/// Asks about rays one by one, and again in packets of a given size, and counts where the answers differ.
class Packets {
 public:
  explicit Packets(const Accel& accel, int size = RayPacket::kSize) : accel_(accel), size_(size) {}

  void add(const Ray& ray, std::uint32_t random = 0) {
    accel_.intersect(ray, random, alone_[rays_.count]);
    rays_.add(ray, random);
    if (rays_.count == size_) ask();
  }

  int rays = 0;
  int lost = 0, invented = 0;  // hits that the packet, or the ray alone, does not have
  int other = 0;               // another triangle, or at another distance
  int shadows = 0;             // occluded() disagrees with intersect(), in packets
  int blocked_alone = 0;       // occluded() blocks what intersect() of the ray alone leaves open

 private:
  void ask() {
    std::array<Hit, RayPacket::kSize> hits;
    accel_.intersect(rays_, hits);
    const std::uint32_t blocked = accel_.occluded(rays_);
    EXPECT_EQ(blocked >> rays_.count, 0u);
    for (int i = 0; i < rays_.count; ++i, ++rays) {
      const bool found = hits[i].placement != Hit::kMiss, alone = alone_[i].placement != Hit::kMiss;
      lost += alone && !found;
      invented += found && !alone;
      shadows += found != bool(blocked >> i & 1);
      blocked_alone += !alone && (blocked >> i & 1);
      if (found && alone)
        other += std::abs(hits[i].t - alone_[i].t) > 1e-5f * alone_[i].t ||
                 hits[i].placement != alone_[i].placement || hits[i].primitive != alone_[i].primitive ||
                 hits[i].triangle != alone_[i].triangle;
    }
    rays_.count = 0;
  }

  const Accel& accel_;
  int size_;
  RayPacket rays_;
  std::array<Hit, RayPacket::kSize> alone_;
};

}  // namespace parian

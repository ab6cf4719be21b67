// Packets: each ray as if it were alone.
#include <gtest/gtest.h>

#include "tests/renderer/accel/support/built.h"
#include "tests/renderer/accel/support/packets.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

// Caught: lanes that are exchanged, tmax of the first ray for all, a lane beyond the count that is traced, an
// instance taken from the first lane.
TEST(Accel, PacketsGiveTheHitsOfSingleRays) {
  for (const bool editable : {false, true})
    for (const int size : {1, 5, 16}) {
      const Built b(many_placements(5), editable);
      TestRandom random(6);
      Packets apart(*b.accel, size), along(*b.accel, size);
      for (int i = 0; i < 16000; ++i) {
        Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
        if (i % 3 == 0) ray.tmax = 4 * random.next1();
        apart.add(ray);
      }
      for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
        for (int k = 0; k < 16; ++k) along.add({ray.o, normalize(ray.d + random.direction() * 0.02f)});
      }
      for (const Packets* p : {&apart, &along}) {
        EXPECT_GT(p->rays, 15000);
        // At an edge the two may round apart.
        EXPECT_LE(p->lost + p->invented + p->other + p->shadows, 2) << p->lost << p->invented << p->other;
      }
    }
}

}  // namespace
}  // namespace parian

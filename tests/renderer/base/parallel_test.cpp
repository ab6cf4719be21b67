#include "renderer/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace parian {
namespace {

TEST(ParallelFor, VisitsEachIndexOnce) {
  for (const std::size_t count : {0, 1, 2, 7, 1000, 65537})
    for (const std::size_t grain : {1, 7, 100000}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(count, grain, [&](std::size_t i) { ++visits.at(i); });
      for (const auto& v : visits) ASSERT_EQ(v, 1) << count << " by " << grain;
    }
}

TEST(ParallelFor, RethrowsWhatABodyThrows) {
  const auto throwing = [] {
    parallel_for(1000, 1, [](std::size_t i) {
      if (i == 500) throw std::out_of_range("the body's own");
    });
  };
  EXPECT_THROW(throwing(), std::out_of_range);
  std::atomic<int> visits = 0;
  parallel_for(100, 1, [&](std::size_t) { ++visits; });
  EXPECT_EQ(visits, 100) << "later loops run as before";
}

TEST(ParallelFor, Nests) {
  std::atomic<int> visits = 0;
  parallel_for(20, 1, [&](std::size_t) { parallel_for(30, 4, [&](std::size_t) { ++visits; }); });
  EXPECT_EQ(visits, 600);
}

TEST(ParallelChunks, CoverEachIndexOnce) {
  for (const std::size_t count : {std::size_t(0), std::size_t(1), kParallelChunk - 1, kParallelChunk,
                                  kParallelChunk + 1, 3 * kParallelChunk, 3 * kParallelChunk + 5}) {
    std::vector<std::atomic<std::uint8_t>> visits(count);
    parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % kParallelChunk, 0u);
      EXPECT_TRUE(end - begin == kParallelChunk || end == count);
      for (std::size_t i = begin; i < end; ++i) ++visits.at(i);
    });
    EXPECT_TRUE(std::ranges::all_of(visits, [](const auto& v) { return v == 1; })) << count;
  }
}

TEST(ParallelLoop, VisitsEachIndexOnceEachTime) {
  for (const Partitioner partitioner :
       {Partitioner::automatic, Partitioner::fixed, Partitioner::simple, Partitioner::affinity}) {
    ParallelLoop loop(partitioner);
    for (const std::size_t count : {1000, 7, 0, 1000}) {
      std::vector<std::atomic<int>> visits(count);
      loop.run(count, [&](std::size_t i) { ++visits.at(i); });
      for (const auto& v : visits) ASSERT_EQ(v, 1) << int(partitioner) << ": " << count;
    }
    EXPECT_THROW(loop.run(10, [](std::size_t) { throw std::out_of_range("the body's own"); }),
                 std::out_of_range);
  }
}

// A slow item keeps one thread: dealt one by one, the others go to the other; in equal shares, the thread's
// own wait for it. A machine of one core has all items on one thread both ways.
TEST(ParallelLoop, DealsAsThePartitionerSays) {
  constexpr int kItems = 64;
  const int threads = std::min(2, hardware_threads());
  set_thread_count(threads);
  const auto largest_share = [](Partitioner partitioner) {
    std::mutex mutex;
    std::map<std::thread::id, int> items;
    ParallelLoop(partitioner).run(kItems, [&](std::size_t i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(i == 0 ? 100 : 1));
      const std::lock_guard lock(mutex);
      ++items[std::this_thread::get_id()];
    });
    int most = 0;
    for (const auto& entry : items) most = std::max(most, entry.second);
    return most;
  };
  EXPECT_EQ(largest_share(Partitioner::fixed), kItems / threads);
  EXPECT_GT(largest_share(Partitioner::simple), 50);
  set_thread_count(hardware_threads());
}

TEST(ThreadCount, LimitsTheThreadsOfALoop) {
  EXPECT_GE(hardware_threads(), 1);
  for (const int threads : {2, 1}) {
    set_thread_count(threads);
    EXPECT_EQ(thread_count(), threads);
    std::mutex mutex;
    std::set<std::thread::id> seen;
    parallel_for(200, 1, [&](std::size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(50));
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
    EXPECT_LE(int(seen.size()), threads);
  }
  set_thread_count(hardware_threads());
}

}  // namespace
}  // namespace parian

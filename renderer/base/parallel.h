/// Parallel loops. The only header through which the rest of Parian uses threads; oneTBB stays in
/// parallel.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

namespace parian {

/// The number of threads the machine gives this process (its affinity mask counted).
int hardware_threads();

/// Limits every later loop of the process to `threads` >= 1. Call it once, before the first loop.
void set_thread_count(int threads);
int thread_count();

/// Calls body(i) once for each i in [0, count), in any order, on thread_count() threads. Items are handed out
/// `grain` at a time. An exception in a body ends the loop and is rethrown here.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

/// For items too small to be handed out one by one: calls body(begin, end) for ranges that together are
/// [0, count), each of kParallelChunk items but for the last; on this thread where there is one alone.
inline constexpr std::size_t kParallelChunk = std::size_t(1) << 16;
void parallel_chunks(std::size_t count, const std::function<void(std::size_t begin, std::size_t end)>& body);

/// Calls body() here, its loops (and those of libraries on oneTBB) on at most `threads` >= 1 threads.
void run_on_threads(int threads, const std::function<void()>& body);

/// How the items of a loop are dealt to threads, as oneTBB's partitioners do it: in halves that are split
/// again where a thread is idle; in equal shares once and for all; one by one; like the first, but each to
/// the thread that had it the last time.
enum class Partitioner : std::uint8_t { automatic, fixed, simple, affinity };

/// A loop that runs again and again over the same items, dealt by a partitioner. One run at a time.
class ParallelLoop {
 public:
  explicit ParallelLoop(Partitioner partitioner);
  ~ParallelLoop();
  /// As parallel_for() with a grain of 1.
  void run(std::size_t count, const std::function<void(std::size_t)>& body);

 private:
  struct Memory;  // of who had what
  Partitioner partitioner_;
  std::unique_ptr<Memory> memory_;
};

}  // namespace parian

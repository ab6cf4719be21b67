#include "renderer/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace parian {
namespace {

// The limit is a property of the process, as oneTBB's own pool is.
struct ThreadLimit {
  int threads = hardware_threads();
  std::unique_ptr<tbb::global_control> control;
};

ThreadLimit& limit() {
  static ThreadLimit instance;
  return instance;
}

template <class P>
void run_loop(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body,
              P&& partitioner) {
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, count, grain),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
      },
      partitioner);
}

}  // namespace

int hardware_threads() { return tbb::info::default_concurrency(); }

void set_thread_count(int threads) {
  limit().control.reset();
  limit().control = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                          std::size_t(threads));
  limit().threads = threads;
}

int thread_count() { return limit().threads; }

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body) {
  run_loop(count, grain, body, tbb::simple_partitioner());
}

void parallel_chunks(std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
  const auto chunk = [&](std::size_t i) {
    body(i * kParallelChunk, std::min(count, (i + 1) * kParallelChunk));
  };
  const std::size_t chunks = (count + kParallelChunk - 1) / kParallelChunk;
  if (chunks == 1) return chunk(0);
  parallel_for(chunks, 1, chunk);
}

void run_on_threads(int threads, const std::function<void()>& body) {
  tbb::task_arena arena(threads);
  arena.execute(body);
}

struct ParallelLoop::Memory {
  tbb::affinity_partitioner partitioner;
};

ParallelLoop::ParallelLoop(Partitioner partitioner)
    : partitioner_(partitioner), memory_(std::make_unique<Memory>()) {}

ParallelLoop::~ParallelLoop() = default;

void ParallelLoop::run(std::size_t count, const std::function<void(std::size_t)>& body) {
  switch (partitioner_) {
    case Partitioner::automatic:
      return run_loop(count, 1, body, tbb::auto_partitioner());
    case Partitioner::fixed:
      return run_loop(count, 1, body, tbb::static_partitioner());
    case Partitioner::simple:
      return run_loop(count, 1, body, tbb::simple_partitioner());
    case Partitioner::affinity:
      return run_loop(count, 1, body, memory_->partitioner);
  }
}

}  // namespace parian

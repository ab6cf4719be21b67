/// Parallel loops. The only header through which the rest of Parian uses threads; oneTBB stays in
/// parallel.cpp.
#pragma once

#include <cstddef>
#include <functional>

namespace parian {

/// The number of threads the machine gives this process (its affinity mask counted).
int hardware_threads();

/// Limits every later loop of the process to `threads` >= 1. Call it once, before the first loop.
void set_thread_count(int threads);
int thread_count();

/// Calls body(i) once for each i in [0, count), in any order, on thread_count() threads. Items are handed out
/// `grain` at a time. An exception in a body ends the loop and is rethrown here.
void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& body);

}  // namespace parian

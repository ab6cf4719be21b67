/// The memory of the process: what it takes, what it may take, and buffers that give back what nobody reads.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/base/shared_array.h"

namespace parian {

/// What is resident of this process now, and what was at most so far, in bytes.
std::size_t resident_memory();
std::size_t peak_memory();

/// What the process could take without the machine swapping: what is resident and what is free, within the
/// limits of its control groups.
std::size_t available_memory();

/// Bounds the process, by default to available_memory() as it was at the first call of either function here.
/// Set it before anything large is loaded.
void set_memory_limit(std::size_t bytes);
std::size_t memory_limit();

/// Throws std::runtime_error where `bytes` more than now would be above the limit, or cannot be had anyway;
/// `what` it is for, as in "the picture". To be asked before what is large is allocated.
void require_memory(std::size_t bytes, std::string_view what);

/// 1.5 GB, 20.3 MB, 700 kB: decimal units, as the tools of the system print.
std::string format_bytes(double bytes);

/// Uninitialised memory of its own pages, with kArrayPadding bytes behind its end that may be read.
class PageBuffer {
 public:
  /// Throws std::bad_alloc.
  explicit PageBuffer(std::size_t size);
  ~PageBuffer();
  PageBuffer(const PageBuffer&) = delete;
  PageBuffer& operator=(const PageBuffer&) = delete;

  std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }

  /// Gives back to the system all pages that lie in none of the parts; what was in them is lost.
  void release_all_but(std::vector<std::span<const std::byte>> parts);

 private:
  std::byte* data_;
  std::size_t size_, mapped_;
};

/// As make_shared_array(), of pages of its own, as large as the system has them: for large arrays that are
/// read at random.
template <class T>
std::pair<SharedArray<T>, T*> make_page_array(std::size_t size) {
  auto pages = std::make_shared<PageBuffer>(size * sizeof(T));
  T* const data = reinterpret_cast<T*>(pages->data());
  return {SharedArray<T>(std::move(pages), data, size, true), data};
}

}  // namespace parian

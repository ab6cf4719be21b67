/// A read-only array that shares its storage: copying a scene copies no vertex and no texel.
#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace parian {

/// Bytes behind the end of an array that is padded().
inline constexpr std::size_t kArrayPadding = 16;

template <class T>
class SharedArray {
 public:
  SharedArray() = default;
  SharedArray(std::vector<T> values) {  // NOLINT: implicit on purpose, a vector becomes an array
    auto owner = std::make_shared<const std::vector<T>>(std::move(values));
    data_ = owner->data();
    size_ = owner->size();
    owner_ = std::move(owner);
  }
  /// A view of memory that `owner` keeps alive.
  SharedArray(std::shared_ptr<const void> owner, const T* data, std::size_t size, bool padded = false)
      : owner_(std::move(owner)), data_(data), size_(size), padded_(padded) {}

  const T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  bool empty() const { return size_ == 0; }
  /// Whether kArrayPadding bytes behind the last element may be read too, which vector loads of it do.
  bool padded() const { return padded_; }
  const std::shared_ptr<const void>& owner() const { return owner_; }
  const T& operator[](std::size_t i) const { return data_[i]; }
  const T* begin() const { return data_; }
  const T* end() const { return data_ + size_; }

  /// Bitwise equal contents.
  bool operator==(const SharedArray& other) const {
    // Not trivially copyable: Imath's vectors write their copy constructors out.
    static_assert(std::is_standard_layout_v<T> && std::is_trivially_destructible_v<T>);
    return size_ == other.size_ &&
           (data_ == other.data_ || size_ == 0 || std::memcmp(data_, other.data_, bytes()) == 0);
  }

 private:
  std::shared_ptr<const void> owner_;
  const T* data_ = nullptr;
  std::size_t size_ = 0;
  bool padded_ = false;
};

/// A padded array of its own, not initialised, and where to write it.
template <class T>
std::pair<SharedArray<T>, T*> make_shared_array(std::size_t size) {
  auto owner = std::make_shared_for_overwrite<T[]>(size + (kArrayPadding + sizeof(T) - 1) / sizeof(T));
  T* const data = owner.get();
  return {SharedArray<T>(std::move(owner), data, size, true), data};
}

}  // namespace parian

#include "renderer/base/memory.h"

#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace parian {
namespace {

constexpr std::size_t kMega = std::size_t(1) << 20;

// Caught: the padding left out of the mapping, a part's page given back, nothing given back.
TEST(PageBuffer, GivesBackAllPagesButThoseOfTheParts) {
  PageBuffer buffer(64 * kMega);
  std::memset(buffer.data(), 1, buffer.size());
  const std::size_t before = resident_memory();
  const auto part = [&](std::size_t from, std::size_t size) {
    return std::span<const std::byte>(buffer.data() + from, size);
  };
  // Out of order, within a page, across pages, and up to the end.
  buffer.release_all_but({part(40 * kMega - 5, 10), part(10 * kMega + 100, 50), part(64 * kMega - 7, 7)});
  EXPECT_GT(before, resident_memory() + 60 * kMega);
  for (const std::size_t i :
       {40 * kMega - 5, 40 * kMega + 4, 10 * kMega + 100, 10 * kMega + 149, 64 * kMega - 1})
    EXPECT_EQ(buffer.data()[i], std::byte(1)) << i;
  EXPECT_EQ(buffer.data()[20 * kMega], std::byte(0));
  EXPECT_EQ(buffer.data()[buffer.size() + kArrayPadding - 1], std::byte(0));  // may be read
}

TEST(PageBuffer, KeepsAllWhereAllIsUsed) {
  PageBuffer buffer(3 * kMega);
  std::memset(buffer.data(), 7, buffer.size());
  buffer.release_all_but({{buffer.data(), buffer.size()}, {buffer.data() + 5, 10}});
  for (std::size_t i = 0; i < buffer.size(); i += 1000) ASSERT_EQ(buffer.data()[i], std::byte(7));
}

TEST(Memory, LimitIsWhatThereIsUntilItIsSet) {
  EXPECT_GT(memory_limit(), resident_memory());
  EXPECT_GE(available_memory(), resident_memory());
  const std::size_t limit = memory_limit();
  EXPECT_NO_THROW(require_memory(kMega, "a test"));
  EXPECT_THROW(require_memory(std::size_t(-1), "a test"), std::runtime_error);  // no overflow
  set_memory_limit(resident_memory() + 100 * kMega);
  EXPECT_NO_THROW(require_memory(50 * kMega, "a test"));
  EXPECT_THROW(require_memory(200 * kMega, "a test"), std::runtime_error);
  set_memory_limit(1);  // less than there is in use already
  EXPECT_THROW(require_memory(2 * kMega, "a test"), std::runtime_error);
  set_memory_limit(limit);
}

TEST(Memory, IsWrittenInDecimalUnits) {
  EXPECT_EQ(format_bytes(999), "999 B");
  EXPECT_EQ(format_bytes(1500), "1.5 kB");
  EXPECT_EQ(format_bytes(123.4e6), "123 MB");
  EXPECT_EQ(format_bytes(2.5e9), "2.5 GB");
  EXPECT_EQ(format_bytes(7e15), "7000 TB");
}

}  // namespace
}  // namespace parian

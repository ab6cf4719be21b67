#include "apps/command_line/sizes.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"

namespace parian {
namespace {

TEST(ParseBytes, TakesPowersOf1000And1024) {
  EXPECT_EQ(parse_bytes("--memory", "1"), 1u);
  EXPECT_EQ(parse_bytes("--memory", "17B"), 17u);
  EXPECT_EQ(parse_bytes("--memory", "800M"), 800'000'000u);
  EXPECT_EQ(parse_bytes("--memory", "3kB"), 3000u);
  EXPECT_EQ(parse_bytes("--memory", "16MiB"), 16u << 20);
  EXPECT_EQ(parse_bytes("--memory", "1.5gi"), 3u << 29);
  EXPECT_EQ(parse_bytes("--memory", "2T"), 2'000'000'000'000u);
  EXPECT_EQ(parse_bytes("--memory", ".5Ki"), 512u);
}

// Caught: what strtod takes (spaces, signs, nan, hexadecimal), rests, and numbers that overflow.
TEST(ParseBytes, RefusesAllElse) {
  for (const char* text : {"",
                           "M",
                           "-1",
                           "+1",
                           " 1",
                           "1 M",
                           "0",
                           "0.2",
                           "nan",
                           "inf",
                           "0x10",
                           "1e3",
                           "1Mi B",
                           "1X",
                           "1iB",
                           "1MM",
                           "1Bk",
                           "1,5G",
                           "9223372036854775808",
                           "9000000000T",
                           "1000000000000000000000000000000000000000G"}) {
    try {
      const std::size_t bytes = parse_bytes("--memory", text);
      ADD_FAILURE() << "'" << text << "' is " << bytes;
    } catch (const UsageError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(fmt::format("--memory {}: expected", text)));
    }
  }
}

}  // namespace
}  // namespace parian

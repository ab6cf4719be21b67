#include "apps/command_line/sizes.h"

#include <charconv>
#include <cmath>

#include "renderer/base/error.h"

namespace parian {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

/// What a suffix multiplies by; 0 if it is none.
double factor_of(std::string_view suffix) {
  const auto take = [&](char c) {
    const bool is_there = !suffix.empty() && lower(suffix.front()) == c;
    if (is_there) suffix.remove_prefix(1);
    return is_there;
  };
  int power = 0;
  for (const char c : {'k', 'm', 'g', 't'}) {
    ++power;
    if (!take(c)) continue;
    const double base = take('i') ? 1024 : 1000;
    take('b');
    return suffix.empty() ? std::pow(base, power) : 0;
  }
  take('b');
  return suffix.empty() ? 1 : 0;
}

}  // namespace

std::size_t parse_bytes(std::string_view option, std::string_view text) {
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number, std::chars_format::fixed);
  const double bytes = error == std::errc() ? std::floor(number * factor_of({rest, end})) : 0;
  if (!(bytes >= 1 && bytes < 0x1p63))
    throw UsageError(
        fmt::format("{} {}: expected a number of bytes above 0, such as 800M or 1.5GiB", option, text));
  return std::size_t(bytes);
}

}  // namespace parian

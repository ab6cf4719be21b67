/// What stops the program: bad input or bad usage, each one line for the user.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>

namespace parian {

/// Bad input (exit code 3): file, place inside it (a JSON path, or empty), and what was expected.
class InputError : public std::runtime_error {
 public:
  InputError(std::string_view file, std::string_view where, std::string_view expected)
      : std::runtime_error(where.empty() ? fmt::format("{}: {}", file, expected)
                                         : fmt::format("{}: {}: {}", file, where, expected)) {}
};

/// Bad usage (exit code 2): an option or name that does not exist, with what does.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace parian

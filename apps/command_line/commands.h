/// The subcommands of `parian`. Each adds itself to the command line and returns a program exit code when
/// run.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <functional>
#include <optional>

namespace parian {

// Exit codes.
inline constexpr int kDone = 0, kDiffers = 1, kBadUsage = 2, kBadInput = 3, kInterrupted = 4;

/// What to run for a parsed subcommand.
using Command = std::function<int()>;

/// A check that an option is a number from `low` to `high`; CLI::Range would let NaN through.
inline CLI::Validator number_between(double low, double high) {
  const auto check = [=](const std::string& text) {
    double value;
    if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return std::string();
    return fmt::format("expected a number from {} to {}, not {}", low, high, text);
  };
  return CLI::Validator(check, "");
}

/// The option that poses the scenes' animations.
inline void add_at_option(CLI::App& app, std::optional<double>& at) {
  app.add_option("--at", at,
                 "Pose of the scenes' animations at this time, in seconds; without it the pose of the files")
      ->check(number_between(0, 1e9))
      ->type_name("SECONDS");
}

Command add_render_command(CLI::App& app);
Command add_display_command(CLI::App& app);
Command add_info_command(CLI::App& app);
Command add_compare_command(CLI::App& app);
Command add_edit_command(CLI::App& app);

}  // namespace parian

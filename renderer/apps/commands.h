/// The subcommands of `parian`. Each adds itself to the command line and returns a program exit code when run.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace parian {

// Exit codes.
inline constexpr int kDone = 0, kBadUsage = 2, kBadInput = 3, kInterrupted = 4;

/// What to run for a parsed subcommand.
using Command = std::function<int()>;

Command add_render_command(CLI::App& app);
Command add_display_command(CLI::App& app);
Command add_info_command(CLI::App& app);

}  // namespace parian

/// The command line: parses, runs one subcommand, turns errors into one line and an exit code.
#include <fmt/format.h>

#include <utility>
#include <vector>

#include "apps/command_line/commands.h"
#include "renderer/base/error.h"

int main(int argc, char** argv) {
  using namespace parian;
  CLI::App app{"Parian, an offline path tracer for glTF 2.0 scenes", "parian"};
  app.set_version_flag("--version", PARIAN_VERSION);
  app.require_subcommand(1);
  std::vector<std::pair<CLI::App*, Command>> commands;
  for (auto add :
       {add_render_command, add_display_command, add_compare_command, add_info_command, add_edit_command}) {
    Command command = add(app);
    commands.emplace_back(app.get_subcommands({}).back(), std::move(command));
  }
  try {
    app.parse(argc, argv);
    for (const auto& [subcommand, run] : commands)
      if (*subcommand) return run();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
      fmt::print(stderr, "parian: no command \"{}\"; there are: render, display, compare, info, edit\n",
                 argv[1]);
      return kBadUsage;
    }
    fmt::print(stderr, "parian: {}\n", error.what());
    return kBadUsage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "parian: {}\n", error.what());
    return kBadUsage;
  } catch (const std::exception& error) {
    fmt::print(stderr, "parian: {}\n", error.what());
    return kBadInput;
  }
  return kBadUsage;
}

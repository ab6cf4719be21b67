/// `parian edit`: becomes parian-editor, which is a program of its own so that who only renders needs no Qt.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/command_line/commands.h"
#include "renderer/base/file.h"

namespace parian {
namespace {

int edit(const std::vector<std::string>& scenes) {
  const std::string editor = find_own_file("parian-editor", "parian-editor");
  std::vector<std::string> arguments{editor};
  arguments.insert(arguments.end(), scenes.begin(), scenes.end());
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  execv(editor.c_str(), pointers.data());
  throw std::runtime_error(fmt::format("{} cannot be started: {}", editor, std::strerror(errno)));
}

}  // namespace

Command add_edit_command(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("edit", "Open scenes in a window, to be edited and seen at once");
  const auto scenes = std::make_shared<std::vector<std::string>>();
  c.add_option("SCENE", *scenes, ".gltf or .glb files; several are composed into one scene");
  return [scenes] { return edit(*scenes); };
}

}  // namespace parian

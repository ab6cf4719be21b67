/// parian-editor: the command line, and the window.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <QApplication>

#include <exception>

#include "apps/editor/autosave.h"
#include "apps/editor/main_window.h"

int main(int argc, char** argv) {
  using namespace parian::editor;
  CLI::App options{"Parian's editor: move, add, remove and re-material, and see it", "parian-editor"};
  std::vector<std::string> scenes;
  int autosave = 30;
  options.add_option("SCENE", scenes, ".gltf or .glb files; several are composed into one scene");
  options.add_option("--autosave", autosave, "Seconds between copies of an unsaved scene [30]")
      ->check(CLI::Range(1, 86400));
  options.set_version_flag("--version", PARIAN_VERSION);
  try {
    options.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return options.exit(error);
    fmt::print(stderr, "parian-editor: {}\n", error.what());
    return 2;
  }
  QApplication application(argc, argv);
  QApplication::setApplicationName("parian");
  QApplication::setOrganizationName("parian");
  try {
    MainWindow window;
    window.show();
    window.offer_backup();
    QStringList paths;
    for (const std::string& scene : scenes) paths << QString::fromStdString(scene);
    if (!paths.isEmpty() && !window.document().is_modified()) window.open(paths);
    const Autosave copies(window.document(), MainWindow::backup_folder(), autosave * 1000);
    return QApplication::exec();
  } catch (const std::exception& error) {
    fmt::print(stderr, "parian-editor: {}\n", error.what());
    return 3;
  }
}

/// The file menu of the window.
#include <QFileDialog>
#include <QFileInfo>
#include <QMenuBar>
#include <QMessageBox>
#include <QSettings>
#include <QStandardPaths>

#include <exception>

#include "apps/editor/autosave.h"
#include "apps/editor/main_window.h"
#include "apps/editor/render_dialog.h"

namespace parian::editor {
namespace {

constexpr int kRecent = 10;

}  // namespace

void MainWindow::make_file_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&File"));
  add_action(menu, tr("&New"), QKeySequence::New, [this] {
    if (may_lose_changes()) document_.clear();
  });
  add_action(menu, tr("&Open ..."), QKeySequence::Open, [this] {
    if (!may_lose_changes()) return;
    const QString path = QFileDialog::getOpenFileName(this, tr("Open"), {}, tr("glTF (*.gltf *.glb)"));
    if (!path.isEmpty()) open({path});
  });
  recent_ = menu->addMenu(tr("Open &recent"));
  show_recent();
  menu->addSeparator();
  add_action(menu, tr("&Save"), QKeySequence::Save, [this] { save(); });
  add_action(menu, tr("Save &as ..."), QKeySequence::SaveAs, [this] { save_as(); });
  menu->addSeparator();
  add_action(menu, tr("&Render ..."), Qt::Key_F12, [this] { render(); });
  menu->addSeparator();
  add_action(menu, tr("&Quit"), QKeySequence::Quit, [this] { close(); });
}

bool MainWindow::open(const QStringList& paths) {
  try {
    document_.load(paths);
  } catch (const std::exception& error) {
    complain(QString::fromUtf8(error.what()));
    return false;
  }
  remember(document_.path());
  show_all();
  return true;
}

void MainWindow::show_all() {
  const Scene& scene = document_.scene();
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].camera != kNone) {
      viewport_->look_through(int(i));
      return;
    }
  viewport_->frame_selection();
}

void MainWindow::remember(const QString& path) {
  QSettings settings;
  QStringList files = settings.value("recent").toStringList();
  const QString whole = QFileInfo(path).absoluteFilePath();
  files.removeAll(whole);
  files.prepend(whole);
  settings.setValue("recent", QStringList(files.mid(0, kRecent)));
  show_recent();
}

void MainWindow::show_recent() {
  recent_->clear();
  for (const QString& path : QSettings().value("recent").toStringList())
    add_action(recent_, path, {}, [this, path] {
      if (may_lose_changes()) open({path});
    });
  recent_->setEnabled(!recent_->isEmpty());
}

bool MainWindow::may_lose_changes() {
  document_.finish_drag();
  if (!document_.is_modified()) return true;
  const auto choice =
      QMessageBox::warning(this, tr("Unsaved changes"), tr("The scene has changes that are not saved."),
                           QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel);
  return choice == QMessageBox::Discard || (choice == QMessageBox::Save && save());
}

bool MainWindow::save() {
  if (document_.path().isEmpty()) return save_as();
  try {
    document_.save(document_.path());
  } catch (const std::exception& error) {
    complain(QString::fromUtf8(error.what()));
    return false;
  }
  remember(document_.path());
  return true;
}

bool MainWindow::save_as() {
  QString path =
      QFileDialog::getSaveFileName(this, tr("Save as"), document_.path(), tr("glTF (*.glb *.gltf)"));
  if (path.isEmpty()) return false;
  if (QFileInfo(path).suffix().isEmpty()) path += ".glb";
  try {
    document_.save(path);
  } catch (const std::exception& error) {
    complain(QString::fromUtf8(error.what()));
    return false;
  }
  remember(path);
  return true;
}

void MainWindow::import() {
  const QString path = QFileDialog::getOpenFileName(this, tr("Add a model"), {}, tr("glTF (*.gltf *.glb)"));
  if (path.isEmpty()) return;
  try {
    document_.import_model(path);
  } catch (const std::exception& error) {
    complain(QString::fromUtf8(error.what()));
  }
}

void MainWindow::render() {
  document_.finish_drag();
  RenderDialog dialog(document_.share(), viewport_->view(), views_->currentText(), float(exposure_->value()),
                      this);
  viewport_->render().set_paused(true);  // the render has the machine
  dialog.exec();
  viewport_->render().set_paused(false);
}

QString MainWindow::backup_folder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) + "/autosave";
}

void MainWindow::offer_backup() {
  const std::optional<Backup> backup = Autosave::find(backup_folder());
  if (!backup) return;
  const QString what = backup->original.isEmpty() ? tr("a scene that was never saved") : backup->original;
  const auto choice = QMessageBox::question(this, tr("Recover"),
                                            tr("Parian did not end as it should. Recover %1?").arg(what));
  if (choice == QMessageBox::Yes) {
    try {
      document_.adopt_backup(backup->file, backup->original);
      show_all();
    } catch (const std::exception& error) {
      return complain(QString::fromUtf8(error.what()));  // the copy stays
    }
  }
  Autosave::remove(*backup);
}

}  // namespace parian::editor

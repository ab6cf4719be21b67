/// The window: viewport, panels, menus, files.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>

#include "apps/editor/document.h"
#include "apps/editor/viewport.h"

namespace parian::editor {

class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  MainWindow();
  /// The panels go before the document that they follow.
  ~MainWindow() override;

  Document& document() { return document_; }
  Viewport& viewport() { return *viewport_; }
  /// Loads files, told on a status line where they cannot be. Returns whether they were.
  bool open(const QStringList& paths);
  /// Offers what a program that crashed left in the folder of autosaves.
  void offer_backup();
  static QString backup_folder();

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void make_panels();
  void make_file_menu();
  void make_edit_menu();
  void make_add_menu();
  void make_view_menu();
  void make_toolbar();
  QAction* add_action(QMenu* menu, const QString& text, const QKeySequence& keys,
                      const std::function<void()>& what);

  // Files. False where the user would rather not, or it could not be.
  bool may_lose_changes();
  bool save();
  bool save_as();
  void import();
  void render();
  /// Looks through the scene's first camera, or at all of it.
  void show_all();
  void remember(const QString& path);
  void show_recent();
  void show_title();
  void complain(const QString& reason);

  // Edits of what is selected.
  void with_nodes(const QString& name, const std::function<void(Scene&, const std::vector<int>&)>& command);
  void remove_selected();
  void duplicate_selected();
  void group_selected();
  void ungroup_selected();
  void align_camera();

  // Additions, at what the viewport looks at.
  void add(const QString& name, const std::function<int(Scene&)>& command);
  void add_camera();
  void add_environment();

  Document document_;
  Viewport* viewport_;
  QMenu* recent_ = nullptr;
  QComboBox* views_ = nullptr;
  QDoubleSpinBox* exposure_ = nullptr;
  QLabel* status_ = nullptr;
};

}  // namespace parian::editor

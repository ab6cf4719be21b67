#include "apps/editor/main_window.h"

#include <QActionGroup>
#include <QCloseEvent>
#include <QDockWidget>
#include <QFileInfo>
#include <QMenuBar>
#include <QMimeData>
#include <QSettings>
#include <QStatusBar>
#include <QToolBar>
#include <QUrl>

#include <exception>

#include "apps/editor/inspector.h"
#include "apps/editor/outliner.h"
#include "renderer/color/display.h"

namespace parian::editor {

MainWindow::MainWindow() : viewport_(new Viewport(document_, this)) {
  setCentralWidget(viewport_);
  setAcceptDrops(true);
  resize(1280, 760);
  make_panels();
  make_file_menu();
  make_edit_menu();
  make_add_menu();
  make_view_menu();
  make_toolbar();
  connect(&document_, &Document::refused, this, &MainWindow::complain);
  connect(&document_, &Document::path_changed, this, &MainWindow::show_title);
  connect(&document_.history(), &QUndoStack::cleanChanged, this, &MainWindow::show_title);
  const QSettings settings;
  restoreGeometry(settings.value("window/geometry").toByteArray());
  restoreState(settings.value("window/state").toByteArray());
  document_.clear();
  show_title();
}

MainWindow::~MainWindow() {
  document_.history().disconnect(this);
  document_.disconnect(this);
  delete takeCentralWidget();
  qDeleteAll(findChildren<QDockWidget*>());
}

void MainWindow::make_panels() {
  const auto dock = [this](const QString& title, const char* name, QWidget* panel, Qt::DockWidgetArea area) {
    auto* widget = new QDockWidget(title, this);
    widget->setObjectName(name);
    widget->setWidget(panel);
    addDockWidget(area, widget);
  };
  dock(tr("Scene"), "scene", new Outliner(document_, this), Qt::LeftDockWidgetArea);
  dock(tr("Properties"), "properties", new Inspector(document_, this), Qt::RightDockWidgetArea);
  status_ = new QLabel(this);
  statusBar()->addPermanentWidget(status_);
  connect(viewport_, &Viewport::status_changed, status_, &QLabel::setText);
}

QAction* MainWindow::add_action(QMenu* menu, const QString& text, const QKeySequence& keys,
                                const std::function<void()>& what) {
  QAction* action = menu->addAction(text);
  action->setShortcut(keys);
  connect(action, &QAction::triggered, this, what);
  return action;
}

void MainWindow::make_view_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&View"));
  add_action(menu, tr("Frame selection"), Qt::Key_F, [this] { viewport_->frame_selection(); });
  add_action(menu, tr("Look through selected camera"), Qt::Key_C, [this] {
    if (document_.selection().kind == Selection::Kind::nodes)
      viewport_->look_through(document_.selection().active());
  });
  add_action(menu, tr("Align camera to view"), Qt::CTRL | Qt::ALT | Qt::Key_C, [this] { align_camera(); });
  add_action(menu, tr("Focus on what is clicked next"), Qt::SHIFT | Qt::Key_F, [this] {
    viewport_->begin_focus();
    statusBar()->showMessage(tr("Click what is to be sharp; Escape leaves it"), 5000);
  });
  menu->addSeparator();
  const auto toggle = [&](const QString& text, const QKeySequence& keys,
                          const std::function<void(bool)>& what) {
    QAction* action = menu->addAction(text);
    action->setCheckable(true);
    action->setShortcut(keys);
    connect(action, &QAction::toggled, this, what);
  };
  toggle(tr("Local axes"), Qt::Key_L, [this](bool on) { viewport_->set_local_axes(on); });
  toggle(tr("Snap to steps"), Qt::SHIFT | Qt::Key_S, [this](bool on) { viewport_->set_snapping(on); });
  toggle(tr("Pause rendering"), Qt::Key_Pause, [this](bool on) { viewport_->render().set_paused(on); });
  menu->addSeparator();
  for (QDockWidget* dock : findChildren<QDockWidget*>()) menu->addAction(dock->toggleViewAction());
}

void MainWindow::make_toolbar() {
  QToolBar* bar = addToolBar(tr("Tools"));
  bar->setObjectName("tools");
  auto* modes = new QActionGroup(this);
  const auto mode = [&](const QString& text, const QKeySequence& keys, GizmoMode gizmo) {
    QAction* action = modes->addAction(text);
    action->setCheckable(true);
    action->setChecked(gizmo == viewport_->gizmo_mode());
    action->setShortcut(keys);
    action->setToolTip(QString("%1 (%2)").arg(text, keys.toString()));
    connect(action, &QAction::triggered, this, [this, gizmo] { viewport_->set_gizmo_mode(gizmo); });
    bar->addAction(action);
  };
  mode(tr("Move"), Qt::Key_W, GizmoMode::translate);
  mode(tr("Rotate"), Qt::Key_E, GizmoMode::rotate);
  mode(tr("Scale"), Qt::Key_R, GizmoMode::scale);
  bar->addSeparator();
  bar->addWidget(new QLabel(tr(" View "), bar));
  views_ = new QComboBox(bar);
  views_->setObjectName("views");
  try {
    for (const std::string& view : display_views()) views_->addItem(QString::fromStdString(view));
  } catch (const std::exception& error) {
    complain(QString::fromUtf8(error.what()));
  }
  bar->addWidget(views_);
  bar->addWidget(new QLabel(tr(" Exposure "), bar));
  exposure_ = new QDoubleSpinBox(bar);
  exposure_->setRange(-20, 20);
  exposure_->setSingleStep(0.25);
  exposure_->setSuffix(tr(" stops"));
  bar->addWidget(exposure_);
  const auto show = [this] {
    viewport_->render().set_display(views_->currentText().toStdString(), float(exposure_->value()));
  };
  connect(views_, &QComboBox::currentTextChanged, this, show);
  connect(exposure_, &QDoubleSpinBox::valueChanged, this, show);
}

void MainWindow::complain(const QString& reason) { statusBar()->showMessage(reason, 10000); }

void MainWindow::show_title() {
  const QString file = document_.path().isEmpty() ? tr("unnamed") : QFileInfo(document_.path()).fileName();
  setWindowTitle(QString("%1[*] - Parian").arg(file));
  setWindowModified(document_.is_modified());
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) event->acceptProposedAction();
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    try {
      document_.import_model(url.toLocalFile());
    } catch (const std::exception& error) {
      complain(QString::fromUtf8(error.what()));
    }
  }
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (!may_lose_changes()) return event->ignore();
  QSettings settings;
  settings.setValue("window/geometry", saveGeometry());
  settings.setValue("window/state", saveState());
  event->accept();
}

}  // namespace parian::editor

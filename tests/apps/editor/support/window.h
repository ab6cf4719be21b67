/// The whole window, with the Cornell box as a file that may be written over.
#pragma once

#include <QAbstractButton>
#include <QApplication>
#include <QMessageBox>
#include <QStatusBar>
#include <QTimer>

#include "apps/editor/main_window.h"
#include "tests/apps/editor/support/editor_test.h"
#include "tests/apps/editor/support/widgets.h"

namespace parian::editor {

/// Answers the next question of a QMessageBox, which blocks whoever asks it.
class Answer {
 public:
  explicit Answer(QMessageBox::StandardButton button) {
    timer_.callOnTimeout([this, button] {
      auto* box = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
      if (!box || !box->button(button)) return;
      text_ = box->text();
      timer_.stop();
      box->button(button)->click();
    });
    timer_.start(5);
  }
  bool was_asked() const { return !text_.isEmpty(); }
  const QString& text() const { return text_; }

 private:
  QTimer timer_;
  QString text_;
};

class WindowTest : public EditorTest {
 protected:
  WindowTest() : file_(copy_scene("cornell-box")) {
    window_.resize(900, 480);
    EXPECT_TRUE(window_.open({file_}));
    window_.show();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&window_));
  }
  Document& document() { return window_.document(); }
  const Scene& scene() { return window_.document().scene(); }
  std::vector<int> selected() { return document().selection().indices; }
  int steps() { return document().history().count(); }
  QString message() { return window_.statusBar()->currentMessage(); }
  void hide_floor() {
    document().edit("Hide", [](Scene& s) { s.nodes[0].visible = !s.nodes[0].visible; });
  }
  static Scene load(const QString& path) {
    Document document;
    document.load({path});
    return document.scene();
  }

  QString file_;
  MainWindow window_;
};

}  // namespace parian::editor

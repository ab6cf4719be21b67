#include "apps/editor/render_dialog.h"

#include <QDir>
#include <QFile>

#include "apps/editor/document.h"
#include "images/image_io.h"
#include "tests/apps/editor/support/editor_test.h"
#include "tests/apps/editor/support/widgets.h"

namespace parian::editor {
namespace {

class RenderDialogTest : public EditorTest {
 protected:
  RenderDialogTest() {
    Document document;
    document.load({scene_file("cornell-box")});
    view_.target = {0, 0.3f, 0};
    dialog_ = std::make_unique<RenderDialog>(document.share(), view_, "sRGB", 0.0f);
    dialog_->show();
    EXPECT_TRUE(QTest::qWaitForWindowActive(dialog_.get()));
    enter(40, 30, 4);
    line("exr")->setText(path("a.exr"));
    line("png")->setText(path("a.png"));
  }
  QLineEdit* line(const char* name) const { return dialog_->findChild<QLineEdit*>(name); }
  QString text() const { return dialog_->findChild<QLabel*>("text")->text(); }
  void enter(int width, int height, int samples) {
    const auto boxes = dialog_->findChildren<QSpinBox*>();
    ASSERT_EQ(boxes.size(), 3);
    for (int i = 0; i < 3; ++i) boxes[i]->setValue(i == 0 ? width : i == 1 ? height : samples);
  }
  void press(const QString& text) {
    for (auto* button : dialog_->findChildren<QPushButton*>())
      if (button->text() == text) return QTest::mouseClick(button, Qt::LeftButton);
    FAIL() << text.toStdString();
  }
  bool ends() {
    return wait_for([this] { return !dialog_->is_rendering(); });
  }
  bool has_samples() {
    return wait_for([this] { return text().section(' ', 0, 0).toInt() > 0; });
  }
  static double mean(const Picture& picture) {
    double sum = 0;
    for (int y = 0; y < picture.height; ++y)
      for (int x = 0; x < picture.width; ++x) sum += double(picture.at(x, y)[1]);
    return sum / (picture.width * picture.height);
  }

  ViewCamera view_;
  std::unique_ptr<RenderDialog> dialog_;
};

TEST_F(RenderDialogTest, WritesBothFiles) {
  press("Render");
  EXPECT_TRUE(dialog_->is_rendering());
  ASSERT_TRUE(ends());
  EXPECT_TRUE(text().startsWith("written: ")) << text().toStdString();
  for (const char* name : {"a.exr", "a.png"}) {
    const Picture picture = read_picture(path(name).toStdString());
    EXPECT_EQ(picture.width, 40) << name;
    EXPECT_EQ(picture.height, 30) << name;
    EXPECT_GT(mean(picture), 0.05) << name;
  }
  // As the viewport sees it: from elsewhere.
  const double before = mean(read_picture(path("a.exr").toStdString()));
  dialog_->findChild<QComboBox*>()->setCurrentIndex(0);
  line("png")->clear();
  line("exr")->setText(path("b.exr"));
  press("Render");
  ASSERT_TRUE(ends());
  EXPECT_EQ(text(), "written: " + path("b.exr"));
  EXPECT_GT(std::abs(mean(read_picture(path("b.exr").toStdString())) - before), 0.005);
}

TEST_F(RenderDialogTest, StopsAndWritesWhatThereIs) {
  enter(40, 30, 1 << 24);
  press("Render");
  ASSERT_TRUE(has_samples());
  press("Stop");
  ASSERT_TRUE(ends());
  EXPECT_TRUE(text().startsWith("stopped; written: ")) << text().toStdString();
  EXPECT_GT(mean(read_picture(path("a.exr").toStdString())), 0.05);
  EXPECT_GT(mean(read_picture(path("a.png").toStdString())), 0.05);
}

// Nor is a picture of before written over by one that is black.
TEST_F(RenderDialogTest, WritesNothingWhereThereIsNothing) {
  enter(1500, 1500, 1 << 20);
  press("Render");
  press("Stop");
  ASSERT_TRUE(ends());
  EXPECT_TRUE(text().contains("nothing is written")) << text().toStdString();
  EXPECT_FALSE(QFile::exists(path("a.exr")));
  EXPECT_FALSE(QFile::exists(path("a.png")));
}

TEST_F(RenderDialogTest, RefusesInPlace) {
  const auto refuses = [&](const QString& exr, const QString& png, const QString& why) {
    line("exr")->setText(exr);
    line("png")->setText(png);
    press("Render");
    EXPECT_FALSE(dialog_->is_rendering()) << text().toStdString();
    EXPECT_TRUE(text().contains(why)) << text().toStdString();
    EXPECT_TRUE(dialog_->isVisible());
    ends();
  };
  refuses(path("no/such/a.exr"), "", "expected a folder");
  refuses("", path("no/such/a.png"), "expected a folder");
  refuses(path("a.png"), "", "expected a name that ends in .exr");
  refuses("", path("a.exr"), "expected a name that ends in .png");
  refuses("", "", "expected the name of a file");
}

// A folder that takes no files is found when they are written.
TEST_F(RenderDialogTest, SaysWhatCannotBeWritten) {
  QDir(folder_.path()).mkpath("b.exr");  // a folder of that name
  line("exr")->setText(path("b.exr"));
  press("Render");
  ASSERT_TRUE(ends());
  EXPECT_TRUE(text().contains("b.exr")) << text().toStdString();
  EXPECT_FALSE(text().startsWith("written")) << text().toStdString();
}

TEST_F(RenderDialogTest, ClosingEndsIt) {
  enter(40, 30, 1 << 24);
  press("Render");
  ASSERT_TRUE(has_samples());
  QTest::keyClick(dialog_.get(), Qt::Key_Escape);
  EXPECT_FALSE(dialog_->isVisible());
  EXPECT_TRUE(ends());
  EXPECT_GT(mean(read_picture(path("a.exr").toStdString())), 0.05);
  // Also without a word, as when the window goes.
  dialog_->show();
  press("Render");
  ASSERT_TRUE(has_samples());
  dialog_.reset();
}

}  // namespace
}  // namespace parian::editor

/// Files, titles, questions; and what the tool bar shows.
#include <QComboBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QMimeData>
#include <QProcess>
#include <QUrl>

#include "editing/add.h"
#include "renderer/base/file.h"
#include "tests/apps/editor/support/viewport.h"
#include "tests/apps/editor/support/window.h"

namespace parian::editor {
namespace {

TEST_F(WindowTest, SavesAndMarksWhatIsUnsaved) {
  EXPECT_EQ(window_.windowTitle(), "cornell-box.gltf[*] - Parian");
  EXPECT_FALSE(window_.isWindowModified());
  hide_floor();
  EXPECT_TRUE(window_.isWindowModified());
  trigger(window_, "Save");
  EXPECT_FALSE(window_.isWindowModified());
  EXPECT_EQ(load(file_), scene());
  document().history().undo();
  EXPECT_TRUE(window_.isWindowModified()) << "the file is another now";
  document().save(path("other.glb"));
  EXPECT_EQ(window_.windowTitle(), "other.glb[*] - Parian");
  EXPECT_FALSE(window_.isWindowModified());
  hide_floor();
  trigger(window_, "Save");
  EXPECT_FALSE(load(path("other.glb")).nodes[0].visible);
  EXPECT_FALSE(load(file_).nodes[0].visible);
}

TEST_F(WindowTest, SaysWhatCannotBeSaved) {
  QDir(folder_.path()).mkpath("gone");
  document().save(path("gone/scene.glb"));
  QDir(path("gone")).removeRecursively();
  hide_floor();
  const Scene before = scene();
  trigger(window_, "Save");
  EXPECT_TRUE(message().contains("gone/scene.glb")) << message().toStdString();
  EXPECT_EQ(scene(), before);
  EXPECT_TRUE(window_.isWindowModified());
  EXPECT_TRUE(document().history().canUndo());
}

TEST_F(WindowTest, SaysWhatDoesNotLoad) {
  write_file(path("broken.glb").toStdString(), "glTF");
  hide_floor();
  const Scene before = scene();
  for (const char* name : {"broken.glb", "nowhere.gltf"}) {
    window_.statusBar()->clearMessage();
    EXPECT_FALSE(window_.open({path(name)}));
    EXPECT_TRUE(message().contains(name)) << message().toStdString();
    window_.statusBar()->clearMessage();
    QMimeData dropped;
    dropped.setUrls({QUrl::fromLocalFile(path(name))});
    QDragEnterEvent enter(QPoint(5, 5), Qt::CopyAction, &dropped, Qt::LeftButton, {});
    QCoreApplication::sendEvent(&window_, &enter);
    QDropEvent event(QPointF(5, 5), Qt::CopyAction, &dropped, Qt::LeftButton, {});
    QCoreApplication::sendEvent(&window_, &event);
    EXPECT_TRUE(message().contains(name)) << message().toStdString();
    EXPECT_EQ(scene(), before);
    EXPECT_EQ(document().path(), file_);
    EXPECT_EQ(steps(), 1);
  }
}

TEST_F(WindowTest, RemembersFiles) {
  ASSERT_TRUE(window_.open({scene_file("lights")}));
  const auto recent = [this] {
    QStringList files;
    for (const QAction* action : find_action(window_, "Open recent")->menu()->actions())
      files << action->text();
    return files;
  };
  EXPECT_EQ(recent(), QStringList({scene_file("lights"), file_}));
  trigger(window_, file_);
  EXPECT_EQ(document().path(), file_);
  EXPECT_EQ(recent(), QStringList({file_, scene_file("lights")}));
}

TEST_F(WindowTest, AsksBeforeChangesAreLost) {
  hide_floor();
  const Scene before = scene();
  {
    Answer cancel(QMessageBox::Cancel);
    window_.close();
    EXPECT_TRUE(cancel.was_asked());
    EXPECT_TRUE(window_.isVisible());
  }
  {
    Answer cancel(QMessageBox::Cancel);
    trigger(window_, "New");
    EXPECT_TRUE(cancel.was_asked());
    EXPECT_EQ(scene(), before);
  }
  {
    Answer save(QMessageBox::Save);
    trigger(window_, "New");
    EXPECT_TRUE(save.was_asked());
    EXPECT_TRUE(scene().nodes.empty());
    EXPECT_EQ(load(file_), before);
  }
  document().edit("Add", [](Scene& s) { edit::add_group(s, "group"); });
  Answer discard(QMessageBox::Discard);
  window_.close();
  EXPECT_TRUE(discard.was_asked());
  EXPECT_FALSE(window_.isVisible());
}

TEST_F(WindowTest, ClosesWithoutAQuestionWhereAllIsSaved) {
  Answer cancel(QMessageBox::Cancel);
  window_.close();
  EXPECT_FALSE(cancel.was_asked());
  EXPECT_FALSE(window_.isVisible());
}

class BackupTest : public WindowTest {
 protected:
  BackupTest() {
    QDir().mkpath(MainWindow::backup_folder());
    hide_floor();
    edited_ = scene();
    copy_ = QDir(MainWindow::backup_folder()).filePath("1.glb");
    document().writer()(copy_);
    QProcess process;  // of which nothing is left but its number
    process.start("true", QStringList());
    const qint64 number = process.processId();
    process.waitForFinished();
    write_file((copy_ + ".json").toStdString(),
               QString(R"({"original": "%1", "process": %2})").arg(file_).arg(number).toStdString());
    document().clear();
  }
  Scene edited_;
  QString copy_;
};

TEST_F(BackupTest, IsRecovered) {
  Answer yes(QMessageBox::Yes);
  window_.offer_backup();
  EXPECT_TRUE(yes.text().contains(file_)) << yes.text().toStdString();
  EXPECT_EQ(scene(), edited_);
  EXPECT_TRUE(window_.isWindowModified());
  EXPECT_EQ(document().path(), file_);
  EXPECT_FALSE(QFile::exists(copy_));
  trigger(window_, "Save");
  EXPECT_EQ(load(file_), edited_);
  EXPECT_FALSE(window_.isWindowModified());
  Answer no(QMessageBox::No);
  window_.offer_backup();
  EXPECT_FALSE(no.was_asked()) << "once";
}

TEST_F(BackupTest, IsRefused) {
  Answer no(QMessageBox::No);
  window_.offer_backup();
  EXPECT_TRUE(no.was_asked());
  EXPECT_TRUE(scene().nodes.empty());
  EXPECT_FALSE(QFile::exists(copy_));
}

TEST_F(BackupTest, StaysWhereItCannotBeRead) {
  write_file(copy_.toStdString(), "glTF");
  Answer yes(QMessageBox::Yes);
  window_.offer_backup();
  EXPECT_TRUE(message().contains("1.glb")) << message().toStdString();
  EXPECT_TRUE(scene().nodes.empty());
  EXPECT_TRUE(QFile::exists(copy_));
}

TEST_F(WindowTest, ExposureAndViewChangeThePicture) {
  const auto brightness = [this] {
    const QImage shown = window_.viewport().grab().toImage();
    return mean_of(shown, shown.rect());
  };
  // With few samples what is bright is cut off, and the picture darker than it will be.
  ASSERT_TRUE(wait_for([&] { return window_.viewport().render().status().samples >= 32; }));
  ASSERT_TRUE(wait_for([&] { return brightness() > 20; }));
  const double before = brightness();
  auto* exposure = window_.findChild<QDoubleSpinBox*>();
  exposure->setValue(-3);
  EXPECT_TRUE(wait_for([&] { return brightness() < 0.6 * before; }));
  exposure->setValue(0);
  EXPECT_TRUE(wait_for([&] { return std::abs(brightness() - before) < 0.1 * before; }));
  auto* views = window_.findChild<QComboBox*>("views");
  ASSERT_GT(views->count(), 1);
  views->setFocus();
  QTest::keyClick(views, Qt::Key_Down);
  EXPECT_TRUE(wait_for([&] { return std::abs(brightness() - before) > 0.15 * before; }));
}

}  // namespace
}  // namespace parian::editor

#include "apps/editor/document.h"

#include <QFile>
#include <QSignalSpy>

#include "apps/editor/autosave.h"
#include "editing/add.h"
#include "editing/nodes.h"
#include "renderer/session/session.h"
#include "tests/apps/editor/support/editor_test.h"

namespace parian::editor {
namespace {

class DocumentTest : public EditorTest {
 protected:
  DocumentTest() { document_.clear(); }
  int add_sphere() {
    int node = kNone;
    document_.edit("Add", [&](Scene& s) { node = edit::add_shape(s, edit::sphere(1)); });
    return node;
  }
  QString move(float x) {
    return document_.drag("Move", [x](Scene& s) { edit::set_transform(s, 0, {Vec3f(x, 0, 0), {}, {}}); });
  }
  float place() const { return document_.scene().nodes[0].transform.translation.x; }

  Document document_;
};

TEST_F(DocumentTest, UndoesAndRedoes) {
  const Scene empty = document_.scene();
  QSignalSpy changes(&document_, &Document::scene_changed);
  add_sphere();
  const Scene one = document_.scene();
  EXPECT_EQ(changes.count(), 1);
  EXPECT_TRUE(changes[0][0].toUInt() & kChangedGeometry);
  EXPECT_TRUE(document_.is_modified());
  document_.history().undo();
  EXPECT_EQ(document_.scene(), empty);
  EXPECT_FALSE(document_.is_modified());
  document_.history().redo();
  EXPECT_EQ(document_.scene(), one);
}

TEST_F(DocumentTest, RefusesAndSaysWhy) {
  const Scene before = document_.scene();
  QSignalSpy refusals(&document_, &Document::refused);
  const QString reason = document_.edit("Move", [](Scene& s) { edit::set_visible(s, 7, false); });
  EXPECT_TRUE(reason.contains("node")) << reason.toStdString();
  EXPECT_EQ(refusals.count(), 1);
  EXPECT_EQ(document_.scene(), before);
  EXPECT_EQ(document_.history().count(), 0);
  document_.edit("Nothing", [](Scene&) {});
  EXPECT_EQ(document_.history().count(), 0) << "what changes nothing is no step";
}

// Many positions of the hand are one step.
TEST_F(DocumentTest, ADragIsOneStep) {
  add_sphere();
  for (const float x : {1.0f, 2.0f, 3.0f}) EXPECT_EQ(move(x), "");
  EXPECT_EQ(place(), 3);
  EXPECT_EQ(document_.history().count(), 1) << "still in the hand";
  document_.finish_drag();
  EXPECT_EQ(document_.history().count(), 2);
  document_.history().undo();
  EXPECT_EQ(place(), 0);
  document_.history().redo();
  EXPECT_EQ(place(), 3);
  move(5);
  document_.drop_drag();
  EXPECT_EQ(place(), 3);
  EXPECT_EQ(document_.history().count(), 2);
  move(6);
  add_sphere();
  EXPECT_EQ(document_.history().count(), 4) << "an edit finishes the drag";
}

TEST_F(DocumentTest, SelectsOnlyWhatIsThere) {
  add_sphere();
  const int second = add_sphere();
  document_.select_node(0);
  document_.select_node(second, true);
  EXPECT_EQ(document_.selection().indices, (std::vector<int>{0, second}));
  document_.select_node(0, true);
  EXPECT_EQ(document_.selection().indices, std::vector<int>{second}) << "a second click takes it out";
  document_.history().undo();
  EXPECT_EQ(document_.selection(), Selection()) << "it is gone";
}

// Caught: a selection that nothing checks after an edit.
TEST_F(DocumentTest, AnEditTakesWhatItRemovesOutOfTheSelection) {
  add_sphere();
  const int second = add_sphere();
  const std::vector<int> both{0, second}, left{0};
  document_.select_node(0);
  document_.select_node(second, true);
  document_.edit("Remove", [&](Scene& s) { edit::remove(s, second); });
  EXPECT_EQ(document_.selection().indices, left);
  document_.history().undo();
  EXPECT_EQ(document_.selection().indices, both);
  document_.history().redo();
  EXPECT_EQ(document_.selection().indices, left);
}

TEST_F(DocumentTest, SavesAndLoads) {
  document_.load({scene_file("cornell-box")});
  EXPECT_FALSE(document_.is_modified());
  document_.edit("Hide", [](Scene& s) { edit::set_visible(s, 0, false); });
  const Scene edited = document_.scene();
  for (const char* name : {"saved.glb", "saved.gltf"}) {
    document_.save(path(name));
    EXPECT_FALSE(document_.is_modified());
    EXPECT_EQ(document_.path(), path(name));
    Document again;
    again.load({path(name)});
    EXPECT_EQ(again.scene(), edited) << name;
  }
}

TEST_F(DocumentTest, AModelThatDoesNotLoadLeavesTheSceneAsItWas) {
  document_.load({scene_file("cornell-box")});
  const Scene before = document_.scene();
  QFile broken(path("broken.glb"));
  ASSERT_TRUE(broken.open(QIODevice::WriteOnly));
  broken.write("glTF");
  broken.close();
  EXPECT_THROW(document_.load({path("broken.glb")}), std::exception);
  EXPECT_THROW(document_.import_model(path("broken.glb")), std::exception);
  EXPECT_THROW(document_.import_model(path("nowhere.glb")), std::exception);
  EXPECT_THROW(document_.save(path("no/such/folder.glb")), std::exception);
  EXPECT_EQ(document_.scene(), before);
  EXPECT_EQ(document_.path(), scene_file("cornell-box"));
  EXPECT_EQ(document_.history().count(), 0);
}

// What comes from two files is saved, also after the import was undone and done again.
TEST_F(DocumentTest, ImportsAModel) {
  document_.load({scene_file("cornell-box")});
  const Scene before = document_.scene();
  document_.import_model(scene_file("shapes-furnace"));
  EXPECT_EQ(document_.selection().kind, Selection::Kind::nodes);
  EXPECT_GT(document_.scene().nodes.size(), before.nodes.size());
  const Scene both = document_.scene();
  document_.history().undo();
  EXPECT_EQ(document_.scene(), before);
  document_.history().redo();
  EXPECT_EQ(document_.scene(), both);
  document_.save(path("both.glb"));
  Document again;
  again.load({path("both.glb")});
  EXPECT_EQ(again.scene().nodes.size(), both.nodes.size());
}

TEST_F(DocumentTest, AutosavesWhatIsUnsaved) {
  const QString folder = path("autosave");
  {
    Autosave copies(document_, folder, 1000000);
    copies.write_now();
    EXPECT_TRUE(QDir(folder).entryList({"*.glb"}).isEmpty()) << "nothing is unsaved";
    add_sphere();
    copies.write_now();
    ASSERT_EQ(QDir(folder).entryList({"*.glb"}).size(), 1);
    EXPECT_FALSE(Autosave::find(folder)) << "this program is still there";
    Document copy;
    copy.load({QDir(folder).entryInfoList({"*.glb"}).front().filePath()});
    EXPECT_EQ(copy.scene().nodes.size(), 1u);
    document_.save(path("saved.glb"));
    copies.write_now();
    EXPECT_TRUE(QDir(folder).entryList({"*.glb"}).isEmpty()) << "all is saved";
    add_sphere();
    copies.write_now();
    EXPECT_FALSE(QDir(folder).entryList({"*.glb"}).isEmpty());
  }
  EXPECT_TRUE(QDir(folder).entryList(QDir::Files).isEmpty())
      << "a program that ends as it should leaves none";
}

}  // namespace
}  // namespace parian::editor

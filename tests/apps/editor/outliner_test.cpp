#include "apps/editor/outliner.h"

#include <QMimeData>
#include <QSignalSpy>

#include <memory>

#include "editing/nodes.h"
#include "editing/tree.h"
#include "tests/apps/editor/support/editor_test.h"
#include "tests/apps/editor/support/widgets.h"

namespace parian::editor {
namespace {

class OutlinerTest : public EditorTest {
 protected:
  OutlinerTest() : outliner_(document_) {
    document_.load({scene_file("cornell-box")});
    outliner_.resize(320, 500);
    outliner_.show();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&outliner_));
  }
  QTreeView& tree() { return *outliner_.findChild<QTreeView*>("nodes"); }
  QModelIndex row(const QString& text, int column = NodeModel::kName) {
    const QModelIndex found = find_row(*tree().model(), text);
    return found.siblingAtColumn(column);
  }
  /// The texts of the rows at the top.
  QStringList rows() {
    QStringList texts;
    for (int i = 0; i < tree().model()->rowCount(); ++i)
      texts << tree().model()->index(i, 0).data().toString();
    return texts;
  }
  int node(const QString& name) const {
    for (std::size_t i = 0; i < document_.scene().nodes.size(); ++i)
      if (document_.scene().nodes[i].name == name.toStdString()) return int(i);
    return kNone;
  }
  int parent_of(const QString& name) const {
    return edit::find_parents(document_.scene())[std::size_t(node(name))];
  }
  std::vector<int> selected() const { return document_.selection().indices; }
  /// Drags rows onto `target`, before its child at `place`; -1: onto itself.
  void drop(const QModelIndexList& dragged, const QModelIndex& target, int place = -1) {
    const std::unique_ptr<QMimeData> data(tree().model()->mimeData(dragged));
    tree().model()->dropMimeData(data.get(), Qt::MoveAction, place, place < 0 ? -1 : 0, target);
  }

  Document document_;
  Outliner outliner_;
};

const QStringList kNodes{"floor",       "ceiling",    "back wall", "right wall", "left wall",
                         "short block", "tall block", "light",     "camera"};

TEST_F(OutlinerTest, ShowsTheNodes) {
  EXPECT_EQ(rows(), kNodes);
  document_.clear();
  EXPECT_EQ(rows(), QStringList());
}

// What is not found stays selected.
TEST_F(OutlinerTest, Searches) {
  click(tree(), row("floor"));
  auto* search = outliner_.findChild<QLineEdit*>("search");
  search->setFocus();
  QTest::keyClicks(search, "WALL");
  EXPECT_EQ(rows(), QStringList({"back wall", "right wall", "left wall"}));
  EXPECT_EQ(selected(), std::vector<int>{node("floor")});
  click(tree(), row("right wall"));
  EXPECT_EQ(selected(), std::vector<int>{node("right wall")}) << "rows that are found are of other numbers";
  search->setFocus();
  QTest::keyClicks(search, "xyz");
  EXPECT_EQ(rows(), QStringList());
  search->clear();
  EXPECT_EQ(rows(), kNodes);
  EXPECT_EQ(selected(), std::vector<int>{node("right wall")});
  EXPECT_TRUE(tree().selectionModel()->isSelected(row("right wall")));
}

TEST_F(OutlinerTest, RenamesInPlace) {
  click(tree(), row("short block"));
  QTest::keyClick(&tree(), Qt::Key_F2);
  auto* editor = tree().viewport()->findChild<QLineEdit*>();
  ASSERT_NE(editor, nullptr);
  QTest::keyClicks(editor, "crate");
  QTest::keyClick(editor, Qt::Key_Return);
  ASSERT_TRUE(wait_for([&] { return row("crate").isValid(); }));
  EXPECT_EQ(document_.scene().nodes[5].name, "crate");
  EXPECT_EQ(document_.history().count(), 1);
  document_.history().undo();
  EXPECT_TRUE(row("short block").isValid());
  EXPECT_FALSE(row("crate").isValid());
}

TEST_F(OutlinerTest, HidesByTheBox) {
  click_box(tree(), row("tall block", NodeModel::kVisible));
  EXPECT_FALSE(document_.scene().nodes[6].visible);
  EXPECT_EQ(row("tall block", NodeModel::kVisible).data(Qt::CheckStateRole), Qt::Unchecked);
  EXPECT_EQ(document_.history().count(), 1);
  document_.history().undo();
  EXPECT_TRUE(document_.scene().nodes[6].visible);
  EXPECT_EQ(row("tall block", NodeModel::kVisible).data(Qt::CheckStateRole), Qt::Checked);
}

TEST_F(OutlinerTest, SelectsBothWays) {
  click(tree(), row("floor"));
  click(tree(), row("light"), Qt::ControlModifier);
  click(tree(), row("ceiling"), Qt::ControlModifier);
  EXPECT_EQ(document_.selection().active(), node("ceiling")) << "the last one that was clicked";
  EXPECT_EQ(selected().size(), 3u);
  click(tree(), row("light"), Qt::ControlModifier);
  EXPECT_EQ(selected(), (std::vector<int>{node("floor"), node("ceiling")}));
  const Selection blocks{Selection::Kind::nodes, {node("tall block"), node("short block")}};
  document_.select(blocks);
  EXPECT_EQ(document_.selection(), blocks) << "showing it changes nothing";
  EXPECT_TRUE(tree().selectionModel()->isSelected(row("tall block")));
  EXPECT_TRUE(tree().selectionModel()->isSelected(row("short block")));
  EXPECT_EQ(tree().selectionModel()->selectedRows().size(), 2);
  document_.select({});
  EXPECT_FALSE(tree().selectionModel()->hasSelection());
}

TEST_F(OutlinerTest, DropsOntoAnotherNode) {
  drop({row("tall block"), row("short block")}, row("floor"));
  EXPECT_EQ(parent_of("tall block"), node("floor"));
  EXPECT_EQ(parent_of("short block"), node("floor"));
  EXPECT_EQ(tree().model()->rowCount(row("floor")), 2);
  EXPECT_EQ(document_.history().count(), 1);
  drop({row("floor")}, row("tall block"));
  EXPECT_EQ(parent_of("floor"), kNone) << "not below itself";
  EXPECT_EQ(document_.history().count(), 1);
  drop({row("tall block")}, {}, 0);
  EXPECT_EQ(rows().front(), "tall block");
  document_.history().undo();
  document_.history().undo();
  EXPECT_EQ(rows(), kNodes);
}

TEST_F(OutlinerTest, DropsBetweenSiblings) {
  drop({row("camera"), row("floor")}, {}, 2);  // before the back wall
  EXPECT_EQ(rows().mid(0, 4), QStringList({"ceiling", "camera", "floor", "back wall"}));
  QMimeData nonsense;
  nonsense.setData("application/x-parian-nodes", QByteArray(4, '\x7f'));
  tree().model()->dropMimeData(&nonsense, Qt::MoveAction, 0, 0, {});
  EXPECT_EQ(document_.history().count(), 1);
}

TEST_F(OutlinerTest, ListsSelect) {
  using Kind = Selection::Kind;
  const auto list = [&](int tab) {
    outliner_.setCurrentIndex(tab);
    return qobject_cast<QListView*>(outliner_.widget(tab));
  };
  EXPECT_EQ(list(1)->model()->rowCount(), 4);
  click(*list(1), find_row(*list(1)->model(), "green"));
  EXPECT_EQ(document_.selection(), (Selection{Kind::material, {2}}));
  click(*list(3), find_row(*list(3)->model(), "camera"));
  EXPECT_EQ(document_.selection(), (Selection{Kind::camera, {0}}));
  EXPECT_EQ(list(2)->model()->rowCount(), 0);
  document_.load({scene_file("lights")});
  ASSERT_GT(list(2)->model()->rowCount(), 1);
  click(*list(2), list(2)->model()->index(1, 0));
  EXPECT_EQ(document_.selection(), (Selection{Kind::light, {1}}));
}

TEST_F(OutlinerTest, ListsShowWhatIsSelected) {
  const auto chosen = [&](int tab) {
    const QModelIndexList rows =
        qobject_cast<QListView*>(outliner_.widget(tab))->selectionModel()->selectedRows();
    return rows.size() == 1 ? rows[0].data().toString() : QString();
  };
  document_.select({Selection::Kind::material, {2}});
  EXPECT_EQ(chosen(1), "green");
  document_.select({Selection::Kind::camera, {0}});
  EXPECT_EQ(chosen(1), "");
  EXPECT_EQ(chosen(3), "camera");
  document_.edit("Rename", [](Scene& s) { s.cameras[0].name = "eye"; });
  EXPECT_EQ(chosen(3), "eye") << "the list is made anew";
  document_.select_node(0);
  EXPECT_EQ(chosen(3), "");
}

// What is open and what is closed stays so when rows come and go, and nodes get other numbers.
TEST_F(OutlinerTest, StaysExpanded) {
  document_.edit("Group", [](Scene& s) {
    int top = edit::group(s, std::vector{5, 6}, "inner");
    for (const char* name : {"middle", "outer"}) top = edit::group(s, std::vector{top}, name);
  });
  EXPECT_FALSE(tree().isExpanded(row("outer"))) << "it is new";
  tree().expand(row("outer"));
  tree().expand(row("middle"));
  const auto expect_as_before = [&](const char* after) {
    EXPECT_TRUE(tree().isExpanded(row("outer"))) << after;
    EXPECT_TRUE(tree().isExpanded(row("middle"))) << after;
    EXPECT_FALSE(tree().isExpanded(row("inner"))) << after;
  };
  document_.edit("Delete", [&](Scene& s) { edit::remove(s, node("ceiling")); });
  expect_as_before("a node of a lower number is gone");
  document_.history().undo();
  expect_as_before("it is back");
  auto* search = outliner_.findChild<QLineEdit*>("search");
  search->setText("block");
  EXPECT_TRUE(tree().isExpanded(row("inner"))) << "what is found is seen";
  search->clear();
  expect_as_before("a search");
  document_.load({scene_file("cornell-box")});
  EXPECT_FALSE(tree().isExpanded(row("tall block"))) << "numbers of another scene";
}

}  // namespace
}  // namespace parian::editor

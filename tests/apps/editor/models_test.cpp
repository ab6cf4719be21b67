/// Models of nodes and elements stay consistent, whatever happens to the scene.
#include <QAbstractItemModelTester>

#include <random>

#include "apps/editor/outliner.h"
#include "editing/add.h"
#include "editing/materials.h"
#include "editing/nodes.h"
#include "editing/tree.h"
#include "tests/apps/editor/support/editor_test.h"

namespace parian::editor {
namespace {

constexpr auto kFatal = QAbstractItemModelTester::FailureReportingMode::Fatal;

class ModelsTest : public EditorTest {
 protected:
  ModelsTest() : nodes_(document_), found_(document_) {
    document_.load({scene_file("cornell-box")});
    found_.search("O");
  }
  int below(int most) { return std::uniform_int_distribution(0, most - 1)(random_); }
  int any_node() { return below(std::max(1, int(document_.scene().nodes.size()))); }
  void edit_at_random();
  /// Compares a row and all below it with the scene; returns how many rows there are.
  std::size_t compare(const QModelIndex& parent, int node) {
    const std::vector<int>& children = edit::children_of(document_.scene(), node);
    EXPECT_EQ(nodes_.rowCount(parent), int(children.size()));
    std::size_t count = children.size();
    for (int i = 0; i < nodes_.rowCount(parent); ++i) {
      const QModelIndex row = nodes_.index(i, 0, parent);
      EXPECT_EQ(nodes_.node_at(row), children[std::size_t(i)]);
      EXPECT_EQ(nodes_.index_of(children[std::size_t(i)]), row);
      EXPECT_EQ(row.data().toString(), node_label(document_.scene(), children[std::size_t(i)]));
      EXPECT_EQ(row.siblingAtColumn(1).data(Qt::CheckStateRole).toInt() == Qt::Checked,
                document_.scene().nodes[std::size_t(children[std::size_t(i)])].visible);
      count += compare(row, children[std::size_t(i)]);
    }
    return count;
  }

  /// All nodes with an o in their labels, and those above them.
  void expect_found() {
    const Scene& scene = document_.scene();
    const std::vector<int> parents = edit::find_parents(scene);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
      const bool found = std::ranges::any_of(edit::find_subtree(scene, int(i)), [&](int node) {
        return node_label(scene, node).contains("o", Qt::CaseInsensitive);
      });
      const QModelIndex row = found_.index_of(int(i));
      ASSERT_EQ(row.isValid(), found) << "node " << i;
      if (!found) continue;
      EXPECT_EQ(found_.node_at(row.parent()), parents[i]);
      EXPECT_EQ(found_.index(row.row(), 0, row.parent()), row);
    }
  }

  std::mt19937 random_{7};
  Document document_;
  NodeModel nodes_;
  NodeModel found_;
};

// Refusals are part of it: a node below itself, a node that is none.
void ModelsTest::edit_at_random() {
  const int a = any_node(), b = any_node();
  switch (below(12)) {
    case 0:
      document_.edit("",
                     [&](Scene& s) { edit::add_shape(s, edit::sphere(1), {.parent = a, .transform = {}}); });
      break;
    case 1:
      document_.edit("", [&](Scene& s) { edit::add_group(s, "group"); });
      break;
    case 2:
      document_.edit("", [&](Scene& s) { edit::remove(s, a); });
      break;
    case 3:
      document_.edit("", [&](Scene& s) { edit::reparent(s, a, b); });
      break;
    case 4:
      document_.edit("", [&](Scene& s) { edit::rename_node(s, a, std::string(std::size_t(below(4)), 'o')); });
      break;
    case 5:
      document_.edit("", [&](Scene& s) { edit::set_visible(s, a, !s.nodes.at(std::size_t(a)).visible); });
      break;
    case 6:
      document_.edit("", [&](Scene& s) { edit::duplicate(s, a); });
      break;
    case 7:
      document_.edit("", [&](Scene& s) { edit::add_light(s, edit::default_light(LightKind::disk)); });
      break;
    case 8:
      document_.edit("", [&](Scene& s) { edit::remove_unused(s); });
      break;
    case 9:
      document_.drag("", [&](Scene& s) { edit::set_transform(s, a, {Vec3f(1), {}, {}}); });
      break;
    case 10:
      document_.history().undo();
      break;
    default:
      document_.history().redo();
  }
}

TEST_F(ModelsTest, StayConsistent) {
  const QAbstractItemModelTester tester(&nodes_, kFatal), found_tester(&found_, kFatal);
  ElementModel materials(document_, Selection::Kind::material), lights(document_, Selection::Kind::light),
      cameras(document_, Selection::Kind::camera);
  const QAbstractItemModelTester testers[]{{&materials, kFatal}, {&lights, kFatal}, {&cameras, kFatal}};
  for (int i = 0; i < 300; ++i) {
    edit_at_random();
    ASSERT_EQ(compare({}, kNone), document_.scene().nodes.size()) << "edit " << i;
    expect_found();
    ASSERT_EQ(std::size_t(materials.rowCount({})), document_.scene().materials.size());
    ASSERT_EQ(std::size_t(lights.rowCount({})), document_.scene().lights.size());
    ASSERT_EQ(std::size_t(cameras.rowCount({})), document_.scene().cameras.size());
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(document_.history().count(), 20);
  document_.load({scene_file("lights")});
  EXPECT_EQ(compare({}, kNone), document_.scene().nodes.size());
}

}  // namespace
}  // namespace parian::editor

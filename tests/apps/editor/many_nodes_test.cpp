/// With tens of thousands of nodes selected each action still answers. The times are far above what is taken,
/// and far below what an action takes that does something for each node with each node.
#include <QElapsedTimer>
#include <QTreeView>

#include <numeric>

#include "editing/add.h"
#include "editing/nodes.h"
#include "tests/apps/editor/support/window.h"

namespace parian::editor {
namespace {

constexpr int kNodes = 20000;

class ManyNodesTest : public WindowTest {
 protected:
  ManyNodesTest() {
    document().edit("Boxes", [](Scene& s) {
      const int box = edit::add_shape(s, edit::box(Vec3f(0.002f)));
      const Node like = s.nodes[std::size_t(box)];
      for (int i = 0; i < kNodes; ++i) {
        s.nodes.push_back(like);
        s.nodes.back().transform.translation = {0.004f * float(i % 150), 0.004f * float(i / 150), 0};
        s.roots.push_back(int(s.nodes.size()) - 1);
      }
    });
    Selection all{Selection::Kind::nodes, std::vector<int>(scene().nodes.size())};
    std::iota(all.indices.begin(), all.indices.end(), 0);
    EXPECT_TRUE(wait_for([&] { return !window_.viewport().render().bounds(all.active()).isEmpty(); }));
    timed("Select", [&] { document().select(all); });
  }
  /// Does it, and all that follows in the window from it.
  void timed(const std::string& name, const std::function<void()>& action) {
    QElapsedTimer clock;
    clock.start();
    action();
    QCoreApplication::processEvents();
    window_.viewport().grab();
    EXPECT_LT(clock.elapsed(), 4000) << name;
  }
  void timed_action(const QString& text) {
    timed(text.toStdString(), [&] { trigger(window_, text); });
  }
  void timed_undo() {
    timed("Undo", [&] { document().history().undo(); });
  }
};

TEST_F(ManyNodesTest, EachActionAnswers) {
  timed_action("Frame selection");
  timed_action("Duplicate");
  timed_undo();
  timed_action("Group");
  timed_action("Ungroup");
  timed_undo();
  timed_undo();
  timed_action("Delete");
  timed_undo();
  // Every other node is found, which makes ten thousand gaps.
  timed("Rename", [&] {
    document().edit("Rename", [](Scene& s) {
      for (std::size_t i = 0; i < s.nodes.size(); ++i) s.nodes[i].name = i % 2 ? "odd" : "even";
    });
  });
  auto* search = window_.findChild<QLineEdit*>("search");
  timed("Search", [&] { search->setText("odd"); });
  timed("Select all", [&] { window_.findChild<QTreeView*>("nodes")->selectAll(); });
  EXPECT_GE(selected().size(), std::size_t(kNodes / 2));
  timed("End of search", [&] { search->clear(); });
  EXPECT_GE(selected().size(), std::size_t(kNodes / 2));
  timed("Hide", [&] { document().edit("Hide", [](Scene& s) { edit::set_visible(s, 5, false); }); });
  const QPoint middle = window_.viewport().rect().center();
  timed("Move", [&] {
    QTest::mousePress(&window_.viewport(), Qt::LeftButton, {}, middle);
    QTest::mouseMove(&window_.viewport(), middle + QPoint(10, 0));
    QTest::mouseRelease(&window_.viewport(), Qt::LeftButton, {}, middle + QPoint(10, 0));
  });
  timed("Save", [&] { document().save(path("many.glb")); });
}

}  // namespace
}  // namespace parian::editor

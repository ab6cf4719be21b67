/// The panel of what is in the scene: the tree of nodes with a search, and lists of materials, lights and
/// cameras.
#pragma once

#include <QLineEdit>
#include <QSet>
#include <QTabWidget>
#include <QTreeView>

#include "apps/editor/element_list.h"
#include "apps/editor/node_model.h"

namespace parian::editor {

class Outliner : public QTabWidget {
  Q_OBJECT

 public:
  explicit Outliner(Document& document, QWidget* parent = nullptr);

 private:
  QWidget* make_tree();
  void select_from_tree();
  void show_selection();
  void expand_first();
  void expand_again();

  Document& document_;
  NodeModel* nodes_;
  QTreeView* tree_;
  QSet<int> expanded_;    // nodes, but for what a search expands
  bool showing_ = false;  // the selection of the document in the tree
};

}  // namespace parian::editor

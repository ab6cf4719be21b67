/// The panel of what is in the scene: the tree of nodes with a search, and lists of materials, lights and
/// cameras.
#pragma once

#include <QAbstractListModel>
#include <QLineEdit>
#include <QListView>
#include <QSortFilterProxyModel>
#include <QTabWidget>
#include <QTreeView>

#include "apps/editor/node_model.h"

namespace parian::editor {

/// The names of the scene's elements of one kind.
class ElementModel : public QAbstractListModel {
  Q_OBJECT

 public:
  ElementModel(Document& document, Selection::Kind kind, QObject* parent = nullptr);
  int rowCount(const QModelIndex& parent) const override { return parent.isValid() ? 0 : int(names_.size()); }
  QVariant data(const QModelIndex& index, int role) const override;

 private:
  void follow();

  Document& document_;
  Selection::Kind kind_;
  QStringList names_;
};

class Outliner : public QTabWidget {
  Q_OBJECT

 public:
  explicit Outliner(Document& document, QWidget* parent = nullptr);

 private:
  QWidget* make_tree();
  QListView* make_list(Selection::Kind kind);
  void select_from_tree();
  void show_selection();

  Document& document_;
  NodeModel* nodes_;
  QSortFilterProxyModel* found_;
  QTreeView* tree_;
  bool showing_ = false;  // the selection of the document in the tree
};

}  // namespace parian::editor

/// The tree of nodes as Qt's views see it: a name that can be edited, and whether the node is visible. Nodes
/// dragged onto others become their children. Where very much changes all is made anew, since for thousands
/// of rows that come, go or change one by one views take minutes.
#pragma once

#include <QAbstractItemModel>

#include <unordered_map>
#include <vector>

#include "apps/editor/document.h"

namespace parian::editor {

class NodeModel : public QAbstractItemModel {
  Q_OBJECT

 public:
  enum Column { kName, kVisible, kColumns };

  explicit NodeModel(Document& document, QObject* parent = nullptr);

  /// From now on only nodes whose label has that text in it, in capitals or not, and what is above them.
  void search(const QString& text);
  bool is_searching() const { return !searched_.isEmpty(); }

  int node_at(const QModelIndex& index) const { return index.isValid() ? int(index.internalId()) : kNone; }
  /// Invalid where the node is not found by the search.
  QModelIndex index_of(int node, int column = kName) const;
  /// After a reset: the number that a node of before has now; kNone: it is gone.
  int renumbered(int node) const { return renumbered_[std::size_t(node)]; }

  QModelIndex index(int row, int column, const QModelIndex& parent) const override;
  QModelIndex parent(const QModelIndex& index) const override;
  int rowCount(const QModelIndex& parent) const override;
  int columnCount(const QModelIndex&) const override { return kColumns; }
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;
  bool setData(const QModelIndex& index, const QVariant& value, int role) override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  Qt::DropActions supportedDropActions() const override { return Qt::MoveAction; }
  QStringList mimeTypes() const override;
  QMimeData* mimeData(const QModelIndexList& indices) const override;
  bool dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int column,
                    const QModelIndex& parent) override;

 private:
  const std::vector<int>& children(const QModelIndex& parent) const;
  void follow();
  void reset();
  void read_tree();
  void find();

  Document& document_;
  QString searched_;
  // Of the scene that the views know.
  std::shared_ptr<const Scene> scene_;
  std::vector<int> parents_, rows_;  // rows: kNone where it is not shown
  std::unordered_map<int, std::vector<int>>
      found_;  // while searching: the children of each node that are shown
  std::vector<int> renumbered_;
};

/// What a node is called: its name, or what it shows.
QString node_label(const Scene& scene, int node);

}  // namespace parian::editor

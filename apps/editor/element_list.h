/// A list of the scene's materials, lights or cameras, in which one can be selected.
#pragma once

#include <QAbstractListModel>
#include <QListView>

#include "apps/editor/document.h"

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

class ElementList : public QListView {
  Q_OBJECT

 public:
  ElementList(Document& document, Selection::Kind kind, QWidget* parent = nullptr);

 private:
  void show_selection();

  Document& document_;
  Selection::Kind kind_;
};

}  // namespace parian::editor

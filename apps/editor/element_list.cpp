#include "apps/editor/element_list.h"

namespace parian::editor {

ElementModel::ElementModel(Document& document, Selection::Kind kind, QObject* parent)
    : QAbstractListModel(parent), document_(document), kind_(kind) {
  follow();
  connect(&document_, &Document::scene_changed, this, &ElementModel::follow);
  connect(&document_, &Document::scene_replaced, this, &ElementModel::follow);
}

void ElementModel::follow() {
  QStringList names;
  const auto read = [&](const auto& elements, const QString& unnamed) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      names << (elements[i].name.empty() ? unnamed.arg(i) : QString::fromStdString(elements[i].name));
  };
  const Scene& scene = document_.scene();
  if (kind_ == Selection::Kind::material) read(scene.materials, tr("material %1"));
  if (kind_ == Selection::Kind::light) read(scene.lights, tr("light %1"));
  if (kind_ == Selection::Kind::camera) read(scene.cameras, tr("camera %1"));
  if (names == names_) return;
  beginResetModel();
  names_ = names;
  endResetModel();
}

QVariant ElementModel::data(const QModelIndex& index, int role) const {
  return role == Qt::DisplayRole && index.row() < names_.size() ? names_[index.row()] : QVariant();
}

ElementList::ElementList(Document& document, Selection::Kind kind, QWidget* parent)
    : QListView(parent), document_(document), kind_(kind) {
  setModel(new ElementModel(document_, kind, this));
  setEditTriggers(QAbstractItemView::NoEditTriggers);
  const auto choose = [this](const QModelIndex& index) {
    if (index.isValid()) document_.select({kind_, {index.row()}});
  };
  connect(this, &QListView::clicked, this, choose);
  connect(this, &QListView::activated, this, choose);
  connect(&document_, &Document::selection_changed, this, &ElementList::show_selection);
  connect(model(), &QAbstractItemModel::modelReset, this, &ElementList::show_selection);
}

void ElementList::show_selection() {
  const bool mine = document_.selection().kind == kind_;
  const QModelIndex row = mine ? model()->index(document_.selection().active(), 0) : QModelIndex();
  selectionModel()->setCurrentIndex(row, QItemSelectionModel::ClearAndSelect);
  if (row.isValid()) scrollTo(row);
}

}  // namespace parian::editor

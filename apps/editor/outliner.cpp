#include "apps/editor/outliner.h"

#include <QHeaderView>
#include <QVBoxLayout>

#include <algorithm>

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

Outliner::Outliner(Document& document, QWidget* parent) : QTabWidget(parent), document_(document) {
  addTab(make_tree(), tr("Nodes"));
  addTab(make_list(Selection::Kind::material), tr("Materials"));
  addTab(make_list(Selection::Kind::light), tr("Lights"));
  addTab(make_list(Selection::Kind::camera), tr("Cameras"));
  connect(&document_, &Document::selection_changed, this, &Outliner::show_selection);
}

QWidget* Outliner::make_tree() {
  auto* page = new QWidget(this);
  auto* search = new QLineEdit(page);
  search->setObjectName("search");
  search->setPlaceholderText(tr("Search"));
  search->setClearButtonEnabled(true);
  nodes_ = new NodeModel(document_, this);
  found_ = new QSortFilterProxyModel(this);
  found_->setSourceModel(nodes_);
  found_->setRecursiveFilteringEnabled(true);
  found_->setFilterCaseSensitivity(Qt::CaseInsensitive);
  tree_ = new QTreeView(page);
  tree_->setObjectName("nodes");
  tree_->setModel(found_);
  tree_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  tree_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
  tree_->setDragDropMode(QAbstractItemView::InternalMove);
  tree_->setUniformRowHeights(true);  // or a hundred thousand rows are measured one by one
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setSectionResizeMode(NodeModel::kName, QHeaderView::Stretch);
  tree_->header()->setSectionResizeMode(NodeModel::kVisible, QHeaderView::ResizeToContents);
  tree_->expandToDepth(1);
  connect(search, &QLineEdit::textChanged, this, [this](const QString& text) {
    showing_ = true;  // what is not found stays selected
    found_->setFilterFixedString(text);
    showing_ = false;
    if (!text.isEmpty()) tree_->expandAll();
    show_selection();
  });
  connect(tree_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &Outliner::select_from_tree);
  connect(found_, &QAbstractItemModel::modelReset, this, [this] {
    tree_->expandToDepth(1);
    show_selection();
  });
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(search);
  layout->addWidget(tree_);
  return page;
}

QListView* Outliner::make_list(Selection::Kind kind) {
  auto* list = new QListView(this);
  list->setModel(new ElementModel(document_, kind, list));
  list->setEditTriggers(QAbstractItemView::NoEditTriggers);
  const auto choose = [this, kind](const QModelIndex& index) {
    if (index.isValid()) document_.select({kind, {index.row()}});
  };
  connect(list, &QListView::clicked, this, choose);
  connect(list, &QListView::activated, this, choose);
  return list;
}

void Outliner::select_from_tree() {
  if (showing_) return;
  Selection selection{Selection::Kind::nodes, {}};
  for (const QModelIndex& row : tree_->selectionModel()->selectedRows())
    selection.indices.push_back(nodes_->node_at(found_->mapToSource(row)));
  // The row with the cursor is the active one.
  const int current = nodes_->node_at(found_->mapToSource(tree_->currentIndex()));
  const auto at = std::ranges::find(selection.indices, current);
  if (at != selection.indices.end()) std::rotate(at, at + 1, selection.indices.end());
  document_.select(selection.indices.empty() ? Selection{} : selection);
}

void Outliner::show_selection() {
  if (showing_) return;
  showing_ = true;
  const Selection& selection = document_.selection();
  QItemSelection rows;
  QModelIndex last;
  if (selection.kind == Selection::Kind::nodes)
    for (const int node : selection.indices) {
      last = found_->mapFromSource(nodes_->index_of(node));
      if (last.isValid()) rows.select(last, last);
    }
  tree_->selectionModel()->select(rows, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  if (last.isValid()) {
    tree_->selectionModel()->setCurrentIndex(last, QItemSelectionModel::NoUpdate);
    tree_->scrollTo(last);
  }
  showing_ = false;
}

}  // namespace parian::editor

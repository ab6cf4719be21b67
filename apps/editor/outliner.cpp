#include "apps/editor/outliner.h"

#include <QHeaderView>
#include <QVBoxLayout>

#include <algorithm>

namespace parian::editor {
namespace {

/// Rows that follow each other as one range: Qt's views take very long over thousands of ranges.
QItemSelection to_ranges(const QAbstractItemModel& model, const QMap<QModelIndex, QList<int>>& rows) {
  QItemSelection ranges;
  for (auto list = rows.begin(); list != rows.end(); ++list) {
    QList<int> sorted = list.value();
    std::ranges::sort(sorted);
    for (auto first = sorted.begin(); first != sorted.end();) {
      auto last = first;
      while (std::next(last) != sorted.end() && *std::next(last) == *last + 1) ++last;
      ranges.select(model.index(*first, 0, list.key()), model.index(*last, 0, list.key()));
      first = std::next(last);
    }
  }
  return ranges;
}

}  // namespace

Outliner::Outliner(Document& document, QWidget* parent) : QTabWidget(parent), document_(document) {
  addTab(make_tree(), tr("Nodes"));
  addTab(new ElementList(document_, Selection::Kind::material, this), tr("Materials"));
  addTab(new ElementList(document_, Selection::Kind::light, this), tr("Lights"));
  addTab(new ElementList(document_, Selection::Kind::camera, this), tr("Cameras"));
  connect(&document_, &Document::selection_changed, this, &Outliner::show_selection);
  connect(&document_, &Document::scene_replaced, this, &Outliner::expand_first);
  expand_first();
}

QWidget* Outliner::make_tree() {
  auto* page = new QWidget(this);
  auto* search = new QLineEdit(page);
  search->setObjectName("search");
  search->setPlaceholderText(tr("Search"));
  search->setClearButtonEnabled(true);
  nodes_ = new NodeModel(document_, this);
  tree_ = new QTreeView(page);
  tree_->setObjectName("nodes");
  tree_->setModel(nodes_);
  tree_->setSelectionMode(QAbstractItemView::ExtendedSelection);
  tree_->setEditTriggers(QAbstractItemView::EditKeyPressed | QAbstractItemView::DoubleClicked);
  tree_->setDragDropMode(QAbstractItemView::InternalMove);
  tree_->setUniformRowHeights(true);  // or a hundred thousand rows are measured one by one
  tree_->header()->setStretchLastSection(false);
  tree_->header()->setSectionResizeMode(NodeModel::kName, QHeaderView::Stretch);
  tree_->header()->setSectionResizeMode(NodeModel::kVisible, QHeaderView::ResizeToContents);
  connect(search, &QLineEdit::textChanged, nodes_, &NodeModel::search);
  connect(tree_->selectionModel(), &QItemSelectionModel::selectionChanged, this, &Outliner::select_from_tree);
  connect(tree_, &QTreeView::expanded, this,
          [this](const QModelIndex& i) { expanded_ << nodes_->node_at(i); });
  connect(tree_, &QTreeView::collapsed, this,
          [this](const QModelIndex& i) { expanded_.remove(nodes_->node_at(i)); });
  connect(nodes_, &QAbstractItemModel::modelReset, this, [this] {
    QSet<int> now;
    for (const int node : expanded_)
      if (const int place = nodes_->renumbered(node); place != kNone) now << place;
    expanded_ = now;
    expand_again();
    show_selection();
  });
  auto* layout = new QVBoxLayout(page);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(search);
  layout->addWidget(tree_);
  return page;
}

/// As a scene is first shown: the roots and their children.
void Outliner::expand_first() {
  expanded_.clear();
  const Scene& scene = document_.scene();
  for (const int root : scene.roots) {
    expanded_ << root;
    for (const int child : scene.nodes[std::size_t(root)].children) expanded_ << child;
  }
  erase_if(expanded_, [&](int node) { return scene.nodes[std::size_t(node)].children.empty(); });
  expand_again();
}

void Outliner::expand_again() {
  const QSignalBlocker quiet(tree_);
  if (nodes_->is_searching()) return tree_->expandAll();
  tree_->collapseAll();
  for (const int node : expanded_) tree_->expand(nodes_->index_of(node));
}

void Outliner::select_from_tree() {
  if (showing_) return;
  Selection selection{Selection::Kind::nodes, {}};
  for (const QModelIndex& row : tree_->selectionModel()->selectedRows())
    selection.indices.push_back(nodes_->node_at(row));
  // The row with the cursor is the active one.
  const int current = nodes_->node_at(tree_->currentIndex());
  const auto at = std::ranges::find(selection.indices, current);
  if (at != selection.indices.end()) std::rotate(at, at + 1, selection.indices.end());
  document_.select(selection.indices.empty() ? Selection{} : selection);
}

void Outliner::show_selection() {
  if (showing_) return;
  showing_ = true;
  const Selection& selection = document_.selection();
  QMap<QModelIndex, QList<int>> rows;  // by parent
  QModelIndex last;
  if (selection.kind == Selection::Kind::nodes)
    for (const int node : selection.indices) {
      last = nodes_->index_of(node);
      if (last.isValid()) rows[last.parent()] << last.row();
    }
  // More would take seconds: then the active node alone is seen as selected.
  constexpr int kMostRanges = 1000;
  QItemSelection ranges = to_ranges(*nodes_, rows);
  if (ranges.size() > kMostRanges) ranges = QItemSelection(last, last);
  tree_->selectionModel()->select(ranges, QItemSelectionModel::ClearAndSelect | QItemSelectionModel::Rows);
  if (last.isValid()) {
    tree_->selectionModel()->setCurrentIndex(last, QItemSelectionModel::NoUpdate);
    tree_->scrollTo(last);
  }
  showing_ = false;
}

}  // namespace parian::editor

#include "apps/editor/node_model.h"

#include <QDataStream>
#include <QIODevice>
#include <QMimeData>

#include <algorithm>

#include "editing/nodes.h"
#include "editing/tree.h"

namespace parian::editor {
namespace {

const QString kMimeType = "application/x-parian-nodes";

/// Whether the trees of two scenes have the same shape.
bool same_tree(const Scene& a, const Scene& b) {
  return a.roots == b.roots && std::ranges::equal(a.nodes, b.nodes, {}, &Node::children, &Node::children);
}

/// For each node of a scene where it is after an edit that left most of them in their order; kNone: it is
/// gone.
std::vector<int> find_again(const Scene& before, const Scene& after) {
  const auto is_like = [](const Node& a, const Node& b) {
    return a.name == b.name && a.mesh == b.mesh && a.shape == b.shape && a.light == b.light &&
           a.camera == b.camera;
  };
  std::vector<int> places(before.nodes.size(), kNone);
  const bool same_count = before.nodes.size() == after.nodes.size();
  const bool fewer = before.nodes.size() > after.nodes.size();
  std::size_t i = 0, j = 0;
  while (i < before.nodes.size() && j < after.nodes.size()) {
    if (same_count || is_like(before.nodes[i], after.nodes[j]))
      places[i++] = int(j++);
    else
      ++(fewer ? i : j);
  }
  return places;
}

}  // namespace

QString node_label(const Scene& scene, int index) {
  const Node& node = scene.nodes[std::size_t(index)];
  const auto named = [](const auto& array, int i) {
    return QString::fromStdString(array[std::size_t(i)].name);
  };
  QString label = QString::fromStdString(node.name);
  if (label.isEmpty() && node.mesh != kNone) label = named(scene.meshes, node.mesh);
  if (label.isEmpty() && node.shape != kNone) label = named(scene.shapes, node.shape);
  if (label.isEmpty() && node.light != kNone) label = named(scene.lights, node.light);
  if (label.isEmpty() && node.camera != kNone) label = named(scene.cameras, node.camera);
  return label.isEmpty() ? QObject::tr("node %1").arg(index) : label;
}

NodeModel::NodeModel(Document& document, QObject* parent) : QAbstractItemModel(parent), document_(document) {
  read_tree();
  connect(&document_, &Document::scene_changed, this, &NodeModel::follow);
  connect(&document_, &Document::scene_replaced, this, &NodeModel::follow);
}

void NodeModel::search(const QString& text) {
  if (text == searched_) return;
  searched_ = text;
  reset();
}

void NodeModel::reset() {
  beginResetModel();
  read_tree();
  endResetModel();
}

void NodeModel::read_tree() {
  if (scene_) renumbered_ = find_again(*scene_, document_.scene());
  scene_ = document_.share();
  parents_ = edit::find_parents(*scene_);
  find();
  rows_.assign(scene_->nodes.size(), kNone);
  const auto number = [&](const std::vector<int>& list) {
    for (std::size_t i = 0; i < list.size(); ++i) rows_[std::size_t(list[i])] = int(i);
  };
  if (is_searching()) {
    for (const auto& [node, list] : found_) number(list);
  } else {
    number(scene_->roots);
    for (const Node& node : scene_->nodes) number(node.children);
  }
}

void NodeModel::find() {
  found_.clear();
  if (!is_searching()) return;
  std::vector<bool> shown(scene_->nodes.size(), false);
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (node_label(*scene_, int(i)).contains(searched_, Qt::CaseInsensitive))
      for (int node = int(i); node != kNone && !shown[std::size_t(node)]; node = parents_[std::size_t(node)])
        shown[std::size_t(node)] = true;
  const auto filter = [&](int parent) {
    std::vector<int> list = edit::children_of(*scene_, parent);
    std::erase_if(list, [&](int node) { return !shown[std::size_t(node)]; });
    if (!list.empty()) found_[parent] = std::move(list);
  };
  filter(kNone);
  for (std::size_t i = 0; i < shown.size(); ++i)
    if (shown[i]) filter(int(i));
}

void NodeModel::follow() {
  if (!same_tree(*scene_, document_.scene())) return reset();
  const std::vector<Node>&before = scene_->nodes, &after = document_.scene().nodes;
  std::vector<int> changed;
  bool renamed = false;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const bool other_name = before[i].name != after[i].name;
    renamed |= other_name;
    if (other_name || before[i].visible != after[i].visible) changed.push_back(int(i));
  }
  constexpr std::size_t kMost = 100;  // one by one
  if ((renamed && is_searching()) || changed.size() > kMost) return reset();
  scene_ = document_.share();
  for (const int node : changed)
    if (const QModelIndex row = index_of(node); row.isValid())
      emit dataChanged(row, row.siblingAtColumn(kVisible));
}

const std::vector<int>& NodeModel::children(const QModelIndex& parent) const {
  if (!is_searching()) return edit::children_of(*scene_, node_at(parent));
  static const std::vector<int> none;
  const auto list = found_.find(node_at(parent));
  return list == found_.end() ? none : list->second;
}

QModelIndex NodeModel::index_of(int node, int column) const {
  if (node == kNone || std::size_t(node) >= rows_.size() || rows_[std::size_t(node)] == kNone) return {};
  return createIndex(rows_[std::size_t(node)], column, quintptr(node));
}

QModelIndex NodeModel::index(int row, int column, const QModelIndex& parent) const {
  const std::vector<int>& list = children(parent);
  if (row < 0 || std::size_t(row) >= list.size() || column < 0 || column >= kColumns) return {};
  return createIndex(row, column, quintptr(list[std::size_t(row)]));
}

QModelIndex NodeModel::parent(const QModelIndex& index) const {
  return index.isValid() ? index_of(parents_[std::size_t(node_at(index))]) : QModelIndex();
}

int NodeModel::rowCount(const QModelIndex& parent) const {
  return parent.column() > 0 ? 0 : int(children(parent).size());
}

QVariant NodeModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) return {};
  const int node = node_at(index);
  if (index.column() == kName && role == Qt::DisplayRole) return node_label(*scene_, node);
  if (index.column() == kName && role == Qt::EditRole)
    return QString::fromStdString(scene_->nodes[std::size_t(node)].name);
  if (index.column() == kVisible && role == Qt::CheckStateRole)
    return scene_->nodes[std::size_t(node)].visible ? Qt::Checked : Qt::Unchecked;
  return {};
}

QVariant NodeModel::headerData(int section, Qt::Orientation, int role) const {
  if (role != Qt::DisplayRole) return {};
  return section == kName ? tr("Node") : tr("Seen");
}

bool NodeModel::setData(const QModelIndex& index, const QVariant& value, int role) {
  const int node = node_at(index);
  if (index.column() == kName && role == Qt::EditRole) {
    const std::string name = value.toString().toStdString();
    return document_.edit(tr("Rename"), [&](Scene& s) { edit::rename_node(s, node, name); }).isEmpty();
  }
  if (index.column() == kVisible && role == Qt::CheckStateRole) {
    const bool visible = value.toInt() == Qt::Checked;
    return document_
        .edit(visible ? tr("Show") : tr("Hide"), [&](Scene& s) { edit::set_visible(s, node, visible); })
        .isEmpty();
  }
  return false;
}

Qt::ItemFlags NodeModel::flags(const QModelIndex& index) const {
  if (!index.isValid()) return Qt::ItemIsDropEnabled;
  const Qt::ItemFlags flags =
      Qt::ItemIsEnabled | Qt::ItemIsSelectable | Qt::ItemIsDragEnabled | Qt::ItemIsDropEnabled;
  return flags | (index.column() == kName ? Qt::ItemIsEditable : Qt::ItemIsUserCheckable);
}

QStringList NodeModel::mimeTypes() const { return {kMimeType}; }

QMimeData* NodeModel::mimeData(const QModelIndexList& indices) const {
  QByteArray bytes;
  QDataStream stream(&bytes, QIODevice::WriteOnly);
  for (const QModelIndex& index : indices)
    if (index.column() == kName) stream << qint32(node_at(index));
  auto* data = new QMimeData;
  data->setData(kMimeType, bytes);
  return data;
}

bool NodeModel::dropMimeData(const QMimeData* data, Qt::DropAction action, int row, int,
                             const QModelIndex& parent) {
  if (action != Qt::MoveAction || !data->hasFormat(kMimeType)) return false;
  std::vector<int> nodes;
  QByteArray bytes = data->data(kMimeType);
  QDataStream stream(&bytes, QIODevice::ReadOnly);
  for (qint32 node; !stream.atEnd();) {
    stream >> node;
    nodes.push_back(node);
  }
  const int target = node_at(parent);
  document_.edit(tr("Move in the tree"), [&](Scene& scene) {
    // Each in front of the sibling that stands at `row`, whose place moves as nodes are taken out before it.
    const std::vector<int> list = children(parent);
    int before = kNone;
    for (std::size_t i = std::size_t(std::max(0, row)); row >= 0 && i < list.size() && before == kNone; ++i)
      if (std::ranges::find(nodes, list[i]) == nodes.end()) before = list[i];
    for (const int node : nodes) {
      edit::reparent(scene, node, target);
      if (before == kNone) continue;
      const std::vector<int>& now = edit::children_of(std::as_const(scene), target);
      edit::reorder(scene, node, int(std::ranges::find(now, before) - now.begin()));
    }
  });
  return false;  // the model has followed; the view must not remove rows
}

}  // namespace parian::editor

#include "apps/editor/document.h"

#include <QFileInfo>
#include <QUndoCommand>

#include <algorithm>
#include <exception>
#include <utility>

#include "editing/add.h"
#include "editing/scene_delta.h"
#include "renderer/scene/world.h"
#include "scene_io/gltf/write/write.h"

namespace parian::editor {
namespace {

bool same_numbers(const Scene& a, const Scene& b) {
  return a.nodes.size() == b.nodes.size() && a.materials.size() == b.materials.size() &&
         a.lights.size() == b.lights.size() && a.cameras.size() == b.cameras.size();
}

}  // namespace

/// One step of the history: the difference that it made.
class SceneCommand : public QUndoCommand {
 public:
  /// `after`: the scene that the first redo() shows, which QUndoStack calls at once; null: it is shown.
  SceneCommand(Document& document, const QString& name, SceneDelta delta, std::shared_ptr<const Scene> after)
      : QUndoCommand(name),
        document_(document),
        delta_(std::move(delta)),
        after_(std::move(after)),
        selected_before_(document.selection()) {}

  void redo() override {
    if (!std::exchange(is_new_, false))
      turn([this](Scene& scene) { apply(scene, delta_); }, selected_after_, selected_before_);
    else if (after_)
      document_.show(std::exchange(after_, nullptr), changed(delta_));
  }
  void undo() override {
    turn([this](Scene& scene) { revert(scene, delta_); }, selected_before_, selected_after_);
  }

 private:
  template <class Turn>
  void turn(const Turn& turn_scene, const Selection& selected_there, Selection& selected_here) {
    document_.drop_drag();  // the difference is one to the scene without it
    const std::shared_ptr<const Scene> before = document_.share();
    selected_here = document_.selection();
    auto scene = std::make_shared<Scene>(*before);
    turn_scene(*scene);
    document_.show(std::move(scene), changed(delta_));
    // Where elements have other numbers now, the selection is that of when they had these.
    if (!same_numbers(*before, document_.scene())) document_.select(selected_there);
  }

  Document& document_;
  SceneDelta delta_;
  std::shared_ptr<const Scene> after_;
  Selection selected_before_, selected_after_;
  bool is_new_ = true;
};

Document::Document(QObject* parent)
    : QObject(parent),
      scene_(std::make_shared<Scene>()),
      sources_(std::make_shared<std::vector<GltfSource>>()) {}

Document::~Document() { history_.disconnect(); }

void Document::replace(Scene scene, std::vector<GltfSource> sources, const QString& path) {
  drag_start_ = nullptr;
  sources_ = std::make_shared<const std::vector<GltfSource>>(std::move(sources));
  scene_ = std::make_shared<const Scene>(std::move(scene));
  path_ = path;
  history_.clear();
  history_.setClean();
  selection_ = {};
  emit scene_replaced();
  emit selection_changed();
  emit path_changed();
}

void Document::clear() {
  Scene scene;
  scene.environment.radiance = Rgb(1);
  replace(std::move(scene), {}, "");
}

void Document::load(const QStringList& paths) {
  std::vector<std::string> files, warnings;
  for (const QString& path : paths) files.push_back(path.toStdString());
  std::vector<GltfSource> sources;
  LoadSettings settings;
  settings.sources = &sources;
  Scene scene = load_scene(files, settings, warnings);
  replace(std::move(scene), std::move(sources), paths.front());
  if (!warnings.empty()) emit refused(QString::fromStdString(warnings.front()));
}

void Document::adopt_backup(const QString& backup, const QString& original) {
  load({backup});
  path_ = original;
  history_.resetClean();
  emit path_changed();
}

std::function<void(const QString&)> Document::writer() const {
  return [scene = scene_, sources = sources_](const QString& path) {
    write_gltf(*scene, *sources, path.toStdString());
  };
}

void Document::save(const QString& path) {
  finish_drag();
  writer()(path);
  path_ = path;
  history_.setClean();
  emit path_changed();
}

void Document::import_model(const QString& path) {
  finish_drag();
  std::vector<std::string> warnings;
  // Behind those that there are, as the numbers in the model's origins say. It stays when the step is undone.
  auto sources = std::make_shared<std::vector<GltfSource>>(*sources_);
  LoadSettings settings;
  settings.sources = sources.get();
  const Scene model = load_scene({path.toStdString()}, settings, warnings);
  const std::string name = QFileInfo(path).completeBaseName().toStdString();
  auto after = std::make_shared<Scene>(*scene_);
  int node = kNone;
  SceneDelta delta = record(*after, [&](Scene& scene) { node = edit::add_scene(scene, model, name); });
  sources_ = std::move(sources);
  history_.push(new SceneCommand(*this, tr("Add %1").arg(QFileInfo(path).fileName()), std::move(delta),
                                 std::move(after)));
  select_node(node);
  if (!warnings.empty()) emit refused(QString::fromStdString(warnings.front()));
}

QString Document::edit(const QString& name, const Command& command) {
  finish_drag();
  auto after = std::make_shared<Scene>(*scene_);
  try {
    SceneDelta delta = record(*after, command);
    if (!delta.empty()) history_.push(new SceneCommand(*this, name, std::move(delta), std::move(after)));
    return "";
  } catch (const std::exception& error) {
    const QString reason = QString::fromStdString(error.what());
    emit refused(reason);
    return reason;
  }
}

QString Document::drag(const QString& name, const Command& command) {
  const std::shared_ptr<const Scene> start = drag_start_ ? drag_start_ : scene_;
  auto after = std::make_shared<Scene>(*start);
  try {
    command(*after);
  } catch (const std::exception& error) {
    return QString::fromStdString(error.what());
  }
  drag_start_ = start;
  drag_name_ = name;
  const unsigned flags = changed(make_delta(*scene_, *after));
  show(std::move(after), flags);
  return "";
}

void Document::finish_drag() {
  const std::shared_ptr<const Scene> start = std::exchange(drag_start_, nullptr);
  if (!start) return;
  SceneDelta delta = make_delta(*start, *scene_);
  if (!delta.empty()) history_.push(new SceneCommand(*this, drag_name_, std::move(delta), nullptr));
}

void Document::drop_drag() {
  const std::shared_ptr<const Scene> start = std::exchange(drag_start_, nullptr);
  if (start) show(start, changed(make_delta(*scene_, *start)));
}

void Document::show(std::shared_ptr<const Scene> scene, unsigned changed) {
  scene_ = std::move(scene);
  check_selection();
  emit scene_changed(changed);
}

void Document::check_selection() {
  const auto count = [&] {
    switch (selection_.kind) {
      case Selection::Kind::nodes:
        return scene_->nodes.size();
      case Selection::Kind::material:
        return scene_->materials.size();
      case Selection::Kind::light:
        return scene_->lights.size();
      case Selection::Kind::camera:
        return scene_->cameras.size();
      case Selection::Kind::environment:
      case Selection::Kind::none:
        break;
    }
    return std::size_t(1);
  }();
  Selection left = selection_;
  std::erase_if(left.indices, [&](int i) { return std::size_t(i) >= count; });
  if (left.indices.empty() && left.kind != Selection::Kind::environment) left = {};
  select(std::move(left));
}

void Document::select(Selection selection) {
  if (selection == selection_) return;
  selection_ = std::move(selection);
  emit selection_changed();
}

void Document::select_node(int node, bool add) {
  if (node == kNone) return add ? void() : select({});
  Selection next{Selection::Kind::nodes, {}};
  if (add && selection_.kind == Selection::Kind::nodes) next = selection_;
  const bool was_there = std::erase(next.indices, node) > 0;
  if (!was_there || !add) next.indices.push_back(node);
  select(next.indices.empty() ? Selection{} : next);
}

}  // namespace parian::editor

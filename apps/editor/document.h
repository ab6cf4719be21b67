/// The scene that is edited, with its file, its history and what of it is selected. All changes go through
/// here; windows and panels follow by the signals.
#pragma once

#include <QObject>
#include <QString>
#include <QStringList>
#include <QUndoStack>

#include <functional>
#include <memory>
#include <vector>

#include "scene_io/gltf/gltf.h"
#include "scene_io/gltf/source.h"

namespace parian::editor {

/// What is selected: nodes, or one element of another kind.
struct Selection {
  enum class Kind { none, nodes, material, light, camera, environment };
  Kind kind = Kind::none;
  std::vector<int> indices;  // of nodes in the order of their selection, the last one being the active one
  int active() const { return indices.empty() ? kNone : indices.back(); }
  bool operator==(const Selection&) const = default;
};

class Document : public QObject {
  Q_OBJECT

 public:
  using Command = std::function<void(Scene&)>;

  explicit Document(QObject* parent = nullptr);
  ~Document() override;

  const Scene& scene() const { return *scene_; }
  std::shared_ptr<const Scene> share() const { return scene_; }
  QUndoStack& history() { return history_; }

  // Files. These throw std::exception, and then all is as it was.

  /// An empty scene under a plain sky.
  void clear();
  /// Replaces the scene by those files as one; the first is the one that save() writes to.
  void load(const QStringList& paths);
  /// Writes glTF; the document is then that file. Throws as write_gltf().
  void save(const QString& path);
  /// What writes the document as it is now to a path: a copy, for any thread; the document's file and history
  /// stay.
  std::function<void(const QString&)> writer() const;
  /// Adds a model below a new node, as one step of the history.
  void import_model(const QString& path);
  /// "": not yet saved.
  const QString& path() const { return path_; }
  /// What a backup of this document is of, when it is restored: it is then unsaved.
  void adopt_backup(const QString& backup, const QString& original);
  bool is_modified() const { return !history_.isClean(); }

  // Edits. What a command refuses leaves the scene as it was, and its reason is returned; "" where it is
  // done.

  /// One step of the history, named `name`. A command that changes nothing is none.
  QString edit(const QString& name, const Command& command);
  /// A step that is still in the hand: each call starts again from the scene before the first one. finish()
  /// makes it a step of the history, drop() takes it back. Any edit() in between finishes it.
  QString drag(const QString& name, const Command& command);
  void finish_drag();
  void drop_drag();
  bool is_dragging() const { return drag_start_ != nullptr; }

  const Selection& selection() const { return selection_; }
  void select(Selection selection);
  void select_node(int node, bool add = false);

 signals:
  /// The scene is another; or-ed flags of Changed. Selected indices that are no more are deselected before.
  void scene_changed(unsigned changed);
  /// As the above, where all is another: the history is empty, too.
  void scene_replaced();
  void selection_changed();
  void path_changed();
  /// One line for the user: what could not be done, and why.
  void refused(const QString& reason);

 private:
  friend class SceneCommand;
  void replace(Scene scene, std::vector<GltfSource> sources, const QString& path);
  void show(std::shared_ptr<const Scene> scene, unsigned changed);
  void check_selection();

  std::shared_ptr<const Scene> scene_;
  std::shared_ptr<const std::vector<GltfSource>> sources_;  // what the parts of the scene were read from
  QString path_;
  QUndoStack history_;
  Selection selection_;
  std::shared_ptr<const Scene> drag_start_;
  QString drag_name_;
};

}  // namespace parian::editor

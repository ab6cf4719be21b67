/// The difference of two scenes: what an undo stack holds, and what a session has to be told.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

/// Neighbours in an array that an edit replaced, added or removed: `before` stood at `first`, `after` does.
template <class T>
struct Splice {
  std::size_t first = 0;
  std::vector<T> before, after;
};

/// In ascending order and apart from each other. All but the last are of equal length before and after, so
/// that `first` is the same place in both scenes.
template <class T>
using ArrayDelta = std::vector<Splice<T>>;

/// What turns one scene into another and back. Holds the elements that differ; vertices and texels are
/// shared with the scenes.
struct SceneDelta {
  ArrayDelta<Node> nodes;
  ArrayDelta<int> roots;
  ArrayDelta<Mesh> meshes;
  ArrayDelta<Shape> shapes;
  ArrayDelta<Material> materials;
  ArrayDelta<Texture> textures;
  ArrayDelta<Image> images;
  ArrayDelta<Camera> cameras;
  ArrayDelta<Light> lights;
  std::vector<std::pair<Environment, Environment>> environment;  // before and after; empty: it is the same
  unsigned changed = 0;                                          // see changed()

  bool empty() const;
};

/// The difference of two valid scenes. Compares all elements, but no array of vertices, texels or instances:
/// those differ where they do not share their storage. Of n elements, O(n).
SceneDelta make_delta(const Scene& before, const Scene& after);

/// Turns the scene that was `before` into `after`, and back. For no other scene.
void apply(Scene& scene, const SceneDelta& delta);
void revert(Scene& scene, const SceneDelta& delta);

/// What a session has to be told when the delta is applied or reverted: or-ed flags of Changed
/// (renderer/session/session.h); 0: the picture stays, and so may the scene of the session.
inline unsigned changed(const SceneDelta& delta) { return delta.changed; }

/// Runs edit(scene) and returns the difference that it made. Where it throws, the scene is as it was.
template <class Edit>
SceneDelta record(Scene& scene, const Edit& edit) {
  Scene before = scene;
  try {
    edit(scene);
  } catch (...) {
    scene = std::move(before);
    throw;
  }
  return make_delta(before, scene);
}

}  // namespace parian

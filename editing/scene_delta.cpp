#include "editing/scene_delta.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "editing/changed.h"
#include "editing/identical.h"

namespace parian {
namespace {

template <class T>
std::vector<T> copy_range(const std::vector<T>& array, std::size_t first, std::size_t end) {
  return {array.begin() + std::ptrdiff_t(first), array.begin() + std::ptrdiff_t(end)};
}

/// After the common ends, runs of what differs place by place: an edit of the first and the last node of many
/// is two nodes. What one array has more than the other goes into the last run.
template <class T>
ArrayDelta<T> compare(const std::vector<T>& before, const std::vector<T>& after) {
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t i = 0, tail = 0;
  while (i < shorter && identical(before[i], after[i])) ++i;
  while (tail < shorter - i && identical(before[before.size() - 1 - tail], after[after.size() - 1 - tail]))
    ++tail;
  const std::size_t aligned = shorter - tail;
  ArrayDelta<T> delta;
  while (i < aligned) {
    const std::size_t first = i;
    while (i < aligned && !identical(before[i], after[i])) ++i;
    delta.push_back({first, copy_range(before, first, i), copy_range(after, first, i)});
    while (i < aligned && identical(before[i], after[i])) ++i;
  }
  if (before.size() == after.size()) return delta;
  if (delta.empty() || delta.back().first + delta.back().before.size() != aligned)
    delta.push_back({aligned, {}, {}});
  Splice<T>& last = delta.back();
  std::copy(before.begin() + std::ptrdiff_t(aligned), before.end() - std::ptrdiff_t(tail),
            std::back_inserter(last.before));
  std::copy(after.begin() + std::ptrdiff_t(aligned), after.end() - std::ptrdiff_t(tail),
            std::back_inserter(last.after));
  return delta;
}

template <class T>
void replace(std::vector<T>& array, std::size_t first, const std::vector<T>& old_items,
             const std::vector<T>& new_items) {
  assert(first + old_items.size() <= array.size());
  const auto at = array.begin() + std::ptrdiff_t(first);
  const std::size_t common = std::min(old_items.size(), new_items.size());
  std::copy_n(new_items.begin(), common, at);
  const auto rest = at + std::ptrdiff_t(common);
  if (old_items.size() > common)
    array.erase(rest, rest + std::ptrdiff_t(old_items.size() - common));
  else
    array.insert(rest, new_items.begin() + std::ptrdiff_t(common), new_items.end());
}

template <class T>
void apply_to(std::vector<T>& array, const ArrayDelta<T>& delta, bool forward) {
  for (const Splice<T>& s : delta) {
    if (forward)
      replace(array, s.first, s.before, s.after);
    else
      replace(array, s.first, s.after, s.before);
  }
}

void run(Scene& scene, const SceneDelta& delta, bool forward) {
  apply_to(scene.nodes, delta.nodes, forward);
  apply_to(scene.roots, delta.roots, forward);
  apply_to(scene.meshes, delta.meshes, forward);
  apply_to(scene.shapes, delta.shapes, forward);
  apply_to(scene.materials, delta.materials, forward);
  apply_to(scene.textures, delta.textures, forward);
  apply_to(scene.images, delta.images, forward);
  apply_to(scene.cameras, delta.cameras, forward);
  apply_to(scene.lights, delta.lights, forward);
  for (const auto& [before, after] : delta.environment) scene.environment = forward ? after : before;
}

}  // namespace

bool SceneDelta::empty() const {
  return nodes.empty() && roots.empty() && meshes.empty() && shapes.empty() && materials.empty() &&
         textures.empty() && images.empty() && cameras.empty() && lights.empty() && environment.empty();
}

SceneDelta make_delta(const Scene& before, const Scene& after) {
  SceneDelta delta;
  delta.nodes = compare(before.nodes, after.nodes);
  delta.roots = compare(before.roots, after.roots);
  delta.meshes = compare(before.meshes, after.meshes);
  delta.shapes = compare(before.shapes, after.shapes);
  delta.materials = compare(before.materials, after.materials);
  delta.textures = compare(before.textures, after.textures);
  delta.images = compare(before.images, after.images);
  delta.cameras = compare(before.cameras, after.cameras);
  delta.lights = compare(before.lights, after.lights);
  if (!identical(before.environment, after.environment))
    delta.environment.emplace_back(before.environment, after.environment);
  delta.changed = find_changed(before, after, delta);
  return delta;
}

void apply(Scene& scene, const SceneDelta& delta) { run(scene, delta, true); }

void revert(Scene& scene, const SceneDelta& delta) { run(scene, delta, false); }

}  // namespace parian

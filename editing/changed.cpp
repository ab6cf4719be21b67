#include "editing/changed.h"

#include <algorithm>

#include "editing/identical.h"
#include "renderer/session/session.h"

namespace parian {
namespace {

/// Calls visit(old element, new element) for each place that has another element than it had. What stands at
/// a place that one scene does not have is not asked for: only links to it, which are edits of their own, or
/// the array's length can matter.
template <class T, class Visit>
void for_each_edited(const std::vector<T>& before, const std::vector<T>& after, const ArrayDelta<T>& delta,
                     const Visit& visit) {
  if (delta.empty()) return;
  const std::size_t end = std::min(before.size(), after.size());
  if (before.size() != after.size()) {  // behind the splice all elements have moved
    for (std::size_t i = delta.front().first; i < end; ++i) visit(i);
    return;
  }
  for (const Splice<T>& s : delta)
    for (std::size_t i = s.first; i < s.first + s.before.size(); ++i) visit(i);
}

/// Whether they differ in more than their names.
template <class T>
bool differ(const T& a, T b) {
  b.name = a.name;
  return !identical(a, b);
}

template <class T>
unsigned flag_where_different(const std::vector<T>& before, const std::vector<T>& after,
                              const ArrayDelta<T>& delta, unsigned flag) {
  unsigned changed = 0;
  for_each_edited(before, after, delta, [&](std::size_t i) {
    if (differ(before[i], after[i])) changed |= flag;
  });
  return changed;
}

/// The world has a part for every primitive, drawn or not, so their number counts.
unsigned find_changed_meshes(const Scene& before, const Scene& after, const SceneDelta& delta) {
  if (before.meshes.size() != after.meshes.size()) return kChangedGeometry;
  unsigned changed = 0;
  for_each_edited(before.meshes, after.meshes, delta.meshes, [&](std::size_t i) {
    const Mesh& a = before.meshes[i];
    Mesh b = after.meshes[i];
    if (!differ(a, b)) return;
    if (a.primitives.size() == b.primitives.size())
      for (std::size_t p = 0; p < a.primitives.size(); ++p)
        b.primitives[p].material = a.primitives[p].material;
    changed |= differ(a, b) ? kChangedGeometry : kChangedMaterials;
  });
  return changed;
}

/// What decides whether and where a material emits.
bool emits_alike(const Material& a, const Material& b) {
  return a.emission == b.emission && a.emission_texture == b.emission_texture &&
         a.double_sided == b.double_sided && a.unlit == b.unlit;
}

unsigned find_changed_materials(const Scene& before, const Scene& after, const SceneDelta& delta) {
  unsigned changed = 0;
  for_each_edited(before.materials, after.materials, delta.materials, [&](std::size_t i) {
    const Material &a = before.materials[i], &b = after.materials[i];
    if (!differ(a, b)) return;
    changed |= kChangedMaterials;
    if (!emits_alike(a, b)) changed |= kChangedLights;
  });
  for_each_edited(before.textures, after.textures, delta.textures, [&](std::size_t i) {
    if (!identical(before.textures[i], after.textures[i])) changed |= kChangedMaterials;
  });
  for_each_edited(before.images, after.images, delta.images, [&](std::size_t i) {
    if (!differ(before.images[i], after.images[i])) return;
    changed |= kChangedMaterials;
    if (before.environment.image == int(i) || after.environment.image == int(i)) changed |= kChangedLights;
  });
  return changed;
}

}  // namespace

unsigned find_changed(const Scene& before, const Scene& after, const SceneDelta& delta) {
  unsigned changed = find_changed_meshes(before, after, delta);
  changed |= flag_where_different(before.shapes, after.shapes, delta.shapes, kChangedGeometry);
  changed |= find_changed_materials(before, after, delta);
  changed |= flag_where_different(before.cameras, after.cameras, delta.cameras, kChangedCamera);
  changed |= flag_where_different(before.lights, after.lights, delta.lights, kChangedLights);
  if (!delta.environment.empty()) changed |= kChangedLights;
  return changed | find_changed_nodes(before, after, delta);
}

}  // namespace parian

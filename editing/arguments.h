/// Checks of what commands are given. Each throws UsageError with what was expected.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace parian::edit {

[[noreturn]] inline void refuse(const std::string& reason) { throw UsageError(reason); }

/// `what` in the singular, as "node".
inline void check_index(int value, std::size_t size, const char* what) {
  if (value < 0 || std::size_t(value) >= size)
    refuse(fmt::format("{}: expected an index below {}, not {}", what, size, value));
}

inline void check_node(const Scene& scene, int node) { check_index(node, scene.nodes.size(), "node"); }

/// A node, or kNone, which stands for the top of the scene.
inline void check_parent(const Scene& scene, int parent) {
  if (parent != kNone) check_index(parent, scene.nodes.size(), "parent");
}

// What validate() has to say about one element; its references to others are not looked at.
void check_element(const Transform& transform);
void check_element(const Shape& shape);
void check_element(Material material);
void check_element(const Camera& camera);
void check_element(const Light& light);
void check_element(const Image& image);
void check_element(const Environment& environment);

}  // namespace parian::edit

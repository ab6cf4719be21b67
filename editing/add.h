/// Commands that add to a scene. What is refused is a UsageError, and then the scene is as it was. All return
/// the index of the new node.
#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace parian::edit {

/// Where a new node goes: behind the children of `parent` (kNone: the roots), and its transform there.
struct Place {
  int parent = kNone;
  Transform transform;
};

/// A node that shows the shape with the material; kNone: a new one, that of glTF's defaults but not metallic.
/// Lengths as `Shape` and validate() have them: metres, above 0; of a cylinder's radii one may be 0.
int add_shape(Scene& scene, const Shape& shape, const Place& place = {}, int material = kNone);

// The shapes by name, for add_shape(). Metres.
Shape sphere(float radius);
Shape box(const Vec3f& size);
Shape cylinder(float radius, float height);
Shape cone(float radius, float height);  // its tip above
Shape frustum(float radius_bottom, float radius_top, float height);
Shape plane(float size_x, float size_z);  // its front above

int add_light(Scene& scene, const Light& light, const Place& place = {});

/// A light of the kind with a name of its own: white; 1 W/sr, W/m^2 or radiance; 1 metre wide; spots of 45
/// degrees.
Light default_light(LightKind kind);

int add_camera(Scene& scene, const Camera& camera, const Place& place = {});

/// The camera at the top of the scene, seen from `eye` to `target` (metres, apart), `up` being above (any
/// length; along the view, another is taken).
int add_camera_from_view(Scene& scene, const Camera& camera, const Vec3f& eye, const Vec3f& target,
                         const Vec3f& up = {0, 1, 0});

/// An empty node.
int add_group(Scene& scene, std::string name, const Place& place = {});

/// The content of a valid scene, its roots below a new node of that name. Its environment replaces one that
/// is black.
int add_scene(Scene& scene, const Scene& other, std::string name, const Place& place = {});

}  // namespace parian::edit

/// camera_properties() and environment_properties().
#include <utility>

#include "editing/property_list.h"

namespace parian::edit {
namespace {

Spec length(const char* name, const char* label) { return {name, label, "m", kAboveZero, kMost, 0.01}; }

/// A file has planes for either projection, and a lens for perspective alone.
void set_projection(Camera& camera, Projection projection) {
  camera.projection = projection;
  if (projection == Projection::perspective) {
    if (!(camera.znear > 0)) camera.znear = Camera{}.znear;
    return;
  }
  camera.lens.reset();
  if (!(camera.zfar > camera.znear)) camera.zfar = camera.znear + 1000;
}

void add_projection(PropertyList<Camera>& list) {
  list.add(
      PropertyKind::choice, {"projection", "Projection"},
      [](const Camera& c) {
        return std::string(c.projection == Projection::perspective ? "perspective" : "orthographic");
      },
      [](Camera& c, const PropertyValue& v) {
        const bool perspective = std::get<std::string>(v) == "perspective";
        set_projection(c, perspective ? Projection::perspective : Projection::orthographic);
      },
      {"perspective", "orthographic"});
}

void add_lens(PropertyList<Camera>& list) {
  list.only_for([](const Camera& c) { return c.projection == Projection::perspective && c.lens; });
  list.number(
      {"lens.focal_length", "Focal length", "m", kAboveZero, kMost, 0.001},
      [](auto& c) -> auto& { return c.lens->focal_length; });
  list.number(
      {"lens.f_stop", "f-number", "", kAboveZero, kMost, 0.1},
      [](auto& c) -> auto& { return c.lens->f_stop; });
  list.number(
      length("lens.focus_distance", "Focus distance"),
      [](auto& c) -> auto& { return c.lens->focus_distance; });
  list.number(
      {"lens.sensor_width", "Sensor width", "m", kAboveZero, kMost, 0.001},
      [](auto& c) -> auto& { return c.lens->sensor_size[0]; });
  list.number(
      {"lens.sensor_height", "Sensor height", "m", kAboveZero, kMost, 0.001},
      [](auto& c) -> auto& { return c.lens->sensor_size[1]; });
}

Camera fresh_camera() {
  Camera camera;
  camera.lens.emplace();
  return camera;
}

/// The turn about y that the environment's rotation has in it (its twist), in degrees.
double turn_of(const Environment& e) {
  const Quatf& q = e.rotation;
  const double turn = 2 * std::atan2(double(q.v.y), double(q.r)) * kDegrees;
  return turn > 180 ? turn - 360 : turn < -180 ? turn + 360 : turn;
}

void set_turn(Environment& e, double degrees) {
  const double half = 0.5 * degrees / kDegrees;
  e.rotation = Quatf(float(std::cos(half)), 0, float(std::sin(half)), 0);
}

}  // namespace

std::vector<Property> camera_properties(const Camera& camera) {
  PropertyList<Camera> list(fresh_camera());
  list.name();
  add_projection(list);
  const Projection projection = camera.projection;
  list.only_for([projection](const Camera& c) { return c.projection == projection; });
  if (projection == Projection::orthographic) {
    list.number(
        length("xmag", "Half width"), [](auto& c) -> auto& { return c.xmag; });
    list.number(
        length("ymag", "Half height"), [](auto& c) -> auto& { return c.ymag; });
    return std::move(list).take();
  }
  list.angle(
      {"yfov", "Vertical angle", "degrees", 6e-5, 179.9999, 1}, [](auto& c) -> auto& { return c.yfov; });
  list.number(
      {"aspect", "Width over height (0: the picture's)", "", 0, kMost, 0.01},
      [](auto& c) -> auto& { return c.aspect; });
  list.part(
      "lens", "Thin lens", [](auto& c) -> auto& { return c.lens; });
  if (camera.lens) add_lens(list);
  return std::move(list).take();
}

std::vector<Property> environment_properties() {
  PropertyList<Environment> list(Environment{});
  list.radiance(
      {"color", "Colour", "", 0, 1}, {"radiance", "Radiance", "W/(m^2 sr)", 0, kMost, 0.1},
      [](auto& e) -> auto& { return e.radiance; });
  list.add(PropertyKind::angle, {"rotation", "Turn about y", "degrees", -180, 180, 5}, turn_of,
           [](Environment& e, const PropertyValue& v) { set_turn(e, std::get<double>(v)); });
  return std::move(list).take();
}

}  // namespace parian::edit

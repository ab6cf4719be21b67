/// What one solid costs against the same tessellated: CPU time per camera ray, and memory.
///
/// usage: shape_cost [REPEATS]      to be bound to one core
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "tests/bench/support/timing.h"
#include "tests/support/scenes.h"

namespace {

using namespace parian;

/// The outline of a solid of revolution, from the top to the bottom of the axis: x the radius, y the height.
using Outline = std::vector<Vec2f>;

Outline sphere_outline(int steps) {
  Outline outline;
  for (int i = 0; i <= steps; ++i) {
    const double theta = std::numbers::pi * i / steps;
    outline.emplace_back(i == 0 || i == steps ? 0.0f : float(std::sin(theta)), float(std::cos(theta)));
  }
  return outline;
}

/// The polyline through `corners` in `steps` parts of about one length.
Outline polyline(const Outline& corners, int steps) {
  float whole = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) whole += (corners[i] - corners[i - 1]).length();
  Outline outline{corners[0]};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vec2f side = corners[i] - corners[i - 1];
    const int parts = std::max(1, int(std::lround(float(steps) * side.length() / whole)));
    for (int k = 1; k <= parts; ++k) outline.push_back(corners[i - 1] + side * (float(k) / float(parts)));
  }
  return outline;
}

Primitive revolve(const Outline& outline, int sectors) {
  std::vector<Vec3f> positions;
  for (const Vec2f& q : outline)
    for (int i = 0; i < sectors; ++i) {
      const double phi = 2 * std::numbers::pi * i / sectors;
      positions.emplace_back(q.x * float(std::sin(phi)), q.y, q.x * float(std::cos(phi)));
    }
  std::vector<Triangle> triangles;
  const auto at = [&](std::size_t row, int i) {
    return std::uint32_t(row * std::size_t(sectors) + std::size_t(i % sectors));
  };
  for (std::size_t row = 0; row + 1 < outline.size(); ++row)
    for (int i = 0; i < sectors; ++i) {
      const std::uint32_t a = at(row, i), b = at(row, i + 1), c = at(row + 1, i), d = at(row + 1, i + 1);
      if (outline[row].x > 0) triangles.push_back({a, d, b});
      if (outline[row + 1].x > 0) triangles.push_back({a, c, d});
    }
  Primitive p;
  p.positions = std::move(positions);
  p.triangles = std::move(triangles);
  return p;
}

/// Camera rays of 512 x 512 pixels, in blocks of 4 x 4, at a solid of about radius 1 about the origin.
std::vector<RayPacket> camera_rays() {
  constexpr int kSize = 512, kBlock = 4;
  const Vec3f back = normalize(Vec3f(0.47f, 0.342f, 0.814f)), eye = back * 5;
  const Vec3f x = normalize(Vec3f(0, 1, 0).cross(back)), y = back.cross(x);
  const auto offset = [](int i) { return (2 * (float(i) + 0.5f) / float(kSize) - 1) * 0.17f; };
  std::vector<RayPacket> packets;
  for (int block = 0; block < (kSize / kBlock) * (kSize / kBlock); ++block) {
    packets.emplace_back();
    const int left = block % (kSize / kBlock) * kBlock, top = block / (kSize / kBlock) * kBlock;
    for (int i = 0; i < kBlock * kBlock; ++i) {
      const float u = offset(left + i % kBlock), v = offset(top + i / kBlock);
      packets.back().add({eye, normalize(x * u + y * v - back)}, std::uint32_t(i));
    }
  }
  return packets;
}

std::size_t trace_singly(const Accel& accel, const std::vector<RayPacket>& packets) {
  std::size_t hits = 0;
  Hit hit;
  for (const RayPacket& packet : packets)
    for (int i = 0; i < packet.count; ++i) hits += accel.intersect(packet.ray(i), packet.random[i], hit);
  return hits;
}

std::size_t trace_packets(const Accel& accel, const std::vector<RayPacket>& packets) {
  std::size_t hits = 0;
  std::array<Hit, RayPacket::kSize> found;
  for (const RayPacket& packet : packets) {
    accel.intersect(packet, found);
    for (int i = 0; i < packet.count; ++i) hits += found[std::size_t(i)].placement != Hit::kMiss;
  }
  return hits;
}

struct Form {
  std::string name;
  std::unique_ptr<TimedBuild> built;
  std::vector<double> singly, packets;  // nanoseconds per ray
  std::size_t hits = 0;
};

Form make_form(std::string name, Scene scene) {
  Form form{std::move(name), std::make_unique<TimedBuild>(), {}, {}, 0};
  form.built->scene = std::move(scene);
  form.built->scene.materials.emplace_back();
  form.built->build();
  return form;
}

std::vector<Form> make_forms(const std::string& name, const Shape& shape,
                             const std::function<Outline(int)>& outline) {
  std::vector<Form> forms;
  Scene solid;
  solid.shapes = {shape};
  Node node;
  node.shape = node.shape_material = 0;
  add_root(solid, std::move(node));
  forms.push_back(make_form(name, std::move(solid)));
  for (const int steps : {16, 159}) {
    Scene mesh;
    Primitive primitive = revolve(outline(steps), 2 * steps);
    const std::size_t triangles = primitive.triangles.size();
    add_mesh(mesh, std::move(primitive), 0);
    forms.push_back(make_form(fmt::format("{} of {} triangles", name, triangles), std::move(mesh)));
  }
  return forms;
}

void compare_forms(std::vector<Form> forms, const std::vector<RayPacket>& packets, int repeats) {
  constexpr int kPasses = 4;
  const double rays = double(packets.size()) * RayPacket::kSize * kPasses;
  for (int repeat = 0; repeat < repeats; ++repeat)
    for (Form& form : forms)
      for (const bool alone : {true, false}) {
        const Accel& accel = *form.built->accel;
        std::size_t& hits = form.hits;
        double spent = 0;
        for (int pass = 0; pass < kPasses; ++pass)
          spent += time_work(
              [&] { return alone ? trace_singly(accel, packets) : trace_packets(accel, packets); }, hits);
        (alone ? form.singly : form.packets).push_back(spent / rays * 1e9);
      }
  for (const Form& form : forms) {
    const auto [low, high] = std::ranges::minmax(form.singly);
    const auto [packet_low, packet_high] = std::ranges::minmax(form.packets);
    fmt::print("| {} | {:.1f} ({:.1f} to {:.1f}) | {:.1f} ({:.1f} to {:.1f}) | {} | {:.1f}% |\n", form.name,
               median(form.singly), low, high, median(form.packets), packet_low, packet_high,
               form.built->accel->bytes(), 100 * double(form.hits) / (2 * rays * repeats));
  }
  std::fflush(stdout);
}

void measure_single(int repeats) {
  const std::vector<RayPacket> packets = camera_rays();
  const Shape sphere = make_sphere(1), cylinder = make_cylinder(1, 1, 2), cone = make_cylinder(1, 0, 2);
  fmt::print(
      "| | ns per ray, alone | ns per ray, packets of 16 | bytes of Embree | hit |\n|---|---|---|---|---|\n");
  compare_forms(make_forms("sphere", sphere, sphere_outline), packets, repeats);
  compare_forms(make_forms("cylinder", cylinder,
                           [](int steps) {
                             return polyline({{0, 1}, {1, 1}, {1, -1}, {0, -1}}, steps);
                           }),
                packets, repeats);
  compare_forms(make_forms("cone", cone,
                           [](int steps) {
                             return polyline({{0, 1}, {1, -1}, {0, -1}}, steps);
                           }),
                packets, repeats);
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 5;
  if (repeats < 1) {
    fmt::print(stderr, "usage: {} [REPEATS]\n", argv[0]);
    return 2;
  }
  measure_single(repeats);
  return 0;
}

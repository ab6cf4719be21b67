/// How long it takes until an edit shows, as an editor would have it: milliseconds from Session::update() to
/// the first complete frame, while it renders; how long cancelling takes, and a look at the picture.
///
/// usage: edit_latency SCENE [WIDTH HEIGHT [REPEATS]]
/// SCENE: a file; or a number: so many nodes, each a box.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "integrators/integrators.h"
#include "renderer/session/session.h"
#include "scene_io/gltf/gltf.h"
#include "tests/bench/support/timing.h"
#include "tests/support/scenes.h"

namespace {

using namespace parian;

double now() { return seconds(CLOCK_MONOTONIC); }

struct Kind {
  std::string name;
  unsigned changed;
  // Makes the edit number i of an original scene.
  std::function<void(Scene&, int)> apply;
};

/// A node that shows a mesh; the last one.
int mesh_node(const Scene& scene) {
  int found = 0;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (scene.nodes[i].mesh != kNone) found = int(i);
  return found;
}

void move(Node& node, float by) {
  if (node.transform.matrix)
    (*node.transform.matrix)[3][0] += by;
  else
    node.transform.translation.x += by;
}

int add_sphere(Scene& scene, int i) {
  const int material = add_material(scene, make_lambert({0.2f, 0.5f, 0.8f}));
  return add_shape(scene, make_sphere(0.1f), material, translate({0.01f * float(i), 0.3f, 0}));
}

/// Another mesh each time; a million triangles.
void add_million(Scene& scene, int i) {
  Primitive sphere = make_uv_sphere({0, 0, 0}, 0.2f, 708);
  add_mesh(scene, std::move(sphere), 0, translate({0.01f * float(i), 0.5f, 0}));
}

std::vector<Kind> make_kinds() {
  return {
      {"move an object", kChangedTransforms,
       [](Scene& s, int i) { move(s.nodes[std::size_t(mesh_node(s))], 0.001f * float(i + 1)); }},
      {"change a material", kChangedMaterials,
       [](Scene& s, int i) { s.materials[0].base_color = Rgb(0.01f * float(i), 0.5f, 0.5f); }},
      {"make a material transparent", kChangedMaterials,
       [](Scene& s, int i) {
         s.materials[0].alpha_mode = i % 2 ? AlphaMode::opaque : AlphaMode::blend;
         s.materials[0].alpha = 0.5f;
       }},
      {"change the light", kChangedLights,
       [](Scene& s, int i) { s.environment.radiance = Rgb(0.1f + 0.01f * float(i)); }},
      {"add a lamp", kChangedGeometry | kChangedLights,
       [](Scene& s, int i) {
         Light lamp;
         lamp.kind = LightKind::rectangle;
         add_light(s, lamp, translate({0.01f * float(i), 1, 0}));
       }},
      {"move the camera", kChangedCamera,
       [](Scene& s, int i) {
         for (Node& node : s.nodes)
           if (node.camera != kNone) move(node, 0.001f * float(i + 1));
       }},
      {"add a sphere", kChangedGeometry, [](Scene& s, int i) { add_sphere(s, i); }},
      {"duplicate an object", kChangedGeometry,
       [](Scene& s, int i) {
         Node copy = s.nodes[std::size_t(mesh_node(s))];
         move(copy, 0.01f * float(i + 1));
         add_root(s, copy);
       }},
      {"remove an object, and have it back", kChangedGeometry,
       [](Scene& s, int i) {
         if (i % 2 == 0) s.nodes[std::size_t(mesh_node(s))].mesh = kNone;
       }},
      {"add a mesh of 1 M triangles", kChangedGeometry, add_million},
  };
}

/// Nodes in a cube, all of one mesh, below the nodes of its layers.
Scene make_boxes(int count) {
  Scene scene;
  add_mesh(scene, make_box({0, 0, 0}, {0.5f, 0.5f, 0.5f}), add_material(scene, make_lambert(Rgb(0.7f))));
  const int side = int(std::ceil(std::cbrt(double(count))));
  int layer = 0;
  for (int i = 1; i < count; ++i) {
    if (i % (side * side) == 1) layer = add_root(scene, {});
    Node node;
    node.mesh = 0;
    node.transform = translate(Vec3f(float(i % side), float(i / side % side), float(i / side / side)));
    scene.nodes[std::size_t(layer)].children.push_back(int(scene.nodes.size()));
    scene.nodes.push_back(node);
  }
  return scene;
}

struct Times {
  std::vector<double> values;  // seconds
  std::string text() const {
    return fmt::format("{:.0f} | {:.0f}", 1e3 * median(values), 1e3 * *std::ranges::max_element(values));
  }
};

void wait_for_frame(const Session& session, std::uint64_t frames) {
  while (session.frames() <= frames) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

/// Until the picture of an edit, with all of what the edit takes. What is rendered before is at rest.
void measure_kind(Session& session, const Scene& original, const Kind& kind, int repeats) {
  Times frame, call, inside, cancel;
  int coarse = 0;
  const int width = session.beauty().width;
  for (int i = 0; i < repeats; ++i) {
    auto scene = std::make_shared<Scene>(original);
    kind.apply(*scene, i);
    std::this_thread::sleep_for(std::chrono::milliseconds(300 + 37 * (i % 5)));
    const std::uint64_t frames = session.frames();
    const double start = now();
    session.update(scene, kind.changed);
    call.values.push_back(now() - start);
    // The frame in progress may end after the edit was asked for; then it is one more.
    wait_for_frame(session, frames);
    frame.values.push_back(now() - start);
    inside.values.push_back(session.stats().edit_seconds);
    coarse += session.beauty().width < width;
    // Cancelling at any moment: during the first frames, later, while it builds.
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * (i % 20)));
    if (i % 3 == 0) session.update(std::make_shared<Scene>(original), kind.changed);
    if (i % 6 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(3 * (i % 20)));
    const double before = now();
    session.cancel();
    cancel.values.push_back(now() - before);
    session.update(std::make_shared<Scene>(original), kind.changed);
    session.start();
    wait_for_frame(session, session.frames());
  }
  fmt::print("| {} | {} | {} | {} | {} | {} |\n", kind.name, frame.text(), inside.text(), call.text(),
             cancel.text(), coarse);
  std::fflush(stdout);
}

void measure_looks(const Session& session) {
  Times all, beauty;
  for (int i = 0; i < 20; ++i) {
    double start = now();
    session.snapshot();
    all.values.push_back(now() - start);
    start = now();
    session.beauty();
    beauty.values.push_back(now() - start);
  }
  fmt::print("\nms, median | worst: snapshot() {}; beauty() {}\n", all.text(), beauty.text());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} SCENE [WIDTH HEIGHT [REPEATS]]\n", argv[0]);
    return 2;
  }
  RenderSettings settings;
  settings.width = argc > 3 ? std::atoi(argv[2]) : 640;
  settings.height = argc > 3 ? std::atoi(argv[3]) : 360;
  settings.spp = kNoLimit;
  settings.accel.editable = true;
  settings.first_frame = 0.05;
  const int repeats = argc > 4 ? std::atoi(argv[4]) : 20;
  std::vector<std::string> warnings;
  const int boxes = std::atoi(argv[1]);
  Scene scene = boxes > 0 ? make_boxes(boxes) : load_scene({argv[1]}, {}, warnings);
  add_missing_camera_and_light(scene);
  const double start = now();
  Session session(std::make_shared<Scene>(scene), settings, make_integrator("path", {}));
  session.start();
  wait_for_frame(session, 0);
  fmt::print("{} x {}; from the loaded scene to the first frame {:.0f} ms\n\n", settings.width,
             settings.height, 1e3 * (now() - start));
  fmt::print(
      "| edit | first frame, ms | worst | of it rebuilding | worst | update() | worst | cancel() | worst | "
      "coarse |\n|---|---|---|---|---|---|---|---|---|---|\n");
  std::this_thread::sleep_for(std::chrono::seconds(1));
  for (const Kind& kind : make_kinds()) measure_kind(session, scene, kind, repeats);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  measure_looks(session);
  const SessionStats stats = session.stats();
  fmt::print("primitives built {}, better {}, top levels {}, light tables {}\n", stats.builds.meshes,
             stats.builds.refined, stats.builds.top_level, stats.light_builds);
  return 0;
}

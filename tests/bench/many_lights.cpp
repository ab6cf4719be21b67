/// What a sample of a light and a density cost by their number, in a room lit by many small triangles, and
/// what the table takes to build. What the choices leave of noise is in scripts/chart_lights.py.
///
/// usage: many_lights [LIGHTS...]
/// Writes to standard output, for so many lights (by default 2 to a million) chosen by power and by the tree:
/// seconds to build the table on one thread and on all, in CPU time on all, the least of three; its bytes for
/// each light, those predicted, and by how much the memory of the process grew at most meanwhile; the tree's
/// depth; nanoseconds of a sample and of a density.
#include <fmt/format.h>
#include <sys/resource.h>

#include <cstdlib>
#include <memory>
#include <random>

#include "renderer/base/parallel.h"
#include "renderer/light/light_table.h"
#include "tests/bench/support/timing.h"

namespace {

using namespace parian;

constexpr float kSide = 10, kHeight = 3;

/// A room with a floor and two walls that do not shine, and `count` triangles that do: half of them on a grid
/// below the ceiling, the others anywhere and any way round. Their radiances differ by up to a thousand.
Scene make_room(int count) {
  std::mt19937 engine(7);
  const auto uniform = [&] { return to_unit_float(std::uint32_t(engine())); };
  Scene scene;
  Material wall;
  wall.base_color = {0.7f, 0.7f, 0.7f};
  wall.metallic = 0;
  scene.materials.push_back(wall);
  Mesh mesh;
  Primitive room;
  room.positions = std::vector<Vec3f>{{0, 0, 0},       {kSide, 0, 0},       {kSide, 0, kSide},  {0, 0, kSide},
                                      {0, kHeight, 0}, {kSide, kHeight, 0}, {0, kHeight, kSide}};
  room.triangles = std::vector<Triangle>{{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {0, 6, 3}, {0, 4, 6}};
  room.material = 0;
  mesh.primitives.push_back(room);

  constexpr int kRadiances = 16;
  std::vector<std::vector<Vec3f>> positions(kRadiances);
  const float size = 0.3f * kSide / std::sqrt(float(count));
  const int row = std::max(1, int(std::ceil(std::sqrt(float(count) / 2))));
  for (int i = 0; i < count; ++i) {
    Vec3f center(uniform() * kSide, 0.3f + uniform() * (kHeight - 0.6f), uniform() * kSide);
    const float z = 2 * uniform() - 1, phi = 2 * kPi * uniform(), r = std::sqrt(1 - z * z);
    Vec3f normal(r * std::cos(phi), z, r * std::sin(phi));
    if (i % 2 == 0) {
      center = {(float(i / 2 % row) + 0.5f) * kSide / float(row), kHeight - 0.1f,
                (float(i / 2 / row) + 0.5f) * kSide / float(row)};
      normal = {0, -1, 0};
    }
    const Frame frame = make_frame(normal);
    auto& out = positions[std::size_t(uniform() * kRadiances)];
    // Above the floor as a whole.
    const float extent = std::min(size, 0.4f * center.y);
    for (const Vec2f& at : {Vec2f(-1, -1), Vec2f(1, -1), Vec2f(0, 1)})
      out.push_back(center + (frame.x * at.x + frame.y * at.y) * (extent * 0.4f));
  }
  for (int k = 0; k < kRadiances; ++k) {
    Material material;
    material.base_color = {0, 0, 0};
    material.emission = Rgb(std::pow(1000.0f, float(k) / kRadiances));
    scene.materials.push_back(material);
    if (positions[k].empty()) continue;
    Primitive lights;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < positions[k].size(); i += 3) triangles.push_back({i, i + 1, i + 2});
    lights.positions = std::move(positions[k]);
    lights.triangles = std::move(triangles);
    lights.material = k + 1;
    mesh.primitives.push_back(std::move(lights));
  }
  scene.meshes.push_back(std::move(mesh));
  Node node;
  node.mesh = 0;
  scene.nodes.push_back(node);
  scene.roots.push_back(0);
  return scene;
}

/// The most memory that the process ever had, in bytes.
double peak_bytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024;
}

/// Seconds that building a table takes: on one thread, on all, and the CPU's on all.
std::array<double, 3> time_build(const Scene& scene, const World& world, LightChoice choice) {
  std::array<double, 3> least{1e9, 1e9, 1e9};
  const int threads = hardware_threads();
  for (int run = 0; run < 6; ++run) {
    const bool all = run % 2 == 0;
    set_thread_count(all ? threads : 1);
    const double start = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    const LightTable table(scene, world, choice);
    const double wall = seconds(CLOCK_MONOTONIC) - start;
    double& kept = least[all ? 1 : 0];
    kept = std::min(kept, wall);
    if (all) least[2] = std::min(least[2], seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu);
  }
  set_thread_count(threads);
  return least;
}

void measure(int lights) {
  const Scene scene = make_room(lights);
  const World world = make_world(scene);
  std::mt19937 engine(3);
  std::vector<Receiver> receivers;
  std::vector<Hit> hits;
  std::vector<Vec2f> numbers;
  for (int i = 0; i < 20000; ++i) {
    const auto uniform = [&] { return to_unit_float(std::uint32_t(engine())); };
    const float x = uniform() * kSide, z = uniform() * kSide;
    receivers.push_back({{x, 0, z}, {0, 1, 0}});
    const auto& primitives = scene.meshes[0].primitives;
    const auto k = 1 + std::uint32_t(uniform() * float(primitives.size() - 1));
    hits.push_back({1, 0, 0, 0, k, std::uint32_t(uniform() * float(primitives[k].triangles.size()))});
    const float u = uniform();
    numbers.emplace_back(u, uniform());
  }
  for (const LightChoice choice : {LightChoice::power, LightChoice::tree}) {
    const double before = peak_bytes();
    const LightTable table(scene, world, choice);
    const double grown = peak_bytes() - before;
    const std::array<double, 3> built = time_build(scene, world, choice);
    const LightTableBytes predicted = light_table_bytes(std::size_t(table.size()), choice, 16);
    std::vector<double> sample_times, pdf_times;
    double sum = 0;
    for (int run = 0; run < 7; ++run) {
      std::size_t found = 0;
      sample_times.push_back(time_work(
          [&] {
            std::size_t count = 0;
            for (std::size_t i = 0; i < receivers.size(); ++i) {
              Sampler sampler(SamplerKind::sobol, 1, std::uint32_t(i));
              count += table.sample(receivers[i], numbers[i], sampler).has_value();
            }
            return count;
          },
          found));
      pdf_times.push_back(time_work(
          [&] {
            for (std::size_t i = 0; i < receivers.size(); ++i)
              sum += table.pdf_triangle(hits[i], receivers[i], 0.5f);
            return std::size_t(0);
          },
          found));
    }
    const double to_ns = 1e9 / double(receivers.size()), one = 1.0 / double(table.size());
    fmt::print(
        "{} lights, {}: built in {:.3f} s, all threads {:.3f} s, CPU {:.3f} s; bytes each {:.1f}, predicted "
        "{:.1f}, at most {:.1f}, grown {:.1f}; depth {}; sample {:.0f} ns, density {:.0f} ns (mean {:.3g})\n",
        table.size(), choice == LightChoice::tree ? "tree" : "power", built[0], built[1], built[2],
        double(table.bytes()) * one, double(predicted.held) * one, double(predicted.peak) * one, grown * one,
        table.chooser().tree().depth(), median(sample_times) * to_ns, median(pdf_times) * to_ns,
        sum / (7 * double(receivers.size())));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> counts{2, 4, 6, 10, 100, 10000, 1000000};
  if (argc > 1) counts.clear();
  for (int i = 1; i < argc; ++i) counts.push_back(std::atoi(argv[i]));
  for (const int lights : counts) measure(lights);
  return 0;
}

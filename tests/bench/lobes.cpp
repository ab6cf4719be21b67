/// What the lobes cost: nanoseconds of CPU time for eval(), which gives f and density together, and for
/// sample(), which gives the density of what it finds; and what they cost as the BSDF of a surface.
///
/// usage: lobes [OPTIONS OF GOOGLE BENCHMARK]      to be bound to one core
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "materials/bsdf.h"
#include "renderer/base/random.h"
#include "tests/bench/support/timing.h"
#include "tests/support/scenes.h"

namespace {

using namespace parian;

/// What one call gets: more of them than a processor can learn the branches of.
struct Input {
  Vec3f wo, wi, below;  // below: wi, every second time beyond the surface
  float u1;
  Vec2f u2;
};

std::vector<Input> draw_inputs() {
  std::vector<Input> inputs;
  Sampler random(SamplerKind::independent, 1, 0, 0, 0);
  for (int i = 0; i < 4096; ++i) {
    Input in;
    in.wo = sample_cosine_hemisphere(random.next2());
    in.wi = sample_sphere(random.next2());
    in.wi.z = std::abs(in.wi.z);
    in.below = {in.wi.x, in.wi.y, i % 2 ? in.wi.z : -in.wi.z};
    in.u1 = random.next1();
    in.u2 = random.next2();
    if (in.wo.z > 0 && in.wi.z > 0) inputs.push_back(in);
  }
  return inputs;
}

const std::vector<Input> kInputs = draw_inputs();

/// Calls once a round with the next input.
template <class Call>
void time_calls(benchmark::State& state, const Call& call) {
  std::size_t i = 0;
  for (auto _ : state) {
    auto value = call(kInputs[i], i);
    benchmark::DoNotOptimize(value);
    if (++i == kInputs.size()) i = 0;
  }
}

/// A row of a table, and its benchmarks, "COLUMN/NAME".
struct Row {
  std::string name;
  std::size_t bytes;
};

template <class Call>
void add_benchmark(const std::string& column, const std::string& row, const Call& call) {
  // Short and many: the least of them is one that nothing disturbed.
  benchmark::RegisterBenchmark((column + "/" + row).c_str(), call)->MinTime(0.003)->Repetitions(60);
}

/// Of a lobe alone. `transmits`: half of the directions to the light are below.
template <Lobe T>
void add_calls(const std::string& kind, const std::string& name, const T& constant, bool transmits) {
  add_benchmark("eval" + kind, name, [constant, transmits](benchmark::State& state) {
    T lobe = constant;
    benchmark::DoNotOptimize(lobe);  // its numbers are not known to the compiler
    if (transmits)
      time_calls(state, [&](const Input& in, std::size_t) { return lobe.eval(in.wo, in.below); });
    else
      time_calls(state, [&](const Input& in, std::size_t) { return lobe.eval(in.wo, in.wi); });
  });
  add_benchmark("sample" + kind, name, [constant](benchmark::State& state) {
    T lobe = constant;
    benchmark::DoNotOptimize(lobe);
    time_calls(state, [&](const Input& in, std::size_t) { return lobe.sample(in.wo, in.u1, in.u2); });
  });
}

/// Single scattering, and compensated where that is another lobe.
template <Lobe T>
Row add_lobe(const std::string& name, const T& lobe, bool transmits = false) {
  add_calls("", name, lobe, transmits);
  return {name, sizeof(T)};
}
template <Lobe T>
Row add_rough_lobe(const std::string& name, const T& lobe, bool transmits = false) {
  add_calls(" compensated", name, make_compensated(lobe), transmits);
  return add_lobe(name, lobe, transmits);
}

const Rgb kBase(0.8f, 0.5f, 0.3f), kGoldEta(0.143f, 0.374f, 1.442f), kGoldK(3.983f, 2.386f, 1.603f);

MetallicRoughness make_metallic_roughness(float metallic) {
  return {kBase, metallic, Rgb(0.04f), 1, {0.25f}};
}
Dielectric make_dielectric(float alpha, bool thin) { return {1.5f, Rgb(1), {alpha}, thin, Rgb(0.04f), 1}; }
Layered make_plain_layers() {
  return {0.2f, kBase, {kBase, Rgb(0)}, 0, make_dielectric(0.25f, true), {0.25f, 0.25f}};
}

void add_transmission(Layered& l) {
  l.transmission = 0.5f;
  l.dielectric.thin = false;
}
void add_diffuse_transmission(Layered& l) { l.diffuse = {kBase * 0.5f, kBase * 0.5f}; }
void add_anisotropy(Layered& l) {
  l.facets.alpha_x = 0.6f;
  l.tangent = {0.6f, 0.8f};
}
void add_iridescence(Layered& l) {
  l.iridescence = 1;
  l.film_ior = 1.4f;
  l.film_thickness = 350;
}
void add_sheen(Layered& l) { l.sheen = {kBase, 0.3f}; }
void add_coat(Layered& l) {
  l.coat = 1;
  l.coat_ggx = {0.1f};
}

std::vector<Row> add_lobes() {
  std::vector<Row> rows;
  rows.push_back(add_lobe("Lambert", Lambert{kBase}));
  rows.push_back(add_lobe("DiffuseTransmissionLobe", DiffuseTransmissionLobe{kBase, kBase}, true));
  rows.push_back(add_lobe("Phong", Phong{kBase, Rgb(0.2f), 50}));
  rows.push_back(add_lobe("Sheen", Sheen{kBase, 0.3f}));
  for (const auto& [name, lobe] :
       {std::pair("dielectric", make_metallic_roughness(0)), std::pair("metal", make_metallic_roughness(1))})
    rows.push_back(add_rough_lobe(fmt::format("MetallicRoughness, {}", name), lobe));
  rows.push_back(add_lobe("Conductor, mirror", Conductor{kGoldEta, kGoldK, {0}}));
  rows.push_back(add_rough_lobe("Conductor, rough", Conductor{kGoldEta, kGoldK, {0.25f}}));
  rows.push_back(add_lobe("Dielectric, smooth", make_dielectric(0, false), true));
  rows.push_back(add_rough_lobe("Dielectric, rough", make_dielectric(0.25f, false), true));
  rows.push_back(add_lobe("Dielectric, thin, smooth", make_dielectric(0, true), true));
  rows.push_back(add_rough_lobe("Dielectric, thin, rough", make_dielectric(0.25f, true), true));
  Layered all = make_plain_layers();
  rows.push_back(add_rough_lobe("Layered, nothing added", all));
  const std::pair<const char*, void (*)(Layered&)> extensions[] = {
      {"transmission", add_transmission},
      {"diffuse transmission", add_diffuse_transmission},
      {"anisotropy", add_anisotropy},
      {"iridescence", add_iridescence},
      {"sheen", add_sheen},
      {"coat", add_coat}};
  for (const auto& [name, add] : extensions) {
    Layered one = make_plain_layers();
    add(one);
    add(all);
    rows.push_back(add_rough_lobe(fmt::format("Layered, {}", name), one, one.transmits()));
  }
  rows.push_back(add_rough_lobe("Layered, all of these", all, true));
  return rows;
}

/// Surfaces of a material, seen from the inputs' directions; at a fixed address. As few as stay in the
/// first-level cache, where the path has its own.
struct Surfaces {
  static constexpr std::size_t kCount = 64;
  Scene scene;
  World world;
  std::vector<Surface> seen;
  std::vector<Bsdf> bsdfs;
  Microfacets microfacets;
  float eta;

  Surfaces(const Material& material, Microfacets m)
      : microfacets(m), eta(material.has_interior() ? material.ior : 1) {
    scene.materials = {material};
    add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);
    world = make_world(scene);
    for (std::size_t i = 0; i < kCount; ++i)
      seen.push_back(make_surface(scene, world, {1, 0.2f, 0.3f, 0, 0, 0}, -kInputs[i].wo));
    for (const Surface& s : seen) bsdfs.push_back(make(s));
  }
  Surfaces(const Surfaces&) = delete;

  Bsdf make(const Surface& s) const { return make_bsdf(scene, s, microfacets, eta); }
};

void add_material_calls(const std::string& kind, const std::string& name, const Material& material,
                        Microfacets microfacets) {
  const auto surfaces = std::make_shared<const Surfaces>(material, microfacets);
  const auto nth = [](const auto& values, std::size_t i) -> const auto& {
    return values[i % Surfaces::kCount];
  };
  const bool transmits = surfaces->bsdfs[0].transmits();
  const auto direction = [transmits](const Input& in) { return transmits ? in.below : in.wi; };
  const auto add = [&](const std::string& column, const auto& call) {
    add_benchmark(column + kind, name, [call](benchmark::State& state) { time_calls(state, call); });
  };
  add("make_bsdf", [=](const Input&, std::size_t i) { return surfaces->make(nth(surfaces->seen, i)); });
  add("Bsdf::eval",
      [=](const Input& in, std::size_t i) { return nth(surfaces->bsdfs, i).eval(direction(in)); });
  add("Bsdf::sample",
      [=](const Input& in, std::size_t i) { return nth(surfaces->bsdfs, i).sample(in.u1, in.u2); });
  // What a bounce does: light that is sampled, and a direction to go on.
  add("bounce", [=](const Input& in, std::size_t i) {
    const Bsdf bsdf = surfaces->make(nth(surfaces->seen, i));
    return std::pair(bsdf.eval(direction(in)), bsdf.sample(in.u1, in.u2));
  });
}

Row add_material(const std::string& name, const Material& material, bool has_facets) {
  add_material_calls("", name, material, Microfacets::single);
  if (has_facets) add_material_calls(" compensated", name, material, Microfacets::compensated);
  return {name, 0};
}

std::vector<Row> add_materials() {
  Material plain;
  plain.base_color = kBase;
  plain.metallic = 0;
  plain.roughness = 0.5f;
  std::vector<Row> rows;
  const auto add = [&](const char* name, bool has_facets, const auto& change) {
    Material m = plain;
    change(m);
    rows.push_back(add_material(name, m, has_facets));
  };
  const auto glass = [](float roughness) {
    return [roughness](Material& m) {
      m.roughness = roughness;
      m.transmission = Transmission{.factor = 1, .texture = {}};
      m.volume = Volume{.thickness = 1};
    };
  };
  add("Lambert", false, [](Material& m) { m.specular = 0; });
  add("metallic-roughness, dielectric", true, [](Material&) {});
  add("metallic-roughness, metal", true, [](Material& m) { m.metallic = 1; });
  add("Phong", false, [](Material& m) { m.phong = PhongModel{kBase, Rgb(0.2f), 50}; });
  add("conductor, rough", true, [](Material& m) { m.conductor = ConductorModel{kGoldEta, kGoldK}; });
  add("glass, smooth", false, glass(0));
  add("glass, rough", true, glass(0.5f));
  add("clear coat", true, [](Material& m) {
    m.clearcoat.emplace();
    m.clearcoat->factor = 1;
    m.clearcoat->roughness = 0.3f;
  });
  return rows;
}

/// Prints the tables when all has run.
class Tables : public benchmark::BenchmarkReporter {
 public:
  Tables(std::vector<Row> lobes, std::vector<Row> materials)
      : lobes_(std::move(lobes)), materials_(std::move(materials)) {}

  bool ReportContext(const Context&) override { return true; }

  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      if (run.run_type == Run::RT_Iteration)
        times_[run.run_name.function_name].push_back(run.GetAdjustedCPUTime());
  }

  void Finalize() override {
    print_table("lobe | bytes", lobes_, {"eval", "sample"});
    fmt::print("\n`Bsdf` has {} bytes.\n\n", sizeof(Bsdf));
    print_table("material", materials_, {"make_bsdf", "Bsdf::eval", "Bsdf::sample", "bounce"});
    std::vector<double> ratios;
    for (const auto& [name, times] : times_) ratios.push_back(median(times) / std::ranges::min(times));
    if (!ratios.empty())
      fmt::print("\nMedians are {:.2f} to {:.2f} times these, in the middle {:.2f}.\n",
                 std::ranges::min(ratios), std::ranges::max(ratios), median(ratios));
    std::fflush(stdout);
  }

 private:
  /// Each column without compensation and with it.
  void print_table(const char* first, const std::vector<Row>& rows,
                   const std::vector<std::string>& columns) const {
    std::string head = fmt::format("| {} |", first), rule = rows[0].bytes > 0 ? "|---|---|" : "|---|";
    for (const std::string& column : columns) {
      head += fmt::format(" {}, ns | compensated |", column);
      rule += "---|---|";
    }
    fmt::print("{}\n{}\n", head, rule);
    for (const Row& row : rows) {
      fmt::print("| {} |", row.name);
      if (row.bytes > 0) fmt::print(" {} |", row.bytes);
      for (const std::string& column : columns)
        fmt::print(" {} | {} |", cell(column, row), cell(column + " compensated", row));
      fmt::print("\n");
    }
  }

  /// The least.
  std::string cell(const std::string& column, const Row& row) const {
    const auto found = times_.find(column + "/" + row.name);
    if (found == times_.end()) return "";
    return fmt::format("{:.1f}", std::ranges::min(found->second));
  }

  std::vector<Row> lobes_, materials_;
  std::map<std::string, std::vector<double>> times_;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  Tables tables(add_lobes(), add_materials());
  benchmark::RunSpecifiedBenchmarks(&tables);
  return 0;
}

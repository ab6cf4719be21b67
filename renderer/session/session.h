/// The progressive render loop over one scene: start, cancel, wait, look, edit. The command line and the
/// editor are clients of this and of nothing below.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "renderer/base/parallel.h"
#include "renderer/film/filter.h"
#include "renderer/scene/camera.h"
#include "renderer/session/integrator.h"
#include "renderer/session/tiles.h"

namespace parian {

inline constexpr std::uint32_t kNoLimit = 0xffffffffu;

struct RenderSettings {
  int width = 960, height = 540;
  int camera = 0;          // index into World::cameras
  std::uint32_t spp = 64;  // samples for each pixel; kNoLimit: as many as there is time for
  // What ends a render, whichever comes first. With a target of noise the samples go where they are needed,
  // and spp is their mean.
  double seconds = 0;  // > 0: of rendering
  double noise = 0;    // > 0: bound of the picture's relative error (Noise::bound)
  std::uint32_t seed = 0;
  SamplerKind sampler = SamplerKind::sobol;
  FilterKind filter = FilterKind::blackman_harris;
  FilmLayers layers;
  std::size_t memory_afterwards = 0;  // what the process will take beside it all once the picture is there
  AccelSettings accel;                // but for the quality, which is
  std::optional<BuildQuality> build;  // absent: what pays
  LightChoice light_choice = LightChoice::tree;
  Tiling tiling;
  Partitioner partitioner = Partitioner::simple;
};

/// What an edit touched, or-ed together.
enum Changed : unsigned {
  kChangedCamera = 1,      // cameras, or the placement of nodes that carry only cameras
  kChangedMaterials = 2,   // anything of materials, textures and images
  kChangedLights = 4,      // lights and environment, their number and kind included
  kChangedTransforms = 8,  // node transforms
  kChangedGeometry = 16,   // nodes or meshes added, removed, re-linked or reshaped
};

struct Progress {
  std::uint32_t samples = 0, total = 0;  // samples every pixel has at least, and will have at most
  double seconds = 0;                    // spent rendering
  double done = 0;                       // share of the whole render, estimated, 0 to 1
  bool running = false;
};

struct SessionStats {
  double build_seconds = 0, render_seconds = 0, render_cpu_seconds = 0;
  RayCounts rays;
  std::size_t predicted_peak = 0;  // of the process's memory, bytes, before anything was built
  BuildQuality quality = BuildQuality::balanced;
  bool compact = false;
  std::size_t accel_bytes = 0, triangles = 0, solids = 0;  // triangles as stored, each mesh once
  BuildCounts builds;
  int light_builds = 0;
  std::size_t light_bytes = 0;     // of the light table
  double light_build_seconds = 0;  // the last time that it was built
};

class Session {
 public:
  /// Builds everything for a valid scene that has the camera asked for. Throws std::runtime_error where that
  /// does not fit into memory.
  Session(std::shared_ptr<const Scene> scene, const RenderSettings& settings,
          std::unique_ptr<Integrator> integrator);
  ~Session();  // cancels

  /// Renders in the background until settings.spp, the time limit or cancel(). Goes on from the film as it
  /// is.
  void start();
  /// Ends rendering within some milliseconds: tiles in progress are given up.
  void cancel();
  /// Until the render has ended by itself or was cancelled. Rethrows what stopped it.
  void wait();

  Progress progress() const;
  /// The picture so far; rendering goes on.
  Picture snapshot() const { return film_->resolve(); }
  Film& film() { return *film_; }
  const Film& film() const { return *film_; }
  SessionStats stats() const;
  const World& world() const { return *world_; }

  /// Takes an edited scene, rebuilds what `changed` (of Changed) needs, and starts the film again; goes on
  /// rendering if it was.
  void update(std::shared_ptr<const Scene> scene, unsigned changed);

 private:
  void build_lights();
  void retrace(std::shared_ptr<const Scene> scene, unsigned changed);
  void render();
  bool plan_pass();
  void render_pass();
  void render_tile(const Tile& area);
  void render_block(FilmTile& tile, const Tile& block, std::uint32_t target, RayCounts& counts) const;
  bool out_of_time() const;

  std::shared_ptr<const Scene> scene_;
  RenderSettings settings_;
  std::unique_ptr<Integrator> integrator_;
  std::unique_ptr<World> world_;
  std::unique_ptr<Accel> accel_;
  std::unique_ptr<LightTable> lights_;
  PixelFilter filter_;
  CameraView view_;
  MediumStack camera_media_;
  std::unique_ptr<Film> film_;
  std::vector<Tile> tiles_;
  ParallelLoop tile_loop_;

  std::thread thread_;
  std::exception_ptr failure_;
  std::atomic<bool> cancel_{false}, running_{false};
  std::atomic<std::uint32_t> finished_samples_{0};
  std::atomic<double> done_{0};  // share of the render, when the pass in progress was planned
  std::chrono::steady_clock::time_point started_;
  mutable std::mutex stats_mutex_;
  SessionStats stats_;
};

/// CPU seconds this process has used, all threads together.
double process_cpu_seconds();

}  // namespace parian

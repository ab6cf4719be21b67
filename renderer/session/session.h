/// The progressive render loop over one scene: start, cancel, wait, look, edit. The command line and the
/// editor are clients of this and of nothing below.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <span>
#include <thread>
#include <vector>

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
  // > 0: seconds in which a first complete frame is to be there, after an edit too; where the full resolution
  // takes longer it is coarse, and the full one follows. A hand that moves then sees each frame to its end:
  // edits wait for it, for twice that time at most, and those that come meanwhile are one.
  double first_frame = 0;
  std::uint32_t seed = 0;
  SamplerKind sampler = SamplerKind::sobol;
  FilterKind filter = FilterKind::blackman_harris;
  FilmLayers layers;
  std::size_t memory_at_end =
      0;                // what the process takes beside the picture when it is written, all else gone
  AccelSettings accel;  // but for the quality, which is
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

/// What is seen at a point of the picture. Indices are those of `scene`, which an edit may have replaced.
struct Pick {
  std::shared_ptr<const Scene> scene;
  int node;
  int mesh, primitive;  // kNone: a shape or a light
  int material;         // kNone: a light
  Vec3f position;       // world space
  float distance;       // metres, from the eye
  float depth;          // metres, along the axis of the camera: what a lens is focused by
};

struct SessionStats {
  double build_seconds = 0, render_seconds = 0, render_cpu_seconds = 0;
  RayCounts rays;
  std::size_t predicted_peak = 0;  // of the process's memory, bytes, before anything was built
  BuildQuality quality = BuildQuality::balanced;
  bool compact = false;
  std::size_t accel_bytes = 0, triangles = 0, solids = 0;  // triangles as stored, each mesh once
  BuildCounts builds;
  double edit_seconds = 0;  // the last edit, until it was rendered
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
  /// is, after what of an edit was cancelled.
  void start();
  /// Ends rendering within some milliseconds: tiles in progress are given up, and so is what an edit builds.
  void cancel();
  /// Until the render has ended by itself or was cancelled. Rethrows what stopped it.
  void wait();

  Progress progress() const;
  /// How many complete frames there were: those that snapshot() has not shown are worth a look. Cheap.
  std::uint64_t frames() const { return frames_; }
  /// The picture so far; rendering goes on. After an edit that of before until there is a complete frame, or
  /// a coarse one (RenderSettings::first_frame), of fewer pixels.
  Picture snapshot() const { return shown_film()->resolve(); }
  /// Its R, G and B alone, which takes a fraction of the time.
  Picture beauty() const { return shown_film()->resolve_beauty(); }
  /// How noisy that is.
  Noise noise() const { return shown_film()->noise(); }
  /// Not beside resize().
  Film& film() { return *full_.film; }
  const Film& film() const { return *full_.film; }
  /// The same, for who has it outlive the session.
  std::shared_ptr<const Film> share_film() const { return full_.film; }
  SessionStats stats() const;
  /// Not beside an edit.
  const World& world() const { return *world_; }

  /// Takes an edited scene, which must be valid and have the camera: rebuilds what `changed` (of Changed)
  /// needs and starts the film again. While it renders this returns at once and all that happens there, of
  /// several edits together; what it throws wait() rethrows. Else it happens here.
  void update(std::shared_ptr<const Scene> scene, unsigned changed);
  /// Another size of the picture, in pixels, > 0; the vertical extent of the camera is kept. As an edit.
  void resize(int width, int height);

  // Questions about what is rendered, at any time and from any thread.

  /// What the centre of the lens sees at a point of the full picture: pixels from the top left, y down, a
  /// pixel's centre at .5. Nothing where that is the environment.
  std::optional<Pick> pick(float x, float y) const;
  /// The bounds in world space of what each of the nodes and those below it draw; empty where there is
  /// nothing, or the scene as it is rendered has no such node. All at once take little more time than one.
  std::vector<Box3f> node_bounds(std::span<const int> nodes) const;
  Box3f node_bounds(int node) const { return node_bounds({&node, 1})[0]; }

 private:
  using Clock = std::chrono::steady_clock;

  /// A film with how the camera sees it.
  struct Target {
    std::shared_ptr<Film> film;
    CameraView view;
    std::vector<Tile> tiles;
  };
  /// What update() and resize() ask for.
  struct Edit {
    std::shared_ptr<const Scene> scene;  // null: the same
    unsigned changed = 0;
    int width = 0, height = 0;  // 0: the same
  };

  Target make_target(int width, int height, const FilmLayers& layers) const;
  std::shared_ptr<Film> shown_film() const;
  void build_lights();

  void request(Edit edit);
  bool apply_edit();
  void apply(const Edit& edit);
  void start_film_again();
  void retrace(std::shared_ptr<const Scene> scene, unsigned changed);
  bool is_same_structure(const World& world) const;
  void refine();

  void run();
  bool is_finished();
  bool interrupted() const;
  bool render_coarse();
  void render();
  bool plan_pass();
  bool render_pass(const Target& target);
  void learn_cost();
  void show(std::shared_ptr<Film> film);
  void render_tile(const Target& target, const Tile& area);
  void render_block(const Target& target, FilmTile& tile, const Tile& block, std::uint32_t goal,
                    RayCounts& counts) const;
  bool out_of_time() const;

  RenderSettings settings_;
  std::unique_ptr<Integrator> integrator_;
  PixelFilter filter_;
  ParallelLoop tile_loop_;

  // What is rendered. The thread that renders replaces it, holding the mutex, and others read it so.
  mutable std::shared_mutex scene_mutex_;
  std::shared_ptr<const Scene> scene_;
  std::unique_ptr<World> world_;
  std::shared_ptr<Accel> accel_;
  std::unique_ptr<LightTable> lights_;
  CameraPlacement camera_{};
  MediumStack camera_media_;
  Target full_;
  std::shared_ptr<const Scene> camera_scene_;  // of the last edit, be it of a camera alone
  std::shared_ptr<Film> shown_;  // the last that had a complete frame, or, before any, the full one
  std::shared_ptr<Film> spare_;  // to begin the next picture with while the last is shown

  std::mutex edit_mutex_;
  Edit edit_;                        // that waits
  std::atomic<bool> edited_{false};  // it does

  // Better BVHs in the making.
  struct Refinement {
    std::thread thread;
    std::atomic<bool> cancelled{false}, done{false};
    Accel::Refined result;
  };
  std::unique_ptr<Refinement> refinement_;
  bool refined_all_ = false;  // as far as it went

  std::thread thread_;
  std::exception_ptr failure_;
  std::atomic<bool> cancel_{false}, running_{false};
  std::atomic<std::uint32_t> finished_samples_{0};
  std::atomic<std::uint64_t> frames_{0};
  std::atomic<double> done_{0};  // share of the render, when the pass in progress was planned
  Clock::time_point started_, pass_started_;
  bool first_pass_ = false;                     // of a film that edits wait for
  std::atomic<std::uint64_t> pass_samples_{0};  // of the pass, those of tiles given up included
  std::atomic<std::size_t> merged_tiles_{0};
  double sample_seconds_ = 1e-6;  // of one sample of one pixel, all threads together, as it was last
  mutable std::mutex stats_mutex_;
  SessionStats stats_;
};

/// CPU seconds this process has used, all threads together.
double process_cpu_seconds();

}  // namespace parian

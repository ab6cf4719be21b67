#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "apps/command_line/checkpoint.h"
#include "apps/command_line/commands.h"
#include "apps/command_line/picture_size.h"
#include "apps/command_line/progress_bar.h"
#include "apps/command_line/sizes.h"
#include "apps/command_line/stats.h"
#include "apps/command_line/texture_memory.h"
#include "images/image_io.h"
#include "integrators/integrators.h"
#include "renderer/base/error.h"
#include "renderer/base/file.h"
#include "renderer/base/memory.h"
#include "renderer/base/parallel.h"
#include "renderer/color/display.h"
#include "scene_io/gltf/gltf.h"

namespace parian {
namespace {

using Clock = std::chrono::steady_clock;

struct RenderOptions {
  std::vector<std::string> scenes;
  std::string output, display, view, size, camera, environment, stats, checkpoint, resume;
  std::string memory, texture_memory;
  std::string integrator = "path";
  std::optional<std::string> tiles;
  std::vector<std::string> layers;
  RenderSettings settings;
  IntegratorSettings integrator_settings;
  LoadSettings load_settings;
  float exposure = 0;
  std::uint32_t spp = 0;  // 0: not given
  int threads = 0;
  bool quiet = false;
};

std::atomic<bool> interrupted{false};

void on_signal(int) { interrupted = true; }

double lap(Clock::time_point& start) {
  const Clock::time_point now = Clock::now();
  return std::chrono::duration<double>(now - std::exchange(start, now)).count();
}

const std::map<std::string, Strategy> kStrategies{
    {"mis", Strategy::mis}, {"light", Strategy::light}, {"bsdf", Strategy::bsdf}};
const std::map<std::string, LightChoice> kLightChoices{
    {"uniform", LightChoice::uniform}, {"power", LightChoice::power}, {"tree", LightChoice::tree}};
const std::map<std::string, Microfacets> kMicrofacets{{"compensated", Microfacets::compensated},
                                                      {"single", Microfacets::single}};
const std::map<std::string, Subsurface> kSubsurface{
    {"auto", Subsurface::automatic}, {"random-walk", Subsurface::random_walk},
    {"dipole", Subsurface::dipole},  {"better-dipole", Subsurface::better_dipole},
    {"burley", Subsurface::burley},  {"photon-beam", Subsurface::photon_beam},
    {"off", Subsurface::off}};
const std::map<std::string, SamplerKind> kSamplers{{"sobol", SamplerKind::sobol},
                                                   {"independent", SamplerKind::independent}};
const std::map<std::string, FilterKind> kFilters{{"blackman-harris", FilterKind::blackman_harris},
                                                 {"box", FilterKind::box}};
const std::map<std::string, BuildQuality> kBuildQualities{
    {"fast", BuildQuality::fast}, {"balanced", BuildQuality::balanced}, {"best", BuildQuality::best}};
const std::map<std::string, Partitioner> kPartitioners{{"auto", Partitioner::automatic},
                                                       {"static", Partitioner::fixed},
                                                       {"simple", Partitioner::simple},
                                                       {"affinity", Partitioner::affinity}};

/// Adds an option whose value is one of the names of `choices`.
template <class T>
void add_choice(CLI::App& app, const std::string& name, T& value, const std::map<std::string, T>& choices,
                const std::string& help) {
  std::vector<std::string> names;
  for (const auto& entry : choices) names.push_back(entry.first);
  app.add_option_function<std::string>(
         name, [&value, &choices](const std::string& chosen) { value = choices.at(chosen); },
         fmt::format("{}: {}", help, fmt::join(names, ", ")))
      ->check(CLI::IsMember(names).description(""))
      ->type_name("NAME");
}

/// rows, columns, or the side of square tiles from 1 to 65536 pixels.
Tiling parse_tiles(const std::string& text) {
  if (text == "rows") return {TileShape::rows};
  if (text == "columns") return {TileShape::columns};
  Tiling tiling;
  char rest;
  if (std::sscanf(text.c_str(), "%d%c", &tiling.size, &rest) != 1 || tiling.size < 1 || tiling.size > 65536)
    throw UsageError(fmt::format("--tiles {}: expected rows, columns, or a size from 1 to 65536", text));
  return tiling;
}

/// The camera by name or by number, as an index into the placed cameras.
int find_camera(const Scene& scene, const std::vector<CameraPlacement>& cameras, const std::string& wanted) {
  if (wanted.empty()) return 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string &camera = scene.cameras[cameras[i].camera].name,
                      &node = scene.nodes[cameras[i].node].name;
    if (wanted == camera || wanted == node || wanted == std::to_string(i)) return int(i);
    names.push_back(fmt::format("{} \"{}\"", i, node.empty() ? camera : node));
  }
  throw UsageError(fmt::format("--camera {}: no such camera; there are: {}", wanted, fmt::join(names, ", ")));
}

const std::vector<std::string> kLayerNames{"variance", "samples", "albedo", "normal",
                                           "depth",    "object",  "sss"};

FilmLayers film_layers(const std::vector<std::string>& names) {
  FilmLayers layers{false, false, false};
  for (const std::string& name : names) {
    if (name == "none") continue;
    if (std::ranges::find(kLayerNames, name) == kLayerNames.end())
      throw UsageError(
          fmt::format("--aov {}: no such layer; there are: {}, none", name, fmt::join(kLayerNames, ", ")));
    (name == "variance" ? layers.variance : name == "samples" ? layers.sample_count : layers.features) = true;
  }
  return layers;
}

/// Leaves the beauty and the layers asked for; the film keeps some together.
Picture select_layers(const Picture& all, const std::vector<std::string>& names) {
  std::vector<std::size_t> kept;
  Picture picture{all.width, all.height, {}, {}, all.metadata};
  for (std::size_t c = 0; c < all.channels.size(); ++c) {
    const std::string layer = all.channels[c].substr(0, all.channels[c].find('.'));
    if (c >= 3 && std::ranges::find(names, layer) == names.end()) continue;
    kept.push_back(c);
    picture.channels.push_back(all.channels[c]);
  }
  picture.pixels.reserve(kept.size() * all.width * all.height);
  for (std::size_t first = 0; first < all.pixels.size(); first += all.channels.size())
    for (const std::size_t c : kept) picture.pixels.push_back(all.pixels[first + c]);
  return picture;
}

void check_writable(const std::string& path) {
  if (path.empty()) return;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw InputError(path, "", fmt::format("cannot be written: there is no folder {}", folder.string()));
  if (std::filesystem::is_directory(path)) throw InputError(path, "", "cannot be written: it is a folder");
}

/// Refuses before hours of rendering what could only fail after them.
void check_outputs(const RenderOptions& o) {
  if (o.output.empty() && o.display.empty())
    throw UsageError("render: expected -o FILE.exr, --display FILE.png, or both");
  if (!o.output.empty() && std::filesystem::path(o.output).extension() != ".exr")
    throw UsageError(fmt::format("-o {}: expected a name that ends in .exr", o.output));
  for (const std::string* path : {&o.output, &o.display, &o.stats, &o.checkpoint}) check_writable(*path);
  if (o.display.empty()) return;
  const std::string extension = std::filesystem::path(o.display).extension();
  if (extension != ".png" && extension != ".jpg" && extension != ".jpeg")
    throw UsageError(fmt::format("--display {}: expected a name that ends in .png or .jpg", o.display));
  if (const std::vector<std::string> views = display_views();
      !o.view.empty() && std::ranges::find(views, o.view) == views.end())
    throw UsageError(fmt::format("--view {}: no such view; there are: {}", o.view, fmt::join(views, ", ")));
}

/// The scene to render; `notes` holds what it lacks and what was skipped.
std::shared_ptr<const Scene> load(const RenderOptions& o, PhaseLine& phases, ImageMemory* memory,
                                  std::vector<std::string>& notes) {
  Image environment;
  if (!o.environment.empty()) environment = read_image(o.environment);
  if (memory) memory->keep(image_bytes(environment), o.environment);
  LoadSettings settings = o.load_settings;
  settings.on_phase = std::ref(phases);
  settings.image_memory = memory;
  auto scene = std::make_shared<Scene>(load_scene(o.scenes, settings, notes));
  if (!o.environment.empty()) {
    scene->environment = {Rgb(1, 1, 1), int(scene->images.size()), Quatf(1, 0, 0, 0)};
    scene->images.push_back(std::move(environment));
  }
  for (const std::string& note : add_missing_camera_and_light(*scene)) notes.push_back(note);
  return scene;
}

/// What a checkpoint must agree on: all that decides the value of a sample.
std::string checkpoint_key(const RenderOptions& o) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::string& path : o.scenes)
    for (const char c : read_file(path)) hash = (hash ^ std::uint8_t(c)) * 0x100000001b3u;
  const RenderSettings& s = o.settings;
  return fmt::format(
      "scene {:016x} at {} env '{}' size {}x{} camera {} seed {} sampler {} filter {} integrator {} strategy "
      "{} "
      "lights {} ggx {} sss {} depth {} clamp {} layers {}{}{}",
      hash, o.load_settings.at ? fmt::format("{} s", *o.load_settings.at) : "rest", o.environment, s.width,
      s.height, s.camera, s.seed, int(s.sampler), int(s.filter), o.integrator,
      int(o.integrator_settings.strategy), int(s.light_choice), int(o.integrator_settings.microfacets),
      int(o.integrator_settings.subsurface), o.integrator_settings.max_depth, o.integrator_settings.clamp,
      s.layers.variance, s.layers.sample_count, s.layers.features);
}

/// Renders to the end, to an interruption, or to the end of the time; true if it was interrupted. Throws
/// InputError as soon as texels cannot be read: what comes then is not the picture of the scene.
bool run(Session& session, const RenderOptions& o, const std::string& key, const ImageMemory* memory) {
  constexpr double kCheckpointInterval = 60;  // seconds
  const auto check_images = [&] {
    if (memory)
      if (const std::string error = memory->error(); !error.empty()) throw std::runtime_error(error);
  };
  ProgressBar bar(o.quiet);
  double next_checkpoint = kCheckpointInterval;
  session.start();
  while (session.progress().running && !interrupted) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    check_images();
    bar.show(session);
    if (!o.checkpoint.empty() && session.progress().seconds > next_checkpoint) {
      write_checkpoint(o.checkpoint, key, session.film());
      next_checkpoint += kCheckpointInterval;
    }
  }
  if (interrupted) session.cancel();
  bar.finish();
  session.wait();
  check_images();
  if (!o.checkpoint.empty()) write_checkpoint(o.checkpoint, key, session.film());
  return interrupted;
}

void write_pictures(const Film& film, const RenderOptions& o, double render_seconds) {
  Picture picture = select_layers(film.resolve(), o.layers);
  picture.metadata = {{"parian:version", PARIAN_VERSION},
                      {"parian:scene", fmt::format("{}", fmt::join(o.scenes, " "))},
                      {"parian:integrator", o.integrator},
                      {"parian:spp", fmt::format("{:.6g}", film.mean_samples())},
                      {"parian:noise", fmt::format("{:.4g}", film.noise().bound)},
                      {"parian:seed", std::to_string(o.settings.seed)},
                      {"parian:maxDepth", std::to_string(o.integrator_settings.max_depth)},
                      {"parian:renderSeconds", fmt::format("{:.2f}", render_seconds)}};
  if (!o.output.empty()) write_exr(picture, o.output);
  if (!o.display.empty()) write_display_image(apply_display(picture, o.view, o.exposure), o.display);
}

int render(RenderOptions o) {
  check_outputs(o);
  require_image_library();
  Vec2i size = o.size.empty() ? Vec2i(0) : parse_size(o.size);
  const bool other_end = o.settings.seconds > 0 || o.settings.noise > 0;
  o.settings.spp = o.spp > 0 ? o.spp : other_end ? kNoLimit : 64;
  if (o.tiles) o.settings.tiling = parse_tiles(*o.tiles);
  if (o.threads > 0) set_thread_count(o.threads);
  if (!o.memory.empty()) set_memory_limit(parse_bytes("--memory", o.memory));
  memory_limit();  // what is there now, before anything is loaded
  o.settings.memory_at_end = resident_memory() + image_library_bytes();
  o.settings.layers = film_layers(o.layers);
  std::unique_ptr<Integrator> integrator = make_integrator(o.integrator, o.integrator_settings);

  PhaseSeconds seconds;
  Clock::time_point clock = Clock::now();
  std::vector<std::string> notes;
  PhaseLine phases(o.quiet);
  const std::unique_ptr<ImageMemory> memory = make_image_memory(o.texture_memory);
  std::shared_ptr<const Scene> scene = load(o, phases, memory.get(), notes);
  const std::vector<CameraPlacement> cameras = place_cameras(*scene);
  o.settings.camera = find_camera(*scene, cameras, o.camera);
  if (o.size.empty()) size = default_size(scene->cameras[cameras[o.settings.camera].camera]);
  o.settings.width = size.x;
  o.settings.height = size.y;
  const std::string key = o.checkpoint.empty() && o.resume.empty() ? "" : checkpoint_key(o);
  seconds.load = lap(clock);

  phases("building");
  o.settings.accel.on_progress = [&](double done) { phases.show_share(done); };
  auto session = std::make_unique<Session>(scene, o.settings, std::move(integrator));
  phases.finish();
  if (!o.resume.empty()) read_checkpoint(o.resume, key, session->film());
  seconds.build = lap(clock);
  // Only now: an error above is the first line of all.
  if (!o.quiet)
    for (const std::string& note : notes) fmt::print(stderr, "parian: note: {}\n", note);

  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  seconds.first_ray = process_seconds();
  const bool stopped = run(*session, o, key, memory.get());
  seconds.render = lap(clock);

  // The BVH and the scene go before what writes the picture comes.
  const SessionStats stats = session->stats();
  const std::shared_ptr<const Film> film = session->share_film();
  ImageMemoryStatistics images;
  if (memory) images = memory->statistics();
  for (const Image& image : scene->images) images.memory_bytes += memory ? 0 : image.pixels.bytes();
  session.reset();
  scene.reset();
  write_pictures(*film, o, seconds.render);
  seconds.write = lap(clock);
  if (!o.stats.empty()) write_file(o.stats, stats_json(stats, seconds, *film, images));
  if (stats.rays.dropped > 0)
    fmt::print(stderr, "parian: note: {} samples of {} were not finite and count as black\n",
               stats.rays.dropped, stats.rays.camera);
  if (!o.quiet)
    fmt::print(stderr, "{}x{}, {:.4g} spp, noise {}, {} ({:.0f} camera paths per CPU second)\n", size.x,
               size.y, film->mean_samples(), format_noise(film->noise()), format_duration(seconds.render),
               stats.render_cpu_seconds > 0 ? double(stats.rays.camera) / stats.render_cpu_seconds : 0);
  return stopped ? kInterrupted : kDone;
}

}  // namespace

Command add_render_command(CLI::App& app) {
  CLI::App& c =
      *app.add_subcommand("render", "Render scenes to an EXR, and to a PNG through a display transform");
  const auto options = std::make_shared<RenderOptions>();
  RenderOptions& o = *options;
  c.add_option("SCENE", o.scenes, ".gltf or .glb files; several are composed into one scene")->required();
  c.add_option("-o,--output", o.output, "Linear Rec.709 EXR to write, with its layers")
      ->type_name("FILE.exr");
  c.add_option("--display", o.display, "Display-referred 8-bit picture to write")->type_name("FILE.png");
  c.add_option("--view", o.view, "OpenColorIO view of --display; the config's first by default")
      ->type_name("NAME");
  c.add_option("--exposure", o.exposure, "Stops added before the view [0]")->check(number_between(-100, 100));
  c.add_option("--size", o.size, "Picture size; by default 960 wide in the camera's shape")->type_name("WxH");
  c.add_option("--camera", o.camera, "Camera by name or number; the first by default")
      ->type_name("NAME|INDEX");
  add_at_option(c, o.load_settings.at);
  c.add_option("--env", o.environment, "Equirectangular image that replaces the scene's environment")
      ->type_name("FILE");
  c.add_option("--spp", o.spp, "Samples for each pixel, or for the mean pixel with --noise [64]")
      ->check(CLI::Range(1u, 1u << 30).description(""));
  c.add_option("--time", o.settings.seconds, "Seconds to render")->check(number_between(1e-3, 1e9));
  c.add_option(
       "--noise", o.settings.noise,
       "Relative error to reach, .05 for 5%, with samples where they are needed. Of --spp, --time and "
       "--noise that are given, the first reached ends the render")
      ->check(number_between(1e-6, 1e3));
  c.add_option("--integrator", o.integrator,
               fmt::format("What to compute [path]: {}", fmt::join(integrator_names(), ", ")))
      ->type_name("NAME");
  add_choice(c, "--strategy", o.integrator_settings.strategy, kStrategies,
             "path: how direct light is found [mis]");
  add_choice(c, "--light-choice", o.settings.light_choice, kLightChoices,
             "path: which light is sampled: any alike, by power, by what it may send to the place [tree]");
  add_choice(c, "--ggx", o.integrator_settings.microfacets, kMicrofacets,
             "path: rough surfaces scatter light as often as it meets facets, or once [compensated]");
  add_choice(
      c, "--sss", o.integrator_settings.subsurface, kSubsurface,
      "path: light inside dense bodies by a random walk, by a model of diffusion, by place whichever is "
      "cheap and near, or not at all [auto]");
  c.add_option("--max-depth", o.integrator_settings.max_depth,
               "path: scattering events of a path at most [100]")
      ->check(CLI::Range(0, 1 << 20).description(""));
  c.add_option("--clamp", o.integrator_settings.clamp,
               "path: radiance of a sample at most, to end fireflies; darkens the picture [none]")
      ->check(number_between(1e-6, 1e30));
  c.add_option("--ao-distance", o.integrator_settings.occlusion_distance,
               "ao: metres within which an occluder counts; 0: any distance [0]")
      ->check(number_between(0, 1e30));
  add_choice(c, "--sampler", o.settings.sampler, kSamplers, "Random sequence [sobol]");
  add_choice(c, "--filter", o.settings.filter, kFilters, "Reconstruction filter [blackman-harris]");
  o.layers = {"variance"};
  c.add_option("--aov", o.layers,
               fmt::format("Layers of the EXR [variance]: {}, none", fmt::join(kLayerNames, ", ")))
      ->delimiter(',')
      ->type_name("LIST");
  c.add_option_function<std::string>(
       "--build", [&o](const std::string& name) { o.settings.build = kBuildQualities.at(name); },
       "Acceleration structure: soon there, or soon traced; by default what pays: fast, balanced, best")
      ->check(CLI::IsMember(std::vector<std::string>{"fast", "balanced", "best"}).description(""))
      ->type_name("NAME");
  c.add_option("--memory", o.memory,
               "Memory to stay below, as 8G or 500M; what the machine has free by default")
      ->type_name("BYTES");
  c.add_option("--threads", o.threads, "Threads; all cores by default")
      ->check(CLI::Range(1, 4096).description(""));
  c.add_option("--tiles", o.tiles,
               "How the picture is cut for the threads: rows, columns, or the side of squares in pixels")
      ->type_name("rows|columns|SIZE");
  add_choice(c, "--partitioner", o.settings.partitioner, kPartitioners,
             "How tiles are dealt to threads [simple]");
  add_texture_memory(c, o.texture_memory);
  c.add_option("--seed", o.settings.seed, "Seed of the random sequence [0]");
  c.add_option("--stats", o.stats, "JSON to write what the render cost to")->type_name("FILE.json");
  c.add_option("--checkpoint", o.checkpoint,
               "File to keep the render's state in, once a minute and at the end")
      ->type_name("FILE");
  c.add_option("--resume", o.resume, "Checkpoint to go on from")->type_name("FILE");
  c.add_flag("--quiet", o.quiet, "No progress and no notes");
  return [options] { return render(*options); };
}

}  // namespace parian

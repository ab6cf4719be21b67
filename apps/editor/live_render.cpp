#include "apps/editor/live_render.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "integrators/integrators.h"
#include "renderer/color/display.h"

namespace parian::editor {
namespace {

constexpr std::chrono::milliseconds kFrameInterval(25);  // between images, at least: above 30 a second
constexpr qint64 kNoiseInterval = 200;    // milliseconds; a number that changes faster is not read
constexpr double kFirstFrame = 0.02;      // seconds, see RenderSettings::first_frame
constexpr std::uint32_t kSamples = 4096;  // then the picture rests

QImage to_image(const Picture& shown) {
  QImage image(shown.width, shown.height, QImage::Format_RGB32);
  for (int y = 0; y < shown.height; ++y) {
    auto* line = reinterpret_cast<QRgb*>(image.scanLine(y));
    const float* p = shown.at(0, y);
    for (int x = 0; x < shown.width; ++x, p += 3) {
      const auto byte = [](float v) { return int(v * 255 + 0.5f); };
      line[x] = qRgb(byte(p[0]), byte(p[1]), byte(p[2]));
    }
  }
  return image;
}

}  // namespace

LiveRender::LiveRender(QObject* parent)
    : QObject(parent), thread_([this](const std::stop_token& stop) { run(stop); }) {}

LiveRender::~LiveRender() {
  thread_.request_stop();
  wake_.notify_all();
}

std::shared_ptr<Session> LiveRender::session() const {
  const std::lock_guard lock(mutex_);
  return session_;
}

void LiveRender::ask(const std::function<void(Request&)>& change) {
  {
    const std::lock_guard lock(mutex_);
    change(request_);
  }
  wake_.notify_all();
}

void LiveRender::replace(std::shared_ptr<const Scene> scene) {
  ask([&](Request& r) {
    scene_ = std::move(scene);
    r = {.scene = scene_, .is_new = true, .redisplay = false, .changed = 0, .size = r.size};
  });
}

void LiveRender::update(std::shared_ptr<const Scene> scene, unsigned changed) {
  ask([&](Request& r) {
    scene_ = std::move(scene);
    r.scene = scene_;
    r.changed |= changed;
  });
}

void LiveRender::look(const ViewCamera& view) {
  ask([&](Request& r) {
    view_ = view;
    r.changed |= kChangedCamera;
  });
}

void LiveRender::resize(const QSize& pixels) {
  if (pixels.isEmpty()) return;
  ask([&](Request& r) { r.size = size_ = pixels; });
}

void LiveRender::set_display(const std::string& view, float exposure) {
  ask([&](Request& r) {
    display_view_ = view;
    exposure_ = exposure;
    r.redisplay = true;
  });
}

void LiveRender::set_paused(bool paused) {
  ask([&](Request& r) {
    paused_ = paused;
    r.redisplay = true;
  });
}

std::optional<Pick> LiveRender::pick(const QPointF& pixel) const {
  const auto session = this->session();
  return session ? session->pick(float(pixel.x()), float(pixel.y())) : std::nullopt;
}

std::vector<Box3f> LiveRender::bounds(std::span<const int> nodes) const {
  const auto session = this->session();
  return session ? session->node_bounds(nodes) : std::vector<Box3f>(nodes.size());
}

LiveStatus LiveRender::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void LiveRender::run(const std::stop_token& stop) {
  std::chrono::steady_clock::time_point next{};
  while (!stop.stop_requested()) {
    Request request;
    bool paused;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, stop, next, [&] { return !paused_ && !request_.empty(); });
      paused = paused_;
      if (!paused) request = std::exchange(request_, {});  // else it is followed later
      if (paused && std::exchange(request_.redisplay, false)) shown_ = 0;
    }
    // From the beginning of one image to that of the next, so that what it takes to make it does not come on
    // top.
    next = std::chrono::steady_clock::now() + kFrameInterval;
    try {
      if (const auto current = session(); paused && current) current->cancel();
      if (!request.empty()) follow(request);
      publish();
    } catch (const std::exception& error) {
      emit failed(QString::fromUtf8(error.what()));
    }
  }
  session_.reset();
}

void LiveRender::follow(const Request& request) {
  std::shared_ptr<const Scene> scene;
  ViewCamera view;
  QSize size;
  {
    const std::lock_guard lock(mutex_);
    scene = scene_;
    view = view_;
    size = size_;
  }
  if (!scene) return;
  std::shared_ptr<Session> current = session();
  if (request.redisplay) shown_ = 0;
  if (request.is_new || !current) {
    {
      const std::lock_guard lock(mutex_);
      session_.reset();  // its memory before that of the next
    }
    current.reset();
    RenderSettings settings;
    settings.width = size.width();
    settings.height = size.height();
    settings.spp = kSamples;
    settings.first_frame = kFirstFrame;
    settings.accel.editable = true;
    current = std::make_shared<Session>(std::make_shared<const Scene>(with_view(*scene, view)), settings,
                                        make_integrator("path", {}));
    current->start();
    shown_ = measured_ = 0;
    const std::lock_guard lock(mutex_);
    session_ = current;
    return;
  }
  if (request.scene || request.changed)
    current->update(std::make_shared<const Scene>(with_view(*scene, view)), request.changed);
  if (!request.size.isEmpty()) current->resize(request.size.width(), request.size.height());
  if (!current->progress().running) current->start();
}

void LiveRender::publish() {
  const std::shared_ptr<Session> current = session();
  if (!current) return;
  const Progress progress = current->progress();
  const std::uint64_t frames = current->frames();
  std::string view;
  float exposure;
  {
    const std::lock_guard lock(mutex_);
    status_.samples = progress.samples;
    status_.seconds = progress.seconds;
    status_.running = progress.running;
    view = display_view_;
    exposure = exposure_;
  }
  if (frames != 0 && frames != shown_) {
    // Kept between frames: to find what a view needs takes longer than a frame.
    static thread_local std::pair<std::string, std::optional<Display>> display;
    if (!display.second || display.first != view) display = {view, Display(view, true)};
    emit frame_ready(to_image(display.second->apply(current->beauty(), exposure)));
    shown_ = frames;
  } else if (!progress.running) {
    current->wait();  // what ended it, if anything did
  }
  if (frames != measured_ && (!noise_clock_.isValid() || noise_clock_.hasExpired(kNoiseInterval))) {
    measured_ = frames;
    noise_clock_.start();
    const double noise = current->noise().bound;
    const std::lock_guard lock(mutex_);
    status_.noise = noise;
  }
}

}  // namespace parian::editor

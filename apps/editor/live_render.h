/// The picture of the viewport: a Session that follows the document, and its frames as images for the screen.
/// All that takes time happens on a thread of its own.
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QObject>
#include <QPointF>
#include <QSize>

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "apps/editor/view_camera.h"
#include "renderer/session/session.h"

namespace parian::editor {

/// What the status line shows.
struct LiveStatus {
  std::uint32_t samples = 0;
  double noise = 0, seconds = 0;
  bool running = false;
};

class LiveRender : public QObject {
  Q_OBJECT

 public:
  explicit LiveRender(QObject* parent = nullptr);
  ~LiveRender() override;

  // Each asks, returns at once, and is followed by frames. What was asked before and not yet done is one with
  // it.

  /// Another scene: all is built anew.
  void replace(std::shared_ptr<const Scene> scene);
  /// The scene after an edit; or-ed flags of Changed.
  void update(std::shared_ptr<const Scene> scene, unsigned changed);
  void look(const ViewCamera& view);
  void resize(const QSize& pixels);
  /// OpenColorIO's view and exposure in stops.
  void set_display(const std::string& view, float exposure);
  void set_paused(bool paused);

  /// What is seen at a pixel; nothing where that is the environment or nothing is rendered yet. Indices of
  /// nodes are those of the document where it has not changed since.
  std::optional<Pick> pick(const QPointF& pixel) const;
  /// Of nodes with what is below them; empty where nothing is seen of them, or not yet.
  std::vector<Box3f> bounds(std::span<const int> nodes) const;
  Box3f bounds(int node) const { return bounds({&node, 1})[0]; }
  LiveStatus status() const;

 signals:
  void frame_ready(const QImage& image);
  void failed(const QString& reason);

 private:
  struct Request {
    std::shared_ptr<const Scene> scene;
    bool is_new = false, redisplay = false;
    unsigned changed = 0;
    QSize size;
    bool empty() const { return !scene && !is_new && changed == 0 && size.isEmpty() && !redisplay; }
  };

  void run(const std::stop_token& stop);
  void follow(const Request& request);
  void publish();
  std::shared_ptr<Session> session() const;
  void ask(const std::function<void(Request&)>& change);

  mutable std::mutex mutex_;  // of all up to the thread's own
  std::condition_variable_any wake_;
  Request request_;
  std::shared_ptr<const Scene> scene_;
  ViewCamera view_;
  QSize size_{640, 360};
  std::string display_view_;
  float exposure_ = 0;
  bool paused_ = false;
  std::shared_ptr<Session> session_;
  LiveStatus status_;

  // Of the thread alone.
  std::uint64_t shown_ = 0, measured_ = 0;  // frames
  QElapsedTimer noise_clock_;
  std::jthread thread_;  // last: ends before anything else does
};

}  // namespace parian::editor

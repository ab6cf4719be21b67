/// A small viewport that shows the Cornell box, as its camera does.
#pragma once

#include <QSignalSpy>
#include <QWheelEvent>

#include "apps/editor/viewport.h"
#include "tests/apps/editor/support/editor_test.h"

namespace parian::editor {

/// Mean of red, green and blue in a part of an image, 0 to 255.
inline double mean_of(const QImage& image, const QRect& part) {
  double sum = 0;
  const QRect inside = part.intersected(image.rect());
  for (int y = inside.top(); y <= inside.bottom(); ++y)
    for (int x = inside.left(); x <= inside.right(); ++x) {
      const QRgb pixel = image.pixel(x, y);
      sum += qRed(pixel) + qGreen(pixel) + qBlue(pixel);
    }
  return sum / (3.0 * std::max(1, inside.width() * inside.height()));
}

class ViewportTest : public EditorTest {
 protected:
  static constexpr int kTall = 6, kCamera = 8;  // nodes

  ViewportTest() : viewport_(document_) {
    viewport_.resize(320, 160);
    document_.load({scene_file("cornell-box")});
    viewport_.look_through(kCamera);
    viewport_.show();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&viewport_));
    EXPECT_TRUE(wait_for([&] { return frames_.count() > 0 && viewport_.render().pick({160, 80}); }));
  }
  /// A pixel of the tall block.
  QPoint tall_block() {
    const Box3f box = viewport_.render().bounds(kTall);
    const Vec3f point(box.center().x, box.max.y - 0.05f, box.center().z);
    return to_pixel(point);
  }
  QPoint to_pixel(const Vec3f& point) const {
    const Vec2f p = viewport_.projector().project(point).value_or(Vec2f(0, 0));
    return {int(std::lround(p.x)), int(std::lround(p.y))};
  }
  void click(const QPoint& at, Qt::KeyboardModifiers keys = {}) {
    QTest::mouseClick(&viewport_, Qt::LeftButton, keys, at);
  }
  void drag(Qt::MouseButton button, const QPoint& from, const QPoint& by, Qt::KeyboardModifiers keys = {}) {
    QTest::mousePress(&viewport_, button, keys, from);
    QTest::mouseMove(&viewport_, from + by / 2);
    QTest::mouseMove(&viewport_, from + by);
    QTest::mouseRelease(&viewport_, button, keys, from + by);
  }
  void turn_wheel(int steps) {
    QWheelEvent event(QPointF(100, 80), viewport_.mapToGlobal(QPointF(100, 80)), {}, QPoint(0, 120 * steps),
                      Qt::NoButton, {}, Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(&viewport_, &event);
  }
  QImage shown() { return viewport_.grab().toImage(); }
  const Node& tall() const { return document_.scene().nodes[kTall]; }
  int steps() { return document_.history().count(); }

  Document document_;
  Viewport viewport_;
  QSignalSpy frames_{&viewport_.render(), &LiveRender::frame_ready};
};

}  // namespace parian::editor

#include "apps/editor/viewport.h"

#include <algorithm>

#include "editing/properties.h"
#include "editing/tree.h"

namespace parian::editor {

Viewport::Viewport(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setMinimumSize(160, 90);
  setAttribute(Qt::WA_OpaquePaintEvent);
  connect(&render_, &LiveRender::frame_ready, this, [this](const QImage& image) {
    frame_ = image;
    update();
  });
  connect(&render_, &LiveRender::failed, &document_, &Document::refused);
  connect(&document_, &Document::scene_changed, this, [this](unsigned changed) {
    if (changed) render_.update(document_.share(), changed);
    // Undone or edited otherwise meanwhile: what was taken hold of may be no more.
    if (action_ == Action::gizmo && !document_.is_dragging()) action_ = Action::none;
    update();
  });
  connect(&document_, &Document::scene_replaced, this, [this] {
    looked_through_ = kNone;
    action_ = Action::none;
    render_.replace(document_.share());
  });
  connect(&document_, &Document::selection_changed, this, qOverload<>(&QWidget::update));
  connect(&status_timer_, &QTimer::timeout, this, &Viewport::show_status);
  status_timer_.start(200);
  connect(&fly_timer_, &QTimer::timeout, this, &Viewport::fly);
  render_.look(view_);
}

void Viewport::set_view(const ViewCamera& view) {
  view_ = view;
  view_changed();
}

void Viewport::view_changed() {
  render_.look(view_);
  update();
}

void Viewport::look_through(int node) {
  const Scene& scene = document_.scene();
  if (node < 0 || std::size_t(node) >= scene.nodes.size()) return;
  const int camera = scene.nodes[std::size_t(node)].camera;
  if (camera == kNone) return;
  const Affine place = to_affine(edit::find_to_world(scene, node, edit::find_parents(scene)));
  const Camera& like = scene.cameras[std::size_t(camera)];
  view_.look_through(like, place, like.lens ? like.lens->focus_distance : view_.distance);
  looked_through_ = node;
  aimed_ = false;
  view_changed();
}

/// The view turns about what is seen in its middle, and goes there. A camera of the scene does not say how
/// far that is, and a head that turns looks at something else.
void Viewport::aim() {
  if (aimed_) return;
  const QPointF middle(0.5 * width(), 0.5 * height());
  const auto pick = render_.pick(middle * devicePixelRatioF());
  if (!pick) return;
  view_.aim(pick->depth);
  aimed_ = true;
}

void Viewport::frame_selection() {
  const Selection& selection = document_.selection();
  const bool some = selection.kind == Selection::Kind::nodes;
  Box3f box;
  for (const Box3f& b : render_.bounds(some ? selection.indices : document_.scene().roots)) box.extendBy(b);
  if (some && box.isEmpty()) box.extendBy(gizmo()->origin);
  view_.frame(box, float(width()) / float(std::max(1, height())));
  aimed_ = true;
  view_changed();
}

void Viewport::set_gizmo_mode(GizmoMode mode) {
  gizmo_mode_ = mode;
  update();
}

void Viewport::set_local_axes(bool local) {
  local_axes_ = local;
  update();
}

std::optional<Gizmo> Viewport::gizmo() const {
  const Selection& selection = document_.selection();
  if (selection.kind != Selection::Kind::nodes) return std::nullopt;
  const Scene& scene = document_.scene();
  const Mat4d world = edit::find_to_world(scene, selection.active(), edit::find_parents(scene));
  const Affine place = to_affine(world);
  Gizmo result{gizmo_mode_, place.origin, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // Many a file has all meshes in world space, and its nodes where nothing is to be seen.
  const Box3f box = render_.bounds(selection.active());
  if (!box.isEmpty() && !box.intersects(place.origin)) result.origin = box.center();
  const auto long_enough = [](const Vec3f& v) { return v.length() > 1e-12f; };
  // A scale along the axes of the world would shear what is turned.
  const bool local = local_axes_ || gizmo_mode_ == GizmoMode::scale;
  if (local && long_enough(place.x) && long_enough(place.y) && long_enough(place.z))
    result.axes = {normalize(place.x), normalize(place.y), normalize(place.z)};
  return result;
}

void Viewport::show_status() {
  const LiveStatus s = render_.status();
  emit status_changed(tr("%1 samples   noise %2   %3 s%4")
                          .arg(s.samples)
                          .arg(s.noise, 0, 'g', 2)
                          .arg(s.seconds, 0, 'f', 1)
                          .arg(s.running ? "" : tr("   at rest")));
}

void Viewport::resizeEvent(QResizeEvent*) { render_.resize(size() * devicePixelRatioF()); }

void Viewport::click(const QPointF& at, bool add) {
  const std::optional<Pick> pick = render_.pick(at * devicePixelRatioF());
  const bool known = pick && std::size_t(pick->node) < document_.scene().nodes.size();
  document_.select_node(known ? pick->node : kNone, add);
}

void Viewport::set_focus(const QPointF& at) {
  emit focus_set();
  const std::optional<Pick> pick = render_.pick(at * devicePixelRatioF());
  const Scene& scene = document_.scene();
  int node = looked_through_;
  if (const int active = document_.selection().active();
      document_.selection().kind == Selection::Kind::nodes &&
      scene.nodes[std::size_t(active)].camera != kNone)
    node = active;
  if (node == kNone)
    for (std::size_t i = 0; i < scene.nodes.size() && node == kNone; ++i)
      if (scene.nodes[i].camera != kNone) node = int(i);
  if (!pick || node == kNone) {
    emit document_.refused(pick ? tr("There is no camera to focus")
                                : tr("There is nothing to focus on there"));
    return;
  }
  const Mat4d world = edit::find_to_world(scene, node, edit::find_parents(scene));
  const Affine place = to_affine(world);
  const float distance = (pick->position - place.origin).dot(-normalize(place.z));
  const int camera = scene.nodes[std::size_t(node)].camera;
  document_.edit(tr("Focus"), [&](Scene& edited) {
    Camera& lens_owner = edited.cameras[std::size_t(camera)];
    if (!lens_owner.lens) lens_owner.lens.emplace();
    const auto properties = edit::camera_properties(lens_owner);
    edit::find_property(properties, "lens.focus_distance").set(edited, camera, double(distance));
  });
  if (node == looked_through_) look_through(node);
}

}  // namespace parian::editor

#include "apps/editor/inspector.h"

#include <QGroupBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QTimer>
#include <QVBoxLayout>

#include <exception>

#include "apps/editor/node_model.h"
#include "editing/textures.h"

namespace parian::editor {

Inspector::Inspector(Document& document, QWidget* parent) : QScrollArea(parent), document_(document) {
  setWidgetResizable(true);
  setMinimumWidth(400);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  // Later, since it may be a field that is at work, and it must live until it is done.
  const auto later = [this] { QTimer::singleShot(0, this, &Inspector::follow); };
  connect(&document_, &Document::scene_changed, this, later);
  connect(&document_, &Document::scene_replaced, this, later);
  connect(&document_, &Document::selection_changed, this, later);
  rebuild();
}

QString Inspector::apply(const QString& name, const Document::Command& command, bool done) {
  if (!done) return document_.drag(name, command);
  if (!document_.is_dragging()) return document_.edit(name, command);
  const QString reason = document_.drag(name, command);
  document_.finish_drag();
  return reason;
}

int Inspector::slot_material() const {
  const Scene& scene = document_.scene();
  const int active = document_.selection().active();
  if (document_.selection().kind == Selection::Kind::material) return active;
  if (document_.selection().kind != Selection::Kind::nodes) return kNone;
  const Node& node = scene.nodes[std::size_t(active)];
  if (node.shape != kNone) return node.shape_material;
  if (node.mesh == kNone) return kNone;
  const auto& primitives = scene.meshes[std::size_t(node.mesh)].primitives;
  return std::size_t(primitive_) < primitives.size() ? primitives[std::size_t(primitive_)].material : kNone;
}

// Everything whose change makes other rows, and nothing else: as long as it is the same, values are brought
// into the fields that there are.
QStringList Inspector::outline() const {
  const Selection& selection = document_.selection();
  const Scene& scene = document_.scene();
  QStringList names{QString::number(int(selection.kind)), QString::number(selection.active())};
  const auto add = [&](const std::vector<edit::Property>& properties) {
    for (const edit::Property& p : properties) names << QString::fromStdString(std::string(p.name));
  };
  const auto at = [](const auto& array, int i) -> const auto& { return array[std::size_t(i)]; };
  if (selection.kind == Selection::Kind::light)
    add(edit::light_properties(at(scene.lights, selection.active())));
  if (selection.kind == Selection::Kind::camera)
    add(edit::camera_properties(at(scene.cameras, selection.active())));
  if (selection.kind == Selection::Kind::nodes) {
    const Node& node = at(scene.nodes, selection.active());
    for (const int i : {node.mesh, node.shape, node.light, node.camera, primitive_})
      names << QString::number(i);
    if (node.shape != kNone) add(edit::shape_properties(at(scene.shapes, node.shape)));
    if (node.light != kNone) add(edit::light_properties(at(scene.lights, node.light)));
    if (node.camera != kNone) add(edit::camera_properties(at(scene.cameras, node.camera)));
  }
  if (const int material = slot_material(); material != kNone) {
    names << QString::number(material);
    add(edit::material_properties(at(scene.materials, material)));
    for (const auto slot : edit::texture_slots(at(scene.materials, material)))
      names << QString::fromStdString(std::string(slot));
    for (const Material& m : scene.materials) names << QString::fromStdString(m.name);
  }
  if (selection.kind == Selection::Kind::environment) names << QString::number(scene.environment.image);
  return names;
}

void Inspector::follow() {
  if (outline() == outline_)
    refresh();
  else
    rebuild();
}

void Inspector::refresh() {
  for (const auto& row : refresh_) {
    try {
      row(document_.scene());
    } catch (const std::exception&) {
      return;  // what it was about has just gone; the rows follow
    }
  }
}

void Inspector::rebuild() {
  refresh_.clear();
  if (QWidget* old = widget()) {
    // What was half written there must not be entered into what has that number now.
    for (QWidget* field : old->findChildren<QWidget*>()) field->blockSignals(true);
    takeWidget()->deleteLater();
  }
  content_ = new QWidget(this);
  auto* layout = new QVBoxLayout(content_);
  layout->setAlignment(Qt::AlignTop);
  const Selection& selection = document_.selection();
  const Scene& scene = document_.scene();
  const int active = selection.active();
  switch (selection.kind) {
    case Selection::Kind::nodes:
      if (const Node& node = scene.nodes[std::size_t(active)];
          node.mesh == kNone ||
          std::size_t(primitive_) >= scene.meshes[std::size_t(node.mesh)].primitives.size())
        primitive_ = 0;
      add_node(active);
      break;
    case Selection::Kind::material:
      add_material(active);
      break;
    case Selection::Kind::light:
      add_properties(tr("Light"), edit::light_properties(scene.lights[std::size_t(active)]), active);
      break;
    case Selection::Kind::camera:
      add_properties(tr("Camera"), edit::camera_properties(scene.cameras[std::size_t(active)]), active);
      break;
    case Selection::Kind::environment:
      add_environment();
      break;
    case Selection::Kind::none:
      layout->addWidget(new QLabel(tr("Nothing is selected"), content_));
  }
  outline_ = outline();
  setWidget(content_);
  refresh();
}

QFormLayout* Inspector::add_section(const QString& title) {
  auto* box = new QGroupBox(title, content_);
  auto* form = new QFormLayout(box);
  form->setContentsMargins(6, 6, 6, 6);
  form->setVerticalSpacing(3);
  content_->layout()->addWidget(box);
  return form;
}

void Inspector::add_property(QFormLayout* form, const edit::Property& property, int index) {
  const QString label = QString::fromStdString(std::string(property.label));
  const QString unit = QString::fromStdString(std::string(property.unit));
  const Field field = make_field(
      property,
      [this, property, index, label](const edit::PropertyValue& value, bool done) {
        return apply(
            label, [&](Scene& scene) { property.set(scene, index, value); }, done);
      },
      form->parentWidget());
  field.widget->setObjectName(QString::fromStdString(std::string(property.name)));
  form->addRow(make_label(unit.isEmpty() ? label : QString("%1 [%2]").arg(label, unit),
                          qobject_cast<NumberField*>(field.widget), form->parentWidget()),
               field.widget);
  refresh_.push_back([property, index, show = field.show](const Scene& s) { show(property.get(s, index)); });
}

void Inspector::add_properties(const QString& title, const std::vector<edit::Property>& properties,
                               int index) {
  QFormLayout* form = add_section(title);
  for (const edit::Property& property : properties) add_property(form, property, index);
}

void Inspector::add_vector(QFormLayout* form, const QString& label, const edit::Property& like,
                           std::function<Vec3f(const Scene&)> get,
                           std::function<void(Scene&, const Vec3f&)> set) {
  auto* row = new QWidget(form->parentWidget());
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  for (int c = 0; c < 3; ++c) {
    auto* field = new NumberField(
        like,
        [=, this](const edit::PropertyValue& value, bool done) {
          const auto set_component = [&](Scene& scene) {
            Vec3f v = get(scene);
            v[c] = float(std::get<double>(value));
            set(scene, v);
          };
          return apply(label, set_component, done);
        },
        row);
    field->setObjectName(QString("%1.%2").arg(QString::fromStdString(std::string(like.name))).arg("xyz"[c]));
    layout->addWidget(make_label(QString("XYZ"[c]), field, row));
    layout->addWidget(field, 1);
    refresh_.push_back([=](const Scene& scene) { field->show_number(double(get(scene)[c])); });
  }
  const QString unit = QString::fromStdString(std::string(like.unit));
  form->addRow(unit.isEmpty() ? label : QString("%1 [%2]").arg(label, unit), row);
}

}  // namespace parian::editor

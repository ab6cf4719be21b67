/// The sections of the inspector.
#include <Imath/ImathEuler.h>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QPushButton>
#include <QToolButton>

#include "apps/editor/inspector.h"
#include "editing/arguments.h"
#include "editing/environment.h"
#include "editing/nodes.h"
#include "editing/textures.h"
#include "editing/tree.h"

namespace parian::editor {
namespace {

constexpr float kDegree = kPi / 180;
const char* const kImages = "Images (*.png *.jpg *.jpeg *.webp *.exr *.hdr)";

edit::Property number(std::string_view name, std::string_view unit, double step) {
  edit::Property p;
  p.name = name;
  p.unit = unit;
  p.low = -1e30;
  p.high = 1e30;
  p.step = step;
  return p;
}

/// A node's transform as translation, rotation and scale, also where it is a matrix.
Transform parts_of(const Scene& scene, int node) {
  edit::check_node(scene, node);
  const Transform& t = scene.nodes[std::size_t(node)].transform;
  return t.matrix ? edit::to_transform(t.to_matrix()) : t;
}

/// Degrees about x, y and z, applied in this order.
Vec3f to_angles(const Quatf& q) {
  const Imath::Eulerf euler(q.toMatrix44(), Imath::Eulerf::XYZ);
  return Vec3f(euler.x, euler.y, euler.z) / kDegree;
}

Quatf to_rotation(const Vec3f& degrees) {
  return Imath::Eulerf(degrees * kDegree, Imath::Eulerf::XYZ).toQuat().normalized();
}

}  // namespace

void Inspector::add_node(int index) {
  const Scene& scene = document_.scene();
  const Node& node = scene.nodes[std::size_t(index)];
  QFormLayout* form = add_section(tr("Node"));
  auto* name = new TextField(
      [this, index](const QString& text) {
        return document_.edit(tr("Rename"),
                              [&](Scene& s) { edit::rename_node(s, index, text.toStdString()); });
      },
      form->parentWidget());
  name->setObjectName("node.name");
  form->addRow(tr("Name"), name);
  refresh_.push_back(
      [=](const Scene& s) { name->show_value(QString::fromStdString(s.nodes[std::size_t(index)].name)); });
  add_vector(
      form, tr("Position"), number("position", "m", 0.01),
      [=](const Scene& s) { return parts_of(s, index).translation; },
      [=](Scene& s, const Vec3f& v) {
        edit::set_transform(s, index, {.translation = v, .rotation = {}, .scale = {}});
      });
  add_vector(
      form, tr("Rotation"), number("rotation", "degrees", 1),
      [=](const Scene& s) { return to_angles(parts_of(s, index).rotation); },
      [=](Scene& s, const Vec3f& v) {
        edit::set_transform(s, index, {.translation = {}, .rotation = to_rotation(v), .scale = {}});
      });
  add_vector(
      form, tr("Scale"), number("scale", "", 0.01), [=](const Scene& s) { return parts_of(s, index).scale; },
      [=](Scene& s, const Vec3f& v) {
        edit::set_transform(s, index, {.translation = {}, .rotation = {}, .scale = v});
      });
  if (node.shape != kNone)
    add_properties(tr("Shape"), edit::shape_properties(scene.shapes[std::size_t(node.shape)]), node.shape);
  if (node.light != kNone)
    add_properties(tr("Light"), edit::light_properties(scene.lights[std::size_t(node.light)]), node.light);
  if (node.camera != kNone)
    add_properties(tr("Camera"), edit::camera_properties(scene.cameras[std::size_t(node.camera)]),
                   node.camera);
  if (node.mesh != kNone || node.shape != kNone) add_material_slot(index);
}

void Inspector::add_material_slot(int index) {
  const Scene& scene = document_.scene();
  const Node& node = scene.nodes[std::size_t(index)];
  QFormLayout* form = add_section(tr("Surface"));
  const edit::MaterialSlot slot{index, node.shape != kNone ? kNone : primitive_};
  if (node.shape == kNone && scene.meshes[std::size_t(node.mesh)].primitives.size() > 1) {
    auto* which = new QComboBox(form->parentWidget());
    for (std::size_t i = 0; i < scene.meshes[std::size_t(node.mesh)].primitives.size(); ++i)
      which->addItem(tr("part %1").arg(i));
    which->setCurrentIndex(primitive_);
    connect(which, &QComboBox::activated, this, [this](int i) {
      primitive_ = i;
      follow();
    });
    form->addRow(tr("Part"), which);
  }
  if (slot_material() == kNone) return;
  auto* choice = new QComboBox(form->parentWidget());
  choice->setObjectName("material");
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    choice->addItem(scene.materials[i].name.empty() ? tr("material %1").arg(i)
                                                    : QString::fromStdString(scene.materials[i].name));
  choice->setCurrentIndex(slot_material());
  connect(choice, &QComboBox::activated, this, [this, slot](int material) {
    document_.edit(tr("Assign material"), [&](Scene& s) { edit::assign_material(s, slot, material); });
  });
  form->addRow(tr("Material"), choice);
  auto* own = new QPushButton(tr("Make it this one's own"), form->parentWidget());
  own->setToolTip(tr("A copy of the material, for this surface alone"));
  connect(own, &QPushButton::clicked, this, [this, slot] {
    document_.edit(tr("Own material"), [&](Scene& s) { edit::make_single_user(s, slot); });
  });
  form->addRow("", own);
  add_material(slot_material());
}

void Inspector::add_material(int index) {
  const Material& material = document_.scene().materials[std::size_t(index)];
  add_properties(tr("Material"), edit::material_properties(material), index);
  QFormLayout* form = add_section(tr("Textures"));
  for (const std::string_view slot : edit::texture_slots(material))
    add_texture(form, index, std::string(slot));
}

void Inspector::add_texture(QFormLayout* form, int material, const std::string& slot) {
  auto* row = new QWidget(form->parentWidget());
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  auto* file = new QPushButton(row);
  auto* remove = new QToolButton(row);
  remove->setText(tr("x"));
  remove->setToolTip(tr("Remove"));
  layout->addWidget(file, 1);
  layout->addWidget(remove);
  connect(file, &QPushButton::clicked, this, [this, material, slot] {
    const QString path = QFileDialog::getOpenFileName(this, tr("Texture"), {}, tr(kImages));
    if (path.isEmpty()) return;
    document_.edit(tr("Texture"),
                   [&](Scene& s) { edit::assign_texture(s, material, slot, path.toStdString()); });
  });
  connect(remove, &QToolButton::clicked, this, [this, material, slot] {
    document_.edit(tr("Remove texture"), [&](Scene& s) { edit::remove_texture(s, material, slot); });
  });
  QString label = QString::fromStdString(slot);
  form->addRow(label.replace('_', ' ').replace('.', ": "), row);
  refresh_.push_back([=](const Scene& s) {
    const TextureRef& use = edit::texture_at(s.materials[std::size_t(material)], slot);
    remove->setEnabled(bool(use));
    if (!use) return file->setText(QObject::tr("..."));
    const int image = s.textures[std::size_t(use.texture)].image;
    file->setText(QFileInfo(QString::fromStdString(s.images[std::size_t(image)].name)).fileName());
  });
}

void Inspector::add_environment() {
  add_properties(tr("Environment"), edit::environment_properties(), 0);
  QFormLayout* form = add_section(tr("Image"));
  auto* file = new QPushButton(form->parentWidget());
  auto* remove = new QPushButton(tr("Remove"), form->parentWidget());
  form->addRow(file);
  form->addRow(remove);
  connect(file, &QPushButton::clicked, this, [this] {
    const QString path = QFileDialog::getOpenFileName(this, tr("Environment"), {}, tr(kImages));
    if (path.isEmpty()) return;
    document_.edit(tr("Environment"), [&](Scene& s) { edit::set_environment_image(s, path.toStdString()); });
  });
  connect(remove, &QPushButton::clicked, this,
          [this] { document_.edit(tr("Remove environment"), edit::remove_environment_image); });
  refresh_.push_back([=](const Scene& s) {
    const int image = s.environment.image;
    remove->setEnabled(image != kNone);
    file->setText(image == kNone
                      ? QObject::tr("Choose a file ...")
                      : QFileInfo(QString::fromStdString(s.images[std::size_t(image)].name)).fileName());
  });
}

}  // namespace parian::editor

/// The panel of what is selected: all that can be said of it, with units and ranges. What is entered is an
/// edit of the document; what is refused is said at the field.
#pragma once

#include <QFormLayout>
#include <QScrollArea>

#include <functional>
#include <vector>

#include "apps/editor/document.h"
#include "apps/editor/fields.h"
#include "editing/materials.h"

namespace parian::editor {

class Inspector : public QScrollArea {
  Q_OBJECT

 public:
  explicit Inspector(Document& document, QWidget* parent = nullptr);

 private:
  void follow();
  void rebuild();
  void refresh();
  QStringList outline() const;  // what rows there would be
  int slot_material() const;

  QFormLayout* add_section(const QString& title);
  void add_property(QFormLayout* form, const edit::Property& property, int index);
  void add_properties(const QString& title, const std::vector<edit::Property>& properties, int index);
  void add_vector(QFormLayout* form, const QString& label, const edit::Property& like,
                  std::function<Vec3f(const Scene&)> get, std::function<void(Scene&, const Vec3f&)> set);
  void add_node(int node);
  void add_material_slot(int node);
  void add_material(int material);
  void add_texture(QFormLayout* form, int material, const std::string& slot);
  void add_environment();

  QString apply(const QString& name, const Document::Command& command, bool done);

  Document& document_;
  QWidget* content_ = nullptr;
  QStringList outline_;
  int primitive_ = 0;                                       // whose material is shown, of a mesh
  std::vector<std::function<void(const Scene&)>> refresh_;  // of each row
};

}  // namespace parian::editor

/// The inspector has a field for all that there is to say, and outlives what it shows.
#include <QCheckBox>

#include "editing/add.h"
#include "editing/nodes.h"
#include "tests/apps/editor/support/inspector.h"

namespace parian::editor {
namespace {

using Kind = Selection::Kind;

class InspectorRowsTest : public InspectorTest {
 protected:
  /// All properties of an element have a field in that section, and it shows their values.
  void expect_shown(const QString& title, const std::vector<edit::Property>& properties, int index) {
    ASSERT_NE(section(title), nullptr) << title.toStdString();
    for (const edit::Property& p : properties) {
      const QString name = QString::fromStdString(std::string(p.name));
      auto* widget = field<QWidget>(title, name);
      ASSERT_NE(widget, nullptr) << p.name;
      EXPECT_EQ(text_of(widget), text_of(p.get(scene(), index))) << p.name;
      EXPECT_TRUE(widget->isVisibleTo(&inspector_)) << p.name;
      ++seen_;
    }
  }
  /// Turns on all parts that an element can have.
  template <class Properties>
  void turn_all_on(const Properties& properties_of, int index) {
    bool more = true;
    for (int i = 0; more && i < 100; ++i) {
      more = false;
      for (const edit::Property& p : properties_of())
        if (p.kind == edit::PropertyKind::toggle && !std::get<bool>(p.get(scene(), index)))
          more = more || document_.edit("On", [&](Scene& s) { p.set(s, index, true); }).isEmpty();
    }
  }
  int seen_ = 0;

 private:
  static QString text_of(double v) { return QString::number(v, 'g', 6); }
  static QString text_of(const edit::PropertyValue& value) {
    if (const auto* v = std::get_if<double>(&value)) return text_of(*v);
    if (const auto* v = std::get_if<int>(&value)) return QString::number(*v);
    if (const auto* v = std::get_if<bool>(&value)) return *v ? "on" : "off";
    if (const auto* v = std::get_if<std::string>(&value)) return QString::fromStdString(*v);
    const Rgb& c = std::get<Rgb>(value);
    return QStringList({text_of(double(c.x)), text_of(double(c.y)), text_of(double(c.z))}).join(' ');
  }
  static QString text_of(QWidget* widget) {
    if (auto* f = qobject_cast<QLineEdit*>(widget)) return f->text();
    if (auto* f = qobject_cast<QCheckBox*>(widget)) return f->isChecked() ? "on" : "off";
    if (auto* f = qobject_cast<QComboBox*>(widget)) return f->currentText();
    QStringList parts;
    for (auto* part : widget->findChildren<NumberField*>()) parts << part->text();
    return parts.join(' ');
  }
};

TEST_F(InspectorRowsTest, OfMaterials) {
  const auto properties = [this] { return edit::material_properties(material(0)); };
  select(Kind::material, 0);
  const std::vector<std::string> types = edit::find_property(properties(), "type").choices;
  for (const std::string& type : types) {
    document_.edit("Type", [&](Scene& s) { edit::find_property(properties(), "type").set(s, 0, type); });
    turn_all_on(properties, 0);
    settle();
    expect_shown("Material", properties(), 0);
  }
  EXPECT_GT(seen_, 50);
}

TEST_F(InspectorRowsTest, OfLights) {
  for (const LightKind kind :
       {LightKind::point, LightKind::spot, LightKind::directional, LightKind::rectangle, LightKind::disk}) {
    int node = kNone;
    document_.edit("Add", [&](Scene& s) { node = edit::add_light(s, edit::default_light(kind)); });
    const int light = scene().nodes[std::size_t(node)].light;
    const auto properties = edit::light_properties(scene().lights[std::size_t(light)]);
    select(Kind::nodes, node);
    expect_shown("Light", properties, light);
    select(Kind::light, light);
    expect_shown("Light", properties, light);
    type(number("Light", "intensity"), "12.5");
    EXPECT_EQ(scene().lights[std::size_t(light)].intensity, 12.5f);
  }
}

TEST_F(InspectorRowsTest, OfShapes) {
  for (const Shape& shape :
       {edit::sphere(1), edit::box({1, 2, 3}), edit::cone(1, 2), edit::cylinder(1, 2), edit::plane(3, 4)}) {
    int node = kNone;
    document_.edit("Add", [&](Scene& s) { node = edit::add_shape(s, shape); });
    const int index = scene().nodes[std::size_t(node)].shape;
    select(Kind::nodes, node);
    expect_shown("Shape", edit::shape_properties(scene().shapes[std::size_t(index)]), index);
    EXPECT_NE(section("Material"), nullptr);
  }
}

TEST_F(InspectorRowsTest, OfCamerasAndTheEnvironment) {
  document_.edit("Lens", [](Scene& s) { s.cameras[0].lens.emplace(); });
  const auto properties = [this] { return edit::camera_properties(scene().cameras[0]); };
  for (const char* projection : {"perspective", "orthographic"}) {
    document_.edit("Projection",
                   [&](Scene& s) { edit::find_property(properties(), "projection").set(s, 0, projection); });
    select(Kind::nodes, 8);
    expect_shown("Camera", properties(), 0);
    select(Kind::camera, 0);
    expect_shown("Camera", properties(), 0);
  }
  document_.select({Kind::environment, {}});
  settle();
  expect_shown("Environment", edit::environment_properties(), 0);
  type(number("Environment", "radiance"), "2");
  EXPECT_EQ(scene().environment.radiance, Rgb(2));
}

// Also where a value was half written, or the hand was at a label: nothing of it gets into another element.
TEST_F(InspectorRowsTest, OutliveTheirElement) {
  for (const bool dragging : {false, true}) {
    int node = kNone;
    document_.edit("Add", [&](Scene& s) { node = edit::add_shape(s, edit::sphere(1)); });
    select(Kind::nodes, node);
    const Scene before = scene();
    NumberField *radius = number("Shape", "radius"), *x = number("Node", "position.x");
    ASSERT_NE(radius, nullptr);
    QLabel* label = label_of(x);
    if (dragging) {
      QTest::mousePress(label, Qt::LeftButton, {}, {4, 6});
      QTest::mouseMove(label, {80, 6});
    } else {
      x->setFocus();
      x->selectAll();
      QTest::keyClicks(x, "7");
    }
    document_.history().undo();  // the fields are still there
    const Scene empty = scene();
    EXPECT_EQ(empty.nodes.size() + 1, before.nodes.size());
    if (dragging) {
      QTest::mouseMove(label, {90, 6});
      QTest::mouseRelease(label, Qt::LeftButton, {}, {90, 6});
    } else {
      QTest::keyClick(x, Qt::Key_Return);
      type(radius, "3");
      QTest::keyClick(radius, Qt::Key_Up);
    }
    EXPECT_EQ(scene(), empty);
    settle();
    EXPECT_EQ(section("Shape"), nullptr);
    document_.history().redo();
    EXPECT_EQ(scene(), before);
    document_.history().undo();
  }
}

TEST_F(InspectorRowsTest, HalfWrittenGoesWithItsElement) {
  select(Kind::nodes, 5);
  NumberField* x = number("Node", "position.x");
  x->setFocus();
  x->selectAll();
  QTest::keyClicks(x, "7");
  const Scene before = scene();
  document_.select({Kind::nodes, {6}});  // not by a click, which would end the writing first
  settle();
  EXPECT_EQ(scene(), before);
  EXPECT_EQ(number("Node", "position.x")->text(), "0");
}

}  // namespace
}  // namespace parian::editor

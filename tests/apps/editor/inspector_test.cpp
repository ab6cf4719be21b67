#include "tests/apps/editor/support/inspector.h"

#include <QCheckBox>
#include <QPushButton>

#include "editing/add.h"
#include "editing/nodes.h"
#include "editing/textures.h"

namespace parian::editor {
namespace {

using Kind = Selection::Kind;

TEST_F(InspectorTest, TakesANumber) {
  select(Kind::material, 1);
  NumberField* roughness = number("Material", "roughness");
  ASSERT_NE(roughness, nullptr);
  EXPECT_EQ(roughness->text(), "1");
  type(roughness, "0.25");
  EXPECT_EQ(material(1).roughness, 0.25f);
  EXPECT_EQ(steps(), 1);
  document_.history().undo();
  settle();
  EXPECT_EQ(material(1).roughness, 1);
  EXPECT_EQ(number("Material", "roughness")->text(), "1") << "undo brings the old value into the field";
}

TEST_F(InspectorTest, TakesAColour) {
  select(Kind::material, 2);
  type(component("Material", "base_color", 1), "0.5");
  EXPECT_EQ(material(2).base_color, Rgb(0.14f, 0.5f, 0.091f));
  EXPECT_EQ(steps(), 1);
  document_.history().undo();
  settle();
  EXPECT_EQ(component("Material", "base_color", 1)->text(), "0.45");
}

TEST_F(InspectorTest, TakesAToggleAndAChoice) {
  select(Kind::material, 0);
  QTest::mouseClick(field<QCheckBox>("Material", "double_sided"), Qt::LeftButton, {}, QPoint(8, 8));
  EXPECT_TRUE(material(0).double_sided);
  auto* alpha = field<QComboBox>("Material", "alpha_mode");
  alpha->setFocus();
  QTest::keyClick(alpha, Qt::Key_Down);
  EXPECT_EQ(material(0).alpha_mode, AlphaMode::mask);
  EXPECT_EQ(steps(), 2);
  document_.history().undo();
  document_.history().undo();
  settle();
  EXPECT_FALSE(field<QCheckBox>("Material", "double_sided")->isChecked());
  EXPECT_EQ(field<QComboBox>("Material", "alpha_mode")->currentText(), "opaque");
}

TEST_F(InspectorTest, TakesATextAndAVector) {
  select(Kind::nodes, 6);
  type(field<TextField>("Node", "node.name"), "tower");
  EXPECT_EQ(scene().nodes[6].name, "tower");
  type(number("Node", "position.y"), "-1.5e-1");
  EXPECT_EQ(scene().nodes[6].transform.translation, Vec3f(0, -0.15f, 0));
  type(number("Node", "rotation.z"), "90");
  type(number("Node", "scale.x"), "2");
  EXPECT_EQ(steps(), 4);
  settle();
  EXPECT_EQ(number("Node", "rotation.z")->text(), "90");
  EXPECT_EQ(number("Node", "scale.x")->text(), "2");
  for (int i = 0; i < 4; ++i) document_.history().undo();
  settle();
  EXPECT_EQ(field<TextField>("Node", "node.name")->text(), "tall block");
  EXPECT_EQ(number("Node", "position.y")->text(), "0");
}

TEST_F(InspectorTest, RefusesInPlace) {
  document_.edit("Add", [](Scene& s) { edit::add_shape(s, edit::sphere(0.1f)); });
  const int sphere = int(scene().nodes.size()) - 1;
  select(Kind::nodes, sphere);
  const Scene before = scene();
  const auto refuses = [&](QLineEdit* field, const QString& text) {
    ASSERT_NE(field, nullptr);
    const QString shown = field->text();
    type(field, text);
    settle();
    EXPECT_EQ(field->text(), shown) << text.toStdString();
    EXPECT_TRUE(field->toolTip().contains("expected"))
        << text.toStdString() << field->toolTip().toStdString();
    EXPECT_EQ(scene(), before) << text.toStdString();
    EXPECT_EQ(steps(), 1) << text.toStdString();
  };
  for (const char* text : {"wide", "", "1,5", "nan", "inf", "-inf", "-1", "1.5", "1e999"})
    refuses(number("Material", "roughness"), text);
  for (const char* text : {"nan", "inf", "1e39", "1 2"}) refuses(number("Node", "position.x"), text);
  for (const char* text : {"0", "-1", "nan"}) refuses(number("Shape", "radius"), text);
  refuses(component("Material", "base_color", 0), "1.01");
  refuses(number("Node", "rotation.x"), "nan");
  NumberField* roughness = number("Material", "roughness");
  const QString reason = roughness->toolTip();
  QTest::keyClicks(roughness, "1");
  EXPECT_NE(roughness->toolTip(), reason) << "it is gone when something else is entered";
}

// A choice or a toggle that is refused is shown as it was.
TEST_F(InspectorTest, RefusesWhatIsClicked) {
  const Enter refuse = [](const edit::PropertyValue&, bool) { return QString("expected something else"); };
  edit::Property property;
  property.kind = edit::PropertyKind::toggle;
  QWidget window;
  const Field toggle = make_field(property, refuse, &window);
  property.kind = edit::PropertyKind::choice;
  property.choices = {"a", "b", "c"};
  const Field choice = make_field(property, refuse, &window);
  window.show();
  toggle.show(false);
  choice.show(std::string("b"));
  QTest::mouseClick(toggle.widget, Qt::LeftButton, {}, QPoint(8, 8));
  QTest::keyClick(choice.widget, Qt::Key_Down);
  EXPECT_FALSE(qobject_cast<QCheckBox*>(toggle.widget)->isChecked());
  EXPECT_EQ(qobject_cast<QComboBox*>(choice.widget)->currentText(), "b");
  for (const QWidget* widget : {toggle.widget, choice.widget})
    EXPECT_EQ(widget->toolTip(), "expected something else");
}

// With no time for the panel in between.
TEST_F(InspectorTest, StepsByKeys) {
  select(Kind::material, 0);
  NumberField* roughness = number("Material", "roughness");
  roughness->setFocus();
  for (int i = 0; i < 3; ++i) QTest::keyClick(roughness, Qt::Key_Down);
  QTest::keyClick(roughness, Qt::Key_Down, Qt::ShiftModifier);
  EXPECT_NEAR(material(0).roughness, 0.87f, 1e-5f);
  for (int i = 0; i < 3; ++i) QTest::keyClick(roughness, Qt::Key_Up, Qt::ShiftModifier);
  EXPECT_EQ(material(0).roughness, 1) << "not beyond the range";
}

TEST_F(InspectorTest, ADraggedLabelIsOneStep) {
  select(Kind::nodes, 6);
  for (QWidget* dragged : {number("Node", "position.x"), number("Material", "roughness")}) {
    const int before = steps();
    const Scene start = scene();
    QLabel* label = label_of(dragged);
    ASSERT_NE(label, nullptr);
    const QPoint from(4, 6);
    QTest::mousePress(label, Qt::LeftButton, {}, from);
    for (const int x : {-10, -30, -60}) {
      QTest::mouseMove(label, from + QPoint(x, 0));
      if (x == -10) settle();
    }
    EXPECT_EQ(steps(), before) << "still in the hand";
    QTest::mouseRelease(label, Qt::LeftButton, {}, from + QPoint(-60, 0));
    EXPECT_EQ(steps(), before + 1);
    if (dragged->objectName() == "position.x") {
      EXPECT_NEAR(scene().nodes[6].transform.translation.x, -0.3f, 1e-5f);
    } else {
      EXPECT_NEAR(material(0).roughness, 0.7f, 1e-5f);
    }
    document_.history().undo();
    EXPECT_EQ(scene(), start);
    document_.history().redo();
    settle();
  }
}

TEST_F(InspectorTest, TheTypeOfAMaterialChangesTheRows) {
  select(Kind::material, 0);
  const auto choose = [&](const QString& type) {
    auto* box = field<QComboBox>("Material", "type");
    box->setCurrentText(type);
    emit box->textActivated(type);  // as a click on its list does
    settle();
  };
  EXPECT_NE(number("Material", "metallic"), nullptr);
  choose("conductor");
  EXPECT_TRUE(material(0).conductor);
  EXPECT_EQ(number("Material", "metallic"), nullptr);
  EXPECT_NE(field<QComboBox>("Material", "conductor.metal"), nullptr);
  choose("phong");
  EXPECT_NE(number("Material", "phong.exponent"), nullptr);
  document_.history().undo();
  settle();
  EXPECT_NE(field<QComboBox>("Material", "conductor.metal"), nullptr);
  document_.history().undo();
  settle();
  EXPECT_NE(number("Material", "metallic"), nullptr);
}

TEST_F(InspectorTest, ShowsATexture) {
  select(Kind::material, 0);
  Image image;
  image.name = "folder/bricks.png";
  image.width = image.height = 1;
  image.channels = 3;
  image.pixels = std::vector<std::byte>(3);
  document_.edit("Texture", [&](Scene& s) { edit::assign_texture(s, 0, "base_color", image); });
  settle();
  const auto texts = [&] {
    QStringList all;
    for (const auto* button : section("Textures")->findChildren<QPushButton*>()) all << button->text();
    return all;
  };
  EXPECT_TRUE(texts().contains("bricks.png"));
  for (auto* button : section("Textures")->findChildren<QAbstractButton*>())
    if (button->toolTip() == "Remove" && button->isEnabled()) QTest::mouseClick(button, Qt::LeftButton);
  EXPECT_FALSE(material(0).base_color_texture);
  settle();
  EXPECT_FALSE(texts().contains("bricks.png"));
  document_.history().undo();
  settle();
  EXPECT_TRUE(texts().contains("bricks.png"));
}

}  // namespace
}  // namespace parian::editor

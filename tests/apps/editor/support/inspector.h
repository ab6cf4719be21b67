/// An inspector with its document, and its fields by section and name.
#pragma once

#include <QComboBox>
#include <QGroupBox>
#include <QLabel>
#include <QTimer>

#include "apps/editor/inspector.h"
#include "tests/apps/editor/support/editor_test.h"
#include "tests/apps/editor/support/widgets.h"

namespace parian::editor {

class InspectorTest : public EditorTest {
 protected:
  InspectorTest() : inspector_(document_) {
    document_.load({scene_file("cornell-box")});
    inspector_.resize(420, 900);
    inspector_.show();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&inspector_));
  }

  /// Selects, and waits until the rows are there.
  void select(Selection::Kind kind, int index) {
    document_.select({kind, {index}});
    settle();
  }
  /// What the panel does later is done.
  static void settle() {
    bool done = false;
    QTimer::singleShot(0, [&] { done = true; });
    EXPECT_TRUE(wait_for([&] { return done; }));
  }
  QGroupBox* section(const QString& title) const {
    for (auto* box : inspector_.widget()->findChildren<QGroupBox*>())
      if (box->title() == title) return box;
    return nullptr;
  }
  template <class Widget>
  Widget* field(const QString& title, const QString& name) const {
    const QGroupBox* box = section(title);
    return box ? box->findChild<Widget*>(name) : nullptr;
  }
  NumberField* number(const QString& title, const QString& name) const {
    return field<NumberField>(title, name);
  }
  /// The component of a colour.
  NumberField* component(const QString& title, const QString& name, int i) const {
    auto* color = field<ColorField>(title, name);
    return color ? color->findChildren<NumberField*>().value(i) : nullptr;
  }
  /// The label that drags a field: the last one in front of it.
  static QLabel* label_of(QWidget* field) {
    QLabel* found = nullptr;
    const QRect at = field->geometry();
    for (auto* label : field->parentWidget()->findChildren<QLabel*>(QString(), Qt::FindDirectChildrenOnly))
      if (std::abs(label->geometry().center().y() - at.center().y()) < 10 && label->x() < at.left() &&
          (!found || label->x() > found->x()))
        found = label;
    return found;
  }
  int steps() { return document_.history().count(); }
  const Scene& scene() const { return document_.scene(); }
  const Material& material(int i) const { return scene().materials[std::size_t(i)]; }

  Document document_;
  Inspector inspector_;
};

}  // namespace parian::editor

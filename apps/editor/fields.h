/// One-line fields of the inspector. Each shows a value, and hands on what the user enters; what is refused
/// is said in place and the value of before comes back.
#pragma once

#include <QLineEdit>
#include <QPushButton>
#include <QWidget>

#include <functional>

#include "editing/properties.h"

namespace parian::editor {

/// What becomes of a value that was entered: "" where it is taken, or the reason why it is not. `done` is
/// false while the hand is still at it.
using Enter = std::function<QString(const edit::PropertyValue& value, bool done)>;

/// A text of which the user may enter another.
class TextField : public QLineEdit {
  Q_OBJECT

 public:
  TextField(std::function<QString(const QString&)> enter, QWidget* parent = nullptr);
  void show_value(const QString& text);
  /// What is said of the field as long as nothing is refused.
  void set_hint(const QString& text);

 protected:
  /// Says why, at the field, until something else is entered; shows the old value again.
  void refuse(const QString& reason);

 private:
  QString shown_, hint_;
  std::function<QString(const QString&)> enter_;
};

/// A number: typed, by the wheel, by arrow keys (a step; with Shift ten), or by dragging its label.
class NumberField : public TextField {
  Q_OBJECT

 public:
  NumberField(const edit::Property& property, Enter enter, QWidget* parent = nullptr);
  void show_number(double value);

  /// Dragged by so many pixels since it was taken hold of.
  void drag(double pixels);
  void end_drag();

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  QString give(double value, bool done);

  edit::PropertyKind kind_;
  double low_, high_, step_, value_ = 0, start_ = 0;
  bool dragging_ = false;
  Enter enter_;
};

/// A linear colour: its three numbers, and a patch that opens a dialog.
class ColorField : public QWidget {
  Q_OBJECT

 public:
  ColorField(const edit::Property& property, Enter enter, QWidget* parent = nullptr);
  void show_color(const Rgb& color);

 private:
  void choose();

  Rgb color_{0, 0, 0};
  NumberField* parts_[3];
  QPushButton* patch_;
  Enter enter_;
};

/// The field for a property. `show` brings a value into it.
struct Field {
  QWidget* widget;
  std::function<void(const edit::PropertyValue&)> show;
};
Field make_field(const edit::Property& property, Enter enter, QWidget* parent);

/// A label that drags a number.
class DragLabel;
QWidget* make_label(const QString& text, NumberField* dragged, QWidget* parent);

}  // namespace parian::editor

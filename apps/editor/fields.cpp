#include "apps/editor/fields.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMouseEvent>
#include <QToolTip>
#include <QWheelEvent>

#include <algorithm>
#include <cmath>
#include <memory>

namespace parian::editor {
namespace {

// What the screen shows of a linear value, and back (IEC 61966-2-1).
double encode(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; }
double decode(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

QColor to_screen(const Rgb& c) {
  const auto byte = [](float v) { return int(std::lround(255 * encode(std::clamp(double(v), 0.0, 1.0)))); };
  return {byte(c.x), byte(c.y), byte(c.z)};
}

QString unit_suffix(const edit::Property& property) {
  return property.unit.empty()
             ? ""
             : QString(" [%1]").arg(QString::fromUtf8(property.unit.data(), qsizetype(property.unit.size())));
}

/// Says why an entry was refused, at its widget. Whether it was taken.
bool answer(QWidget* widget, const QString& reason) {
  widget->setToolTip(reason);
  if (!reason.isEmpty()) QToolTip::showText(widget->mapToGlobal(QPoint(0, widget->height())), reason, widget);
  return reason.isEmpty();
}

/// Drags the number that it names.
class NumberLabel : public QLabel {
 public:
  NumberLabel(const QString& text, NumberField* field, QWidget* parent)
      : QLabel(text, parent), field_(field) {
    setCursor(Qt::SizeHorCursor);
  }

 protected:
  void mousePressEvent(QMouseEvent* event) override { pressed_ = event->globalPosition().x(); }
  void mouseMoveEvent(QMouseEvent* event) override { field_->drag(event->globalPosition().x() - pressed_); }
  void mouseReleaseEvent(QMouseEvent*) override { field_->end_drag(); }

 private:
  NumberField* field_;
  double pressed_ = 0;
};

}  // namespace

TextField::TextField(std::function<QString(const QString&)> enter, QWidget* parent)
    : QLineEdit(parent), enter_(std::move(enter)) {
  connect(this, &QLineEdit::editingFinished, this, [this] {
    if (text() == shown_) return;
    const QString entered = text(), reason = enter_(entered);
    if (!reason.isEmpty()) return refuse(reason);
    setModified(false);
    show_value(entered);
  });
  connect(this, &QLineEdit::textEdited, this, [this] {
    setStyleSheet("");
    setToolTip(hint_);
  });
}

void TextField::set_hint(const QString& text) {
  hint_ = text;
  setToolTip(text);
}

void TextField::show_value(const QString& text) {
  shown_ = text;
  if (hasFocus() && isModified()) return;  // the user is writing
  setText(text);
  setCursorPosition(0);
}

void TextField::refuse(const QString& reason) {
  setText(shown_);
  setStyleSheet("border: 1px solid #d04040");
  setToolTip(reason);
  QToolTip::showText(mapToGlobal(QPoint(0, height())), reason, this);
}

NumberField::NumberField(const edit::Property& property, Enter enter, QWidget* parent)
    : TextField(
          [this](const QString& text) -> QString {
            bool ok = false;
            const double value = text.trimmed().toDouble(&ok);
            if (!ok) return tr("expected a number, not \"%1\"").arg(text);
            return give(value, true);
          },
          parent),
      kind_(property.kind),
      low_(property.low),
      high_(property.high),
      step_(property.step > 0 ? property.step : 1),
      enter_(std::move(enter)) {
  setAlignment(Qt::AlignRight);
  setMinimumWidth(44);
}

QString NumberField::give(double value, bool done) {
  const bool whole = kind_ == edit::PropertyKind::integer;
  if (whole && (value != std::floor(value) || std::abs(value) > 2e9)) return tr("expected a whole number");
  const QString reason = whole ? enter_(int(value), done) : enter_(value, done);
  // The panel shows it later; what comes before goes on from here.
  if (reason.isEmpty()) value_ = value;
  return reason;
}

void NumberField::show_number(double value) {
  value_ = value;
  // Floats of a scene: six digits say them well enough, and .1 does not become .100000001.
  show_value(QString::number(value, 'g', 6));
}

void NumberField::drag(double pixels) {
  if (!std::exchange(dragging_, true)) start_ = value_;
  const double value = std::clamp(start_ + std::round(pixels / 2) * step_, low_, high_);
  give(value, false);
}

void NumberField::end_drag() {
  if (std::exchange(dragging_, false)) give(value_, true);
}

void NumberField::keyPressEvent(QKeyEvent* event) {
  if (event->key() != Qt::Key_Up && event->key() != Qt::Key_Down) return TextField::keyPressEvent(event);
  const double steps =
      (event->key() == Qt::Key_Up ? 1 : -1) * (event->modifiers() & Qt::ShiftModifier ? 10 : 1);
  const QString reason = give(std::clamp(value_ + steps * step_, low_, high_), true);
  if (!reason.isEmpty()) refuse(reason);
}

void NumberField::wheelEvent(QWheelEvent* event) {
  if (!hasFocus()) return event->ignore();  // the panel scrolls
  const QString reason = give(std::clamp(value_ + event->angleDelta().y() / 120 * step_, low_, high_), true);
  if (!reason.isEmpty()) refuse(reason);
  event->accept();
}

ColorField::ColorField(const edit::Property& property, Enter enter, QWidget* parent)
    : QWidget(parent), patch_(new QPushButton(this)), enter_(std::move(enter)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(2);
  edit::Property part = property;
  part.kind = edit::PropertyKind::number;
  for (int c = 0; c < 3; ++c) {
    parts_[c] = new NumberField(
        part,
        [this, c](const edit::PropertyValue& value, bool done) {
          Rgb color = color_;
          color[c] = float(std::get<double>(value));
          return enter_(color, done);
        },
        this);
    layout->addWidget(parts_[c]);
  }
  patch_->setFixedWidth(24);
  patch_->setToolTip(tr("Choose a colour; a strength above 1 is kept"));
  layout->addWidget(patch_);
  connect(patch_, &QPushButton::clicked, this, &ColorField::choose);
}

void ColorField::show_color(const Rgb& color) {
  color_ = color;
  for (int c = 0; c < 3; ++c) parts_[c]->show_number(double(color[c]));
  patch_->setStyleSheet(QString("background: %1").arg(to_screen(color).name()));
}

void ColorField::choose() {
  // The dialog knows up to 1: a brighter colour is shown by its hue, and its strength multiplies what is
  // chosen.
  const float strength = std::max(1.0f, std::max({color_.x, color_.y, color_.z}));
  const Rgb before = color_;
  QColorDialog dialog(to_screen(color_ / strength), this);
  const auto to_linear = [strength](const QColor& c) {
    return Rgb(float(decode(c.redF())), float(decode(c.greenF())), float(decode(c.blueF()))) * strength;
  };
  connect(&dialog, &QColorDialog::currentColorChanged, this,
          [&](const QColor& color) { enter_(to_linear(color), false); });
  if (dialog.exec() == QDialog::Accepted)
    enter_(to_linear(dialog.currentColor()), true);
  else
    enter_(before, true);
}

QWidget* make_label(const QString& text, NumberField* dragged, QWidget* parent) {
  return dragged ? new NumberLabel(text, dragged, parent) : new QLabel(text, parent);
}

Field make_field(const edit::Property& property, Enter enter, QWidget* parent) {
  switch (property.kind) {
    case edit::PropertyKind::number:
    case edit::PropertyKind::angle:
    case edit::PropertyKind::integer: {
      auto* field = new NumberField(property, std::move(enter), parent);
      field->set_hint(
          QObject::tr("%1 to %2%3").arg(property.low).arg(property.high).arg(unit_suffix(property)));
      return {field, [field](const edit::PropertyValue& v) {
                field->show_number(std::holds_alternative<int>(v) ? std::get<int>(v) : std::get<double>(v));
              }};
    }
    case edit::PropertyKind::color: {
      auto* field = new ColorField(property, std::move(enter), parent);
      return {field, [field](const edit::PropertyValue& v) { field->show_color(std::get<Rgb>(v)); }};
    }
    case edit::PropertyKind::toggle: {
      auto* box = new QCheckBox(parent);
      QObject::connect(box, &QCheckBox::clicked, box, [=](bool on) {
        if (!answer(box, enter(on, true))) box->setChecked(!on);
      });
      return {box, [box](const edit::PropertyValue& v) { box->setChecked(std::get<bool>(v)); }};
    }
    case edit::PropertyKind::choice: {
      auto* box = new QComboBox(parent);
      for (const std::string& choice : property.choices) box->addItem(QString::fromStdString(choice));
      const auto shown = std::make_shared<QString>();
      QObject::connect(box, &QComboBox::textActivated, box, [=](const QString& text) {
        if (!answer(box, enter(text.toStdString(), true))) box->setCurrentText(*shown);
      });
      return {box, [=](const edit::PropertyValue& v) {
                *shown = QString::fromStdString(std::get<std::string>(v));
                box->setCurrentText(*shown);
              }};
    }
    case edit::PropertyKind::text:
      break;
  }
  auto* field =
      new TextField([enter](const QString& text) { return enter(text.toStdString(), true); }, parent);
  return {field, [field](const edit::PropertyValue& v) {
            field->show_value(QString::fromStdString(std::get<std::string>(v)));
          }};
}

}  // namespace parian::editor

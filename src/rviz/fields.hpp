#pragma once
/// Small widgets that the forms of the panel share.

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QPushButton>
#include <QString>
#include <QWheelEvent>

namespace desert_sim {

/// Ignores the wheel until it is clicked, so that whoever scrolls the panel changes no number.
class NumberField : public QDoubleSpinBox {
 public:
  NumberField() { setFocusPolicy(Qt::StrongFocus); }

 protected:
  void wheelEvent(QWheelEvent* event) override {
    if (hasFocus())
      QDoubleSpinBox::wheelEvent(event);
    else
      event->ignore();
  }
};

/// A list to choose from that leaves the wheel to who scrolls the panel, and no wider than it must be.
class ChoiceField : public QComboBox {
 public:
  explicit ChoiceField(const QString& name) {
    setObjectName(name);
    setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  }

 protected:
  void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

/// A field for a number. It reports a value only when it is complete, not each digit.
inline QDoubleSpinBox* number_field(const QString& name, double low, double high, double value, int decimals,
                                    const QString& suffix, const QString& tip) {
  auto* const field = new NumberField;
  field->setObjectName(name);
  field->setKeyboardTracking(false);
  field->setDecimals(decimals);
  field->setRange(low, high);
  field->setValue(value);
  field->setSuffix(suffix);
  field->setToolTip(tip);
  field->setMinimumWidth(70);  // ranges are wide, and would make the panel wide
  field->setMaximumWidth(150);
  return field;
}

inline QPushButton* button(const QString& name, const QString& text, const QString& tip) {
  auto* const made = new QPushButton(text);
  made->setObjectName(name);
  made->setToolTip(tip);
  return made;
}

}  // namespace desert_sim

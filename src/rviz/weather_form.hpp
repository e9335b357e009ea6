#pragma once
/// The weather of a node: what ~set_weather offers. Only what is ticked is changed.

#include <QWidget>
#include <string>
#include <vector>

#include "src/rviz/node_link.hpp"

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QFormLayout;

namespace desert_sim {

class NumberTable;

class WeatherForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit WeatherForm(NodeLink& link, QWidget* parent = nullptr);

 private:
  QCheckBox* add_row(QFormLayout& form, const QString& field, const QString& label, QWidget* value);
  void apply();

  NodeLink& link_;
  std::vector<QCheckBox*> changes_;  ///< their object names are "change_" and a field of the request
  QDoubleSpinBox *rain_, *share_, *evaporation_, *ground_, *sea_level_, *wave_strength_, *wave_period_,
      *ramp_;
  QComboBox* sea_;
  NumberTable* springs_;
  ErrorLine* error_;
};

}  // namespace desert_sim

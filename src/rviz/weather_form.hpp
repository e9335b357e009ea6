#pragma once
/// The weather of a node: what ~set_weather offers. Only what is ticked is changed; the rest shows the
/// present values.

#include <desert_sim/SetWeather.h>
#include <dynamic_reconfigure/Config.h>

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

  /// The node's live parameters, of which the weather is a part.
  void show_parameters(const dynamic_reconfigure::Config& parameters);

 private:
  struct Number {
    QCheckBox* change;
    QDoubleSpinBox* value;
    double SetWeatherRequest::*field;
    const char* parameter;  ///< among the live parameters
    double unit;            ///< of the value, in that of the field
  };

  void add_numbers(QFormLayout& form);
  QCheckBox* add_row(QFormLayout& form, const QString& field, const QString& label, QWidget* value);
  void apply();

  NodeLink& link_;
  std::vector<QCheckBox*> changes_;  ///< their object names are "change_" and a field of the request
  std::vector<Number> numbers_;
  QCheckBox *change_sea_, *change_springs_;
  QComboBox* sea_;
  QDoubleSpinBox* ramp_;
  NumberTable* springs_;
  ErrorLine* error_;
};

}  // namespace desert_sim

#include "src/rviz/weather_form.hpp"

#include <desert_sim/SetWeather.h>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QVBoxLayout>

#include "src/rviz/fields.hpp"
#include "src/rviz/number_table.hpp"

namespace desert_sim {

namespace {

constexpr double mm_per_hour = 1e-3 / 3600;  // [m/s]
constexpr double percent = 0.01;

std::vector<NumberTable::Column> spring_columns() {
  return {{"x [m]", "Centre of the spring, in the frame of the terrain", -1e9, 1e9, 0, 1},
          {"y [m]", "Centre of the spring, in the frame of the terrain", -1e9, 1e9, 0, 1},
          {"radius [m]", "The disc through which the water comes", 0, 1e5, 5, 1},
          {"m³/s", "Discharge", 0, 1e5, 1, 2}};
}

}  // namespace

WeatherForm::WeatherForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  rain_ = number_field("rain_rate", 0, 3.6e6, 10, 1, " mm/h", "Depth of rain an hour, where it rains");
  share_ = number_field("rain_share", 0, 100, 100, 0, " %", "Share of the area on which it rains");
  evaporation_ =
      number_field("evaporation", 0, 10, 0.001, 5, " 1/s", "Share of standing water that evaporates");
  ground_ = number_field("ground_evaporation", 0, 100, 0.1, 3, "",
                         "How fast bare ground dries, compared with how fast it fills");
  sea_ = new QComboBox;
  sea_->setObjectName("sea");
  sea_->addItems({"none", "border", "everywhere"});
  sea_->setMaximumWidth(rain_->maximumWidth());
  sea_->setToolTip("Where the water surface is at least at the sea level");
  sea_level_ = number_field("sea_level", -1e6, 1e6, 0, 2, " m", "In the frame of the terrain");
  wave_strength_ =
      number_field("wave_strength", 0, 10, 0.05, 3, " 1/s", "Acceleration of deep water by a wind of 1 m/s");
  wave_period_ = number_field("wave_period", 0.01, 1e6, 8, 2, " s", "Period of the waves");
  springs_ = new NumberTable("springs", spring_columns());
  ramp_ = number_field("weather_ramp", 0, 1e12, 0, 1, " s",
                       "Simulated time over which numbers change; 0: at once");
  error_ = new ErrorLine("weather_error");
  auto* const send = button("apply_weather", "Set weather", "Change what is ticked, and nothing else");

  auto* const form = new QFormLayout;
  add_row(*form, "rain_rate", "rain", rain_);
  add_row(*form, "rain_share", "rain falls on", share_);
  add_row(*form, "evaporation", "evaporation", evaporation_);
  add_row(*form, "ground_evaporation", "drying of ground", ground_);
  add_row(*form, "sea", "sea", sea_);
  add_row(*form, "sea_level", "sea level", sea_level_);
  add_row(*form, "wave_strength", "wave strength", wave_strength_);
  add_row(*form, "wave_period", "wave period", wave_period_);
  form->addRow(add_row(*form, "springs", "springs (replace all)", nullptr));
  form->addRow(springs_);
  form->addRow("ramp", ramp_);
  auto* const all = new QVBoxLayout(this);
  all->addLayout(form);
  all->addWidget(send);
  all->addWidget(error_);
  all->addStretch();
  springs_->setVisible(false);
  connect(changes_.back(), &QCheckBox::toggled, springs_, &QWidget::setVisible);
  connect(send, &QPushButton::clicked, this, &WeatherForm::apply);
}

QCheckBox* WeatherForm::add_row(QFormLayout& form, const QString& field, const QString& label,
                                QWidget* value) {
  auto* const change = new QCheckBox(label);
  change->setObjectName("change_" + field);
  changes_.push_back(change);
  if (!value) return change;
  value->setEnabled(false);
  connect(change, &QCheckBox::toggled, value, &QWidget::setEnabled);
  form.addRow(change, value);
  return change;
}

void WeatherForm::apply() {
  SetWeatherRequest request;
  for (const QCheckBox* change : changes_)
    if (change->isChecked()) request.change.push_back(change->objectName().mid(7).toStdString());
  request.ramp = ramp_->value();
  request.rain_rate = rain_->value() * mm_per_hour;
  request.rain_share = share_->value() * percent;
  request.evaporation = evaporation_->value();
  request.ground_evaporation = ground_->value();
  request.sea = sea_->currentText().toStdString();
  request.sea_level = sea_level_->value();
  request.wave_strength = wave_strength_->value();
  request.wave_period = wave_period_->value();
  for (const std::vector<double>& row : springs_->rows()) {
    WaterSpring spring;
    spring.x = row[0];
    spring.y = row[1];
    spring.radius = row[2];
    spring.discharge = row[3];
    request.springs.push_back(spring);
  }
  link_.call<SetWeather>(error_, "set_weather", request);
}

}  // namespace desert_sim

#include "src/rviz/weather_form.hpp"

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
  sea_ = new QComboBox;
  sea_->setObjectName("sea");
  sea_->addItems({"none", "border", "everywhere"});
  sea_->setToolTip("Where the water surface is at least at the sea level");
  springs_ = new NumberTable("springs", spring_columns());
  ramp_ = number_field("weather_ramp", 0, 1e12, 0, 1, " s",
                       "Simulated time over which numbers change; 0: at once");
  sea_->setMaximumWidth(ramp_->maximumWidth());
  error_ = new ErrorLine("weather_error");
  auto* const send = button("apply_weather", "Set weather", "Change what is ticked, and nothing else");

  auto* const form = new QFormLayout;
  add_numbers(*form);
  change_sea_ = add_row(*form, "sea", "sea", sea_);
  change_springs_ = add_row(*form, "springs", "springs (replace all)", nullptr);
  form->addRow(change_springs_);
  form->addRow(springs_);
  form->addRow("ramp", ramp_);
  auto* const all = new QVBoxLayout(this);
  all->addLayout(form);
  all->addWidget(send);
  all->addWidget(error_);
  all->addStretch();
  springs_->setVisible(false);
  connect(change_springs_, &QCheckBox::toggled, springs_, &QWidget::setVisible);
  connect(send, &QPushButton::clicked, this, &WeatherForm::apply);
}

void WeatherForm::add_numbers(QFormLayout& form) {
  using R = SetWeatherRequest;
  const auto add = [&](const char* field, const char* label, QDoubleSpinBox* value, double R::*member,
                       const char* parameter, double unit) {
    numbers_.push_back({add_row(form, field, label, value), value, member, parameter, unit});
  };
  add("rain_rate", "rain",
      number_field("rain_rate", 0, 3.6e6, 0, 1, " mm/h", "Depth of rain an hour, where it rains"),
      &R::rain_rate, "rain__rate", mm_per_hour);
  add("rain_share", "rain falls on",
      number_field("rain_share", 0, 100, 100, 0, " %",
                   "Share of the area on which it rains, at any elevation"),
      &R::rain_share, "rain__share_high", percent);
  add("evaporation", "evaporation",
      number_field("evaporation", 0, 10, 0, 5, " 1/s", "Share of standing water that evaporates"),
      &R::evaporation, "water__evaporation", 1);
  add("ground_evaporation", "drying of ground",
      number_field("ground_evaporation", 0, 100, 0, 3, "",
                   "How fast bare ground dries, relative to how it fills"),
      &R::ground_evaporation, "moisture__evaporation", 1);
  add("sea_level", "sea level",
      number_field("sea_level", -1e6, 1e6, 0, 2, " m", "In the frame of the terrain"), &R::sea_level,
      "water__sea_level", 1);
  add("wave_strength", "wave strength",
      number_field("wave_strength", 0, 10, 0, 3, " 1/s", "Acceleration of deep water by a wind of 1 m/s"),
      &R::wave_strength, "water__wave_strength", 1);
  add("wave_period", "wave period", number_field("wave_period", 0.01, 1e6, 10, 2, " s", "From wave to wave"),
      &R::wave_period, "water__wave_period", 1);
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

void WeatherForm::show_parameters(const dynamic_reconfigure::Config& parameters) {
  for (const Number& number : numbers_)
    for (const auto& entry : parameters.doubles)
      if (entry.name == number.parameter && !number.change->isChecked())
        number.value->setValue(entry.value / number.unit);
  for (const auto& entry : parameters.strs)
    if (entry.name == "water__sea" && !change_sea_->isChecked())
      sea_->setCurrentText(QString::fromStdString(entry.value));
}

void WeatherForm::apply() {
  SetWeatherRequest request;
  for (const QCheckBox* change : changes_)
    if (change->isChecked()) request.change.push_back(change->objectName().mid(7).toStdString());
  request.ramp = ramp_->value();
  for (const Number& number : numbers_)
    if (number.change->isChecked()) request.*number.field = number.value->value() * number.unit;
  if (change_sea_->isChecked()) request.sea = sea_->currentText().toStdString();
  for (const std::vector<double>& row :
       change_springs_->isChecked() ? springs_->rows() : std::vector<std::vector<double>>()) {
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

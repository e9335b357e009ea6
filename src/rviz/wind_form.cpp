#include "src/rviz/wind_form.hpp"

#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>

#include <QCheckBox>
#include <QComboBox>
#include <QFormLayout>
#include <QGroupBox>
#include <QHBoxLayout>
#include <QMenu>
#include <QSpinBox>
#include <QVBoxLayout>
#include <cmath>

#include "src/rviz/fields.hpp"
#include "src/rviz/number_table.hpp"
#include "src/rviz/wind_dial.hpp"
#include "src/rviz/wind_features_form.hpp"
#include "src/rviz/wind_presets.hpp"
#include "src/rviz/wind_rose.hpp"

namespace desert_sim {

namespace {

enum Column { direction, speed, duration, segment_ramp, weight };

std::vector<NumberTable::Column> segment_columns() {
  return {{"to [°]", "Where the wind blows to, counter-clockwise from east", -360, 360, 0, 1},
          {"m/s", "Speed high above the ground", 0, 100, 6, 1},
          {"for [s]", "Simulated time, including the ramp", 0.001, 1e12, 60, 1},
          {"ramp [s]", "Simulated time of the change to this wind", 0, 1e12, 0, 1},
          {"weight", "How often this wind is drawn, compared with the others", 0, 1e6, 1, 2}};
}

double degrees_of(const geometry_msgs::Vector3& wind) {
  const double angle = std::atan2(wind.y, wind.x) * 180 / 3.14159265358979323846;
  return angle < 0 ? angle + 360 : angle;
}

}  // namespace

WindForm::WindForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  auto* const all = new QVBoxLayout(this);
  all->addWidget(make_constant());
  all->addWidget(make_schedule());
  all->addWidget(new WindFeaturesForm(link));
  all->addStretch();
}

QWidget* WindForm::make_constant() {
  dial_ = new WindDial;
  dial_->setObjectName("wind_dial");
  direction_ = number_field("wind_direction", 0, 360, 0, 0, " °",
                            "Where the wind is to blow to, counter-clockwise from east");
  direction_->setWrapping(true);
  speed_ = number_field("wind_speed", 0, 100, 0, 1, " m/s", "Speed high above the ground");
  ramp_ = number_field("wind_ramp", 0, 1e12, 0, 1, " s",
                       "Simulated time over which the wind changes; 0: at once");
  wind_error_ = new ErrorLine("wind_error");
  auto* const fields = new QFormLayout;
  fields->addRow("to", direction_);
  fields->addRow("speed", speed_);
  fields->addRow("ramp", ramp_);
  present_ = new QLabel;
  present_->setObjectName("present_wind");
  present_->setToolTip("The present wind high above the ground: the grey needle");
  fields->addRow("now", present_);
  auto* const row = new QHBoxLayout;
  row->addWidget(dial_, 1);
  row->addLayout(fields);
  auto* const group = new QGroupBox("Constant wind");
  auto* const rows = new QVBoxLayout(group);
  rows->addLayout(row);
  rows->addWidget(wind_error_);

  connect(dial_, &WindDial::dragged, this, [this] {
    const QSignalBlocker no_direction(direction_), no_speed(speed_);
    direction_->setValue(dial_->wanted().direction_deg);
    speed_->setValue(dial_->wanted().speed);
  });
  connect(dial_, &WindDial::released, this, &WindForm::apply_wind);
  const auto from_fields = [this] {
    dial_->set_wanted({direction_->value(), speed_->value()});
    apply_wind();
  };
  connect(direction_, qOverload<double>(&QDoubleSpinBox::valueChanged), this, from_fields);
  connect(speed_, qOverload<double>(&QDoubleSpinBox::valueChanged), this, from_fields);
  return group;
}

QWidget* WindForm::make_schedule() {
  kind_ = new QComboBox;
  kind_->setObjectName("schedule_kind");
  kind_->addItem("Timeline: one after the other", QString::fromStdString(SetWindScheduleRequest::TIMELINE));
  kind_->addItem("Rose: drawn by weight", QString::fromStdString(SetWindScheduleRequest::ROSE));
  segments_ = new NumberTable("segments", segment_columns());
  auto* const presets = button("schedule_presets", "Presets", "Fills the table with a known regime");
  auto* const menu = new QMenu(presets);
  menu->setToolTipsVisible(true);
  for (const WindPreset& preset : wind_presets())
    menu->addAction(preset.name, this, [this, preset] { take(preset); })
        ->setToolTip(QString("makes ") + preset.dunes);
  presets->setMenu(menu);
  rose_ = new WindRose;
  rose_->setObjectName("wind_rose");
  repeat_ = new QCheckBox("start again at the end");
  repeat_->setObjectName("schedule_repeat");
  repeat_->setChecked(true);
  hold_time_ =
      number_field("schedule_hold_time", 0.001, 1e12, 30, 1, " s", "Simulated time between two draws");
  seed_ = new QSpinBox;
  seed_->setObjectName("schedule_seed");
  seed_->setMaximum(1000000);
  seed_->setToolTip("Seed of the draws");
  auto* const apply = button("apply_schedule", "Set schedule", "Let the wind follow this table from now on");
  schedule_error_ = new ErrorLine("schedule_error");

  auto* const rose = new QWidget;
  auto* const rose_row = new QHBoxLayout(rose);
  rose_row->setContentsMargins(0, 0, 0, 0);
  rose_row->addWidget(new QLabel("draw every"));
  rose_row->addWidget(hold_time_);
  rose_row->addWidget(new QLabel("seed"));
  rose_row->addWidget(seed_);
  rose_row->addStretch();
  auto* const group = new QGroupBox("Wind schedule");
  auto* const rows = new QVBoxLayout(group);
  auto* const top = new QHBoxLayout;
  top->addWidget(kind_, 1);
  top->addWidget(presets);
  rows->addLayout(top);
  rows->addWidget(rose_);
  rows->addWidget(segments_);
  rows->addWidget(repeat_);
  rows->addWidget(rose);
  rows->addWidget(apply);
  rows->addWidget(schedule_error_);

  connect(apply, &QPushButton::clicked, this, &WindForm::apply_schedule);
  const auto choose = [this, rose] {
    choose_kind();
    rose->setVisible(kind_->currentIndex() != 0);
  };
  connect(kind_, qOverload<int>(&QComboBox::currentIndexChanged), this, choose);
  connect(segments_, &NumberTable::changed, this, &WindForm::draw_rose);
  segments_->set_rows({{0, 7, 60, 10, 1}, {90, 7, 60, 10, 1}});
  choose();
  return group;
}

void WindForm::choose_kind() {
  const bool timeline = kind_->currentIndex() == 0;
  segments_->show_column(duration, timeline);
  segments_->show_column(segment_ramp, timeline);
  segments_->show_column(weight, !timeline);
  repeat_->setVisible(timeline);
  draw_rose();
}

void WindForm::take(const WindPreset& preset) {
  std::vector<std::vector<double>> rows;
  for (const WindPreset::Segment& s : preset.segments)
    rows.push_back({s.direction_deg, s.speed, s.weight * preset_duration, preset_ramp, s.weight});
  segments_->set_rows(rows);
}

void WindForm::draw_rose() {
  const int share = kind_->currentIndex() == 0 ? duration : weight;
  std::vector<WindRose::Petal> winds;
  for (const std::vector<double>& row : segments_->rows())
    winds.push_back({row[direction], row[speed], row[static_cast<std::size_t>(share)]});
  rose_->set_winds(winds);
}

void WindForm::apply_wind() {
  SetWindRequest request;
  request.direction_deg = direction_->value();
  request.speed = speed_->value();
  request.ramp = ramp_->value();
  asked_ = Asked{request.ramp, false, std::nullopt};
  link_.call<SetWind>(wind_error_, "set_wind", request, [this, n = ++requests_](const SetWindResponse&) {
    if (asked_ && n == requests_) asked_->taken = true;
  });
}

void WindForm::apply_schedule() {
  SetWindScheduleRequest request;
  request.kind = kind_->currentData().toString().toStdString();
  const bool rose = request.kind == SetWindScheduleRequest::ROSE;
  if (rose) {
    request.hold_time = hold_time_->value();
    request.seed = static_cast<std::uint64_t>(seed_->value());
  } else {
    request.repeat = repeat_->isChecked();
  }
  for (const std::vector<double>& row : segments_->rows()) {
    WindScheduleSegment segment;
    segment.direction_deg = row[direction];
    segment.speed = row[speed];
    if (rose) {
      segment.probability = row[weight];
    } else {
      segment.duration = row[duration];
      segment.ramp = row[segment_ramp];
    }
    request.segments.push_back(segment);
  }
  link_.call<SetWindSchedule>(schedule_error_, "set_wind_schedule", request);
}

void WindForm::show_status(const SimulationStatus& status) {
  const DialWind present{degrees_of(status.wind_above), std::hypot(status.wind_above.x, status.wind_above.y)};
  dial_->set_present(present);
  present_->setText(
      QStringLiteral("%1 m/s to %2 °").arg(present.speed, 0, 'f', 1).arg(present.direction_deg, 0, 'f', 0));
  if (dial_->dragging() || shows_asked(status)) return;
  const QSignalBlocker no_direction(direction_), no_speed(speed_);
  if (!direction_->hasFocus()) direction_->setValue(present.direction_deg);  // else somebody types
  if (!speed_->hasFocus()) speed_->setValue(present.speed);
  dial_->set_wanted(present);
}

bool WindForm::shows_asked(const SimulationStatus& status) {
  if (!asked_) return false;
  if (wind_error_->refused()) asked_.reset();
  if (!asked_ || !asked_->taken) return asked_.has_value();
  // This status may have been on its way before the node took the wind; the next ones were not.
  const bool first = !asked_->since;
  if (first) asked_->since = status.sim_time;
  const double passed = status.sim_time - *asked_->since;
  if (!first && !(passed >= 0 && passed < asked_->ramp))
    asked_.reset();  // it is there, or the desert was reset
  return asked_.has_value();
}

void WindForm::forget() {
  asked_.reset();
  ++requests_;
}

}  // namespace desert_sim

#include "src/rviz/drive_form.hpp"

#include <ros/names.h>

#include <QComboBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <algorithm>

#include "src/rviz/drive_pad.hpp"
#include "src/rviz/fields.hpp"

namespace desert_sim {

DriveForm::DriveForm(NodeLink& link, QWidget* parent) : QWidget(parent), link_(link) {
  rover_ = new QComboBox;
  rover_->setObjectName("rover");
  rover_->setToolTip("The rover to drive: those of the node's namespace");
  speed_ = number_field("drive_speed", 0.01, 10, 0.2, 2, " m/s",
                        "Speed at the rim of the pad, and by the arrow keys");
  turn_ = number_field("drive_turn", 0.01, 10, 0.4, 2, " rad/s",
                       "Turning at the rim of the pad, and by the arrow keys");
  note_ = new ErrorLine("drive_note");
  pad_ = new DrivePad;
  pad_->setObjectName("drive_pad");
  auto* const fields = new QFormLayout;
  fields->addRow("rover", rover_);
  fields->addRow("speed", speed_);
  fields->addRow("turn", turn_);
  auto* const row = new QHBoxLayout;
  row->addWidget(pad_, 1);
  row->addLayout(fields);
  auto* const rows = new QVBoxLayout(this);
  rows->addLayout(row);
  rows->addWidget(note_);
  rows->addStretch();
  connect(pad_, &DrivePad::driven, this, &DriveForm::drive);
  connect(rover_, qOverload<int>(&QComboBox::currentIndexChanged), this, [this] { choose(); });
  show_rovers({});
}

DriveForm::~DriveForm() { delete pad_; }  // it stops the rover, by this form

void DriveForm::show_rovers(const RoverNames& rovers) {
  const QString chosen = rover_->currentText();
  {
    const QSignalBlocker silent(rover_);
    rover_->clear();
    for (const std::string& name : rovers) rover_->addItem(QString::fromStdString(name));
    rover_->setCurrentIndex(std::max(rovers.empty() ? -1 : 0, rover_->findText(chosen)));
  }
  if (rover_->currentText() != chosen || rovers.empty()) choose();
}

void DriveForm::show_planners(const PlannerStatuses& planners) {
  planners_ = planners;
  show_note();
}

void DriveForm::choose() {
  pad_->setEnabled(false);  // it stops the rover that it drives
  link_.watch().choose_rover(rover_->currentText().toStdString());
  pad_->setEnabled(rover_->currentIndex() >= 0);
  show_note();
}

void DriveForm::show_note() {
  if (rover_->currentIndex() < 0)
    return note_->show_note(
        "There is no rover: roslaunch desert_sim rover.launch starts one beside a desert.");
  for (const auto& [name, status] : planners_)
    if (ros::names::parentNamespace(name) == rover_->currentText().toStdString() &&
        (status->state == PlannerStatus::DRIVING || status->state == PlannerStatus::RECOVERING))
      return note_->show_note("Its planner drives it, too: cancel its goal first (" + name + "/cancel).");
  note_->show_nothing();
}

void DriveForm::drive(double forward, double left) {
  geometry_msgs::Twist command;
  command.linear.x = forward * speed_->value();
  command.angular.z = left * turn_->value();
  link_.watch().drive(command);
}

}  // namespace desert_sim

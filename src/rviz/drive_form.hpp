#pragma once
/// Driving a rover by hand: which one, how fast, and a pad.

#include <QWidget>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QDoubleSpinBox;

namespace desert_sim {

class DrivePad;

class DriveForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit DriveForm(NodeLink& link, QWidget* parent = nullptr);
  ~DriveForm() override;

  void show_rovers(const RoverNames& rovers);
  /// Who else drives the rover.
  void show_planners(const PlannerStatuses& planners);

 private:
  void choose();
  void drive(double forward, double left);
  void show_note();

  NodeLink& link_;
  QComboBox* rover_;
  QDoubleSpinBox *speed_, *turn_;
  DrivePad* pad_;
  ErrorLine* note_;
  PlannerStatuses planners_;
};

}  // namespace desert_sim

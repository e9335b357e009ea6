#pragma once
/// Running, stepping, the pace in numbers and words, and undo of a node.

#include <desert_sim/SimulationStatus.h>

#include <QWidget>

#include "src/rviz/node_link.hpp"

class QDoubleSpinBox;
class QLabel;
class QPushButton;
class QSpinBox;

namespace desert_sim {

class RunControls : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit RunControls(NodeLink& link, QWidget* parent = nullptr);

  void show_status(const SimulationStatus& status);
  int steps() const;
  void set_steps(int steps);

 private:
  QWidget* make_run_row();
  QWidget* make_rate_row();
  QWidget* make_undo_row();
  void turn(const char* service);  ///< undo or redo

  NodeLink& link_;
  QPushButton *run_, *pause_, *step_, *reset_, *undo_, *redo_;
  QSpinBox* steps_;
  QLabel* pace_;
  QDoubleSpinBox *rate_, *acceleration_;
  ErrorLine *error_, *step_error_, *undo_error_;
};

}  // namespace desert_sim

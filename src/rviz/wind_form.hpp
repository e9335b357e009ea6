#pragma once
/// The wind of a node: a dial for a constant wind, and a table for a timeline or a wind rose.

#include <desert_sim/SimulationStatus.h>

#include <QWidget>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QCheckBox;
class QDoubleSpinBox;
class QSpinBox;

namespace desert_sim {

class NumberTable;
class WindDial;

class WindForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit WindForm(NodeLink& link, QWidget* parent = nullptr);

  void show_status(const SimulationStatus& status);
  /// Another node: its first status decides where the dial begins.
  void forget();

 private:
  QWidget* make_constant();
  QWidget* make_schedule();
  void apply_wind();
  void apply_schedule();
  void choose_kind();

  NodeLink& link_;
  WindDial* dial_;
  QLabel* present_;
  QDoubleSpinBox *direction_, *speed_, *ramp_;
  ErrorLine *wind_error_, *schedule_error_;
  QComboBox* kind_;
  NumberTable* segments_;
  QCheckBox* repeat_;
  QDoubleSpinBox* hold_time_;
  QSpinBox* seed_;
  bool seen_ = false;  ///< the dial shows a wind of this node
};

}  // namespace desert_sim

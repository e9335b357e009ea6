#pragma once
/// The wind of a node: a dial for a constant wind, and a table for a timeline or a wind rose.

#include <desert_sim/SimulationStatus.h>

#include <QWidget>
#include <optional>

#include "src/rviz/node_link.hpp"

class QComboBox;
class QCheckBox;
class QDoubleSpinBox;
class QSpinBox;

namespace desert_sim {

class NumberTable;
class WindDial;
class WindRose;
struct WindPreset;

class WindForm : public QWidget {
  Q_OBJECT

 public:
  /// `link` must live longer.
  explicit WindForm(NodeLink& link, QWidget* parent = nullptr);

  void show_status(const SimulationStatus& status);
  /// Another node, whose wind the dial shows.
  void forget();

 private:
  QWidget* make_constant();
  QWidget* make_schedule();
  void apply_wind();
  void apply_schedule();
  void choose_kind();
  /// Fills the table.
  void take(const WindPreset& preset);
  void draw_rose();

  NodeLink& link_;
  WindDial* dial_;
  QLabel* present_;
  QDoubleSpinBox *direction_, *speed_, *ramp_;
  ErrorLine *wind_error_, *schedule_error_;
  QComboBox* kind_;
  WindRose* rose_;
  NumberTable* segments_;
  QCheckBox* repeat_;
  QDoubleSpinBox* hold_time_;
  QSpinBox* seed_;

  /// The last wind that was asked for here: until it is there, the needle shows it, and not the present one.
  struct Asked {
    double ramp = 0;              ///< [s] of simulated time
    bool taken = false;           ///< by the node
    std::optional<double> since;  ///< simulated time of the first status after that [s]
  };
  bool shows_asked(const SimulationStatus& status);

  std::optional<Asked> asked_;
  unsigned requests_ = 0;
};

}  // namespace desert_sim

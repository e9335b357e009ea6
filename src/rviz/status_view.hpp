#pragma once
/// What the node does, in a few lines, and what to try next.

#include <desert_sim/SimulationStatus.h>

#include <QElapsedTimer>
#include <QWidget>
#include <string>

#include "src/rviz/node_watch.hpp"

class QLabel;

namespace desert_sim {

/// What to do about the state that a node is in; `status` is the last one of it, null without one.
std::string hint(NodeWatch::Presence presence, const SimulationStatus* status, const std::string& node);

/// The residual that is farthest from 0.
double worst_residual(const SimulationStatus& status);

/// Simulated time such as "2 h 05 min".
std::string duration_text(double seconds);

/// How a planner gets on, and its forecast: "driving, 12.3 m to go, no forecast yet (24 %)".
std::string planner_text(const PlannerStatus& status);

class StatusView : public QWidget {
  Q_OBJECT

 public:
  explicit StatusView(QWidget* parent = nullptr);

  void show_presence(NodeWatch::Presence presence, const std::string& node);
  void show_status(const SimulationStatusConstPtr& status);
  void show_planners(const PlannerStatuses& planners);
  void forget();

 private:
  void refresh();

  QLabel *state_, *progress_, *rate_, *balance_, *planners_line_, *hint_;
  NodeWatch::Presence presence_ = NodeWatch::Presence::searching;
  std::string node_;
  SimulationStatusConstPtr status_;
  QElapsedTimer age_;  ///< of the status
};

}  // namespace desert_sim

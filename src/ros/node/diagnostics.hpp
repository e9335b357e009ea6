#pragma once
/// What the node says on /diagnostics. Each part is OK unless:
///
///   simulation    WARN: over 1 s behind; waits for /clock; no answer for 2 s. ERROR: has failed
///   mass balance  ERROR: some quanta are not accounted for
///   memory        WARN: too little left for a reset or a load
///   topics        WARN: one had under half its rate for 3 periods, or cannot be published (no transform,
///   say).
///                 ERROR: publishing has failed
///   autosave      WARN: two periods without one. ERROR: the last one could not be written

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <map>
#include <optional>
#include <string>

#include "src/ros/node/autosave.hpp"
#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

class Diagnostics {
 public:
  /// Every `period` seconds of wall time, on `node`'s callback queue; without subscribers nothing is done.
  /// `autosave` may be null.
  Diagnostics(ros::NodeHandle node, double period, SimulationThread& simulation, const Topics& topics,
              const Autosave* autosave);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void update();
  void simulation(Status& status) const;
  void mass(Status& status) const;
  void memory(Status& status) const;
  void rates(Status& status);
  void saving(Status& status) const;

  SimulationThread& simulation_;
  const Topics& topics_;
  const Autosave* autosave_;
  diagnostic_updater::Updater updater_;
  ros::Publisher listeners_;            ///< a second publisher of the topic, to ask for its subscribers
  std::optional<StatusReport> report_;  ///< none if there was no answer in time
  std::map<std::string, int> slow_;     ///< periods in a row with too few messages, of each topic
  ros::WallTimer timer_;
};

}  // namespace desert_sim

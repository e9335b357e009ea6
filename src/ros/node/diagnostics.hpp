#pragma once
/// What the node says on /diagnostics. Each part is OK unless:
///
///   simulation    WARN: it is over 1 s behind, waits for /clock, or has not answered for 2 s, or a process
///                 warns (Process::warning).
///                 ERROR: it has failed
///   mass balance  ERROR: some quanta are not accounted for
///   memory        WARN: too little is left for a reset or a load
///   topics        WARN: one had less than half its rate for 3 periods, or cannot be published, for want of a
///                 transform, say. ERROR: publishing has failed
///   forecast      WARN: its topics have less than half their rate. ERROR: the last one failed
///   autosave      WARN: there was none for two periods. ERROR: the last one could not be written
///   master        WARN: the ROS master does not answer. ERROR: it does not know the node, because it was
/// started
///                 anew: nobody finds the node's topics and services until the node is started anew, too.
/// roscpp
///                 registers only once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>
#include <ros/wall_timer.h>

#include <chrono>
#include <map>
#include <optional>
#include <string>

#include "src/ros/forecast/forecast_server.hpp"
#include "src/ros/simulation/autosave.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

class Diagnostics {
 public:
  /// Publishes every `period` seconds of wall time, on the callback queue of `node`; without subscribers it
  /// only asks the master, for the log. `autosave` may be null.
  Diagnostics(ros::NodeHandle node, double period, SimulationThread& simulation,
              const TopicPublisher& publisher, const ForecastServer& forecast, const Autosave* autosave);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void update();
  void check_simulation(Status& status) const;
  void check_mass(Status& status) const;
  void check_memory(Status& status) const;
  void check_topics(Status& status);
  void check_forecast(Status& status) const;
  void check_autosave(Status& status) const;
  void check_master(Status& status) const;
  void ask_master();

  SimulationThread& simulation_;
  const TopicPublisher& publisher_;
  const ForecastServer& forecast_;
  const Autosave* autosave_;
  diagnostic_updater::Updater updater_;
  ros::Publisher diagnostics_;          ///< a second publisher of /diagnostics, to ask for its subscribers
  std::optional<StatusReport> report_;  ///< none if there was no answer in time
  std::map<std::string, int> slow_;     ///< by topic, the number of periods in a row with too few messages
  enum class Master { knows_node, does_not_answer, does_not_know_node };
  Master master_ = Master::knows_node;
  std::chrono::steady_clock::time_point asked_master_;
  ros::WallTimer timer_;
};

}  // namespace desert_sim

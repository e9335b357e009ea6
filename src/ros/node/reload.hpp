#pragma once
/// ~reload_parameters: reads the node's parameters and its scenario again.

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include "src/ros/node/node_parameters.hpp"
#include "src/ros/node/simulation_thread.hpp"
#include "src/ros/topics/topics.hpp"

namespace desert_sim {

/// What differs from the last reading and can change live is applied, as one command; the answer's message
/// lists it, and what else differs and needs a restart. Input that is refused changes nothing.
class Reload {
 public:
  /// `setup` is what the node was started with, its grid resolved.
  Reload(ros::NodeHandle node, NodeSetup setup, SimulationThread& simulation, Topics& topics,
         std::function<void(const Scenario&)> on_scenario);

 private:
  bool serve(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  std::string reload();

  ros::NodeHandle node_;
  std::mutex mutex_;  ///< one at a time
  NodeSetup last_;    ///< under mutex_
  SimulationThread& simulation_;
  Topics& topics_;
  const std::function<void(const Scenario&)> on_scenario_;
  ros::ServiceServer service_;
};

}  // namespace desert_sim

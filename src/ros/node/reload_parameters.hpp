#pragma once
/// The service ~reload_parameters: reads the node's parameters and its scenario again.

#include <ros/node_handle.h>
#include <std_srvs/Trigger.h>

#include "src/ros/parameters/node_parameters.hpp"
#include "src/ros/simulation/simulation_thread.hpp"
#include "src/ros/topics/topic_publisher.hpp"

namespace desert_sim {

/// What differs from the last reading and can change live is applied, as one command. The message of the
/// answer lists that, and what differs too but needs a restart. Input that is refused changes nothing.
class ParameterReload {
 public:
  /// `setup` is what the node was started with, its grid resolved. `on_scenario` is called with each scenario
  /// that was read.
  ParameterReload(ros::NodeHandle node, NodeSetup setup, SimulationThread& simulation,
                  TopicPublisher& publisher, std::function<void(const Scenario&)> on_scenario);

 private:
  bool serve(std_srvs::TriggerRequest& request, std_srvs::TriggerResponse& response);
  std::string reload();

  ros::NodeHandle node_;
  std::mutex mutex_;  ///< held while parameters are reloaded; guards last_
  NodeSetup last_;    ///< what was read last
  SimulationThread& simulation_;
  TopicPublisher& publisher_;
  const std::function<void(const Scenario&)> on_scenario_;
  ros::ServiceServer service_;
};

}  // namespace desert_sim

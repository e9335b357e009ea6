#pragma once
/// ~cmd_wind: the topic on which others set the high-altitude wind, message by message.

#include <geometry_msgs/Vector3Stamped.h>
#include <ros/node_handle.h>

#include "src/ros/conversion/frames.hpp"
#include "src/ros/simulation/simulation_thread.hpp"

namespace desert_sim {

/// Each message acts like ~set_wind with a vector and without a ramp: a constant wind from the next step on.
/// The vector [m/s, where the air moves to] is turned from its header's frame into the terrain's, in which it
/// must be horizontal. A message that is refused changes nothing; a warning, at most every few seconds, says
/// why.
class CmdWindSubscriber {
 public:
  CmdWindSubscriber(ros::NodeHandle node, SimulationThread& simulation, const Frames& frames);

 private:
  void receive(const geometry_msgs::Vector3Stamped& message);

  SimulationThread& simulation_;
  const Frames& frames_;
  ros::Subscriber subscriber_;
};

}  // namespace desert_sim

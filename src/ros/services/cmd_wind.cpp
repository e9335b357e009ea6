#include "src/ros/services/cmd_wind.hpp"

#include <ros/console.h>

#include "src/ros/services/requests.hpp"

namespace desert_sim {

CmdWindSubscriber::CmdWindSubscriber(ros::NodeHandle node, SimulationThread& simulation, const Frames& frames)
    : simulation_(simulation), frames_(frames) {
  const boost::function<void(const geometry_msgs::Vector3StampedConstPtr&)> callback =
      [this](const geometry_msgs::Vector3StampedConstPtr& message) { receive(*message); };
  // A queue of one: a message that waits is replaced by the next.
  subscriber_ = node.subscribe<geometry_msgs::Vector3Stamped>("cmd_wind", 1, callback);
}

void CmdWindSubscriber::receive(const geometry_msgs::Vector3Stamped& message) {
  try {
    simulation_.apply(cmd_wind_command(message, frames_)).get();
  } catch (const ConfigError& e) {
    ROS_WARN_THROTTLE(2, "cmd_wind: %s", e.what());
  } catch (const Error& e) {  // the simulation is ending, or has failed and said so
    ROS_DEBUG("cmd_wind: %s", e.what());
  }
}

}  // namespace desert_sim

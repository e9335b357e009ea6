#include "src/ros/topics/wind_stream.hpp"

#include <ros/console.h>

#include "src/ros/services/requests.hpp"

namespace desert_sim {

namespace {

constexpr double warn_every = 2;  // [s]

}  // namespace

WindStream::WindStream(ros::NodeHandle node, SimulationThread& simulation, const Frames& frames)
    : simulation_(simulation), frames_(frames) {
  const boost::function<void(const geometry_msgs::Vector3StampedConstPtr&)> callback =
      [this](const geometry_msgs::Vector3StampedConstPtr& message) { receive(*message); };
  // A wind that was not taken in time is replaced by the next.
  subscriber_ = node.subscribe<geometry_msgs::Vector3Stamped>("cmd_wind", 1, callback);
}

void WindStream::receive(const geometry_msgs::Vector3Stamped& message) {
  try {
    simulation_.apply(streamed_wind(message, frames_)).get();
  } catch (const ConfigError& e) {
    ROS_WARN_THROTTLE(warn_every, "cmd_wind: %s", e.what());
  } catch (const Error& e) {  // the simulation is ending, or has failed and said so
    ROS_DEBUG("cmd_wind: %s", e.what());
  }
}

}  // namespace desert_sim

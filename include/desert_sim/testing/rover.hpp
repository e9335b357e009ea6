#pragma once
/// A rover of desert_rover_node that a test commands and watches.

#include <desert_sim/RoverStatus.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>

#include <functional>
#include <string>

#include "desert_sim/testing/inbox.hpp"
#include "desert_sim/testing/paths.hpp"

namespace desert_sim::test {

class Rover {
 public:
  /// `name`: namespace of the rover's topics.
  Rover(ros::NodeHandle& node, const std::string& name);

  /// Publishes one command on cmd_vel, and returns when the rover has it: ahead [m/s], and counter-clockwise
  /// [rad/s]. It holds for half a second of the rover's time. Throws std::runtime_error if the rover has none
  /// within a minute.
  void drive(double forward, double yaw_rate = 0);
  /// The last true pose. Throws std::runtime_error if there is none within a minute.
  Pose pose() const;
  /// In the plane [m].
  double distance_to(const Point& p) const;
  /// The last one. Throws std::runtime_error if there is none within a minute.
  RoverStatus status() const;
  /// Waits for a pose of this ROS time or a later one; whether it came. In lockstep poses have the stamps of
  /// the terrain's states.
  bool wait_for_stamp(const ros::Time& stamp, double seconds) const;

  /// Waits until the last status fits; whether it does. In lockstep one comes for each state of the terrain
  /// (terrain_stamp) and each message on cmd_vel (commands).
  bool wait_for_status(const std::function<bool(const RoverStatus&)>& fits, double seconds) const;

  /// Name of its node.
  const std::string& node() const { return node_; }

 private:
  std::string name_, node_;
  ros::Publisher publisher_;
  Inbox<nav_msgs::Odometry> ground_truth_;
  Inbox<RoverStatus> status_;
};

}  // namespace desert_sim::test

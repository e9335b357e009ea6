#pragma once
/// The topics of a rover and its transforms.

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/transform_broadcaster.h>

#include <chrono>
#include <string>

#include "src/ros/rover/rover_messages.hpp"
#include "src/ros/support/latched_publisher.hpp"

namespace desert_sim {

class RoverPublisher {
 public:
  /// odom, ground_truth, joint_states, imu below `node`; ~status below `private_node`.
  RoverPublisher(ros::NodeHandle node, ros::NodeHandle private_node, const RoverSetup& setup);

  /// `terrain_frame` is empty before there is a terrain.
  void publish_pose(const Rover& rover, const ros::Time& stamp, const std::string& terrain_frame);
  /// If the state has changed since the last one, or that was a while ago; in lockstep for each state of the
  /// terrain and each command. The message lacks what RoverPublisher does not know: `status` has it.
  void publish_status(const RoverStatus& status);

 private:
  const RoverSetup setup_;
  LatchedPublisher<nav_msgs::Odometry> odom_, ground_truth_;
  LatchedPublisher<sensor_msgs::JointState> joint_states_;
  LatchedPublisher<sensor_msgs::Imu> imu_;
  ros::Publisher status_;  ///< goes on while the rover stands: need not be published again
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::Time last_stamp_, last_terrain_stamp_;
  std::uint64_t last_commands_ = 0;
  std::string last_state_, last_refusal_;
  std::chrono::steady_clock::time_point last_status_;
};

}  // namespace desert_sim

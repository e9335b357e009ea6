#include "src/ros/rover/rover_publisher.hpp"

namespace desert_sim {

namespace {

/// Poses come with steps then, and who subscribes between two steps is to have the last one.
bool is_lockstep(const RoverSetup& setup) { return setup.node.clock == RoverClock::lockstep; }

}  // namespace

RoverPublisher::RoverPublisher(ros::NodeHandle node, ros::NodeHandle private_node, const RoverSetup& setup)
    : setup_(setup),
      odom_(node, "odom", 10, is_lockstep(setup)),
      ground_truth_(node, "ground_truth", 10, is_lockstep(setup)),
      joint_states_(node, "joint_states", 10, is_lockstep(setup)),
      imu_(node, "imu", 10, is_lockstep(setup)),
      status_(private_node.advertise<RoverStatus>("status", 100, true)) {}

void RoverPublisher::publish_pose(const Rover& rover, const ros::Time& stamp,
                                  const std::string& terrain_frame) {
  if (!rover.state().placed || stamp == last_stamp_) return;  // tf refuses a stamp that it has
  last_stamp_ = stamp;
  odom_.publish(odometry_message(rover, setup_, stamp));
  ground_truth_.publish(ground_truth_message(rover, setup_, stamp, terrain_frame));
  joint_states_.publish(joint_message(rover, stamp));
  imu_.publish(imu_message(rover, setup_, stamp));
  if (setup_.node.publish_tf)
    broadcaster_.sendTransform(
        transforms(rover, setup_, stamp, setup_.node.publish_map_tf ? terrain_frame : std::string()));
}

void RoverPublisher::publish_status(const RoverStatus& status) {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> age = now - last_status_;
  const bool news_in_lockstep = is_lockstep(setup_) && (status.terrain_stamp != last_terrain_stamp_ ||
                                                        status.commands != last_commands_);
  if (!news_in_lockstep && status.state == last_state_ && status.refusal == last_refusal_ &&
      age.count() < 1 / setup_.node.status_rate)
    return;
  last_terrain_stamp_ = status.terrain_stamp;
  last_commands_ = status.commands;
  last_state_ = status.state;
  last_refusal_ = status.refusal;
  last_status_ = now;
  status_.publish(status);
}

}  // namespace desert_sim

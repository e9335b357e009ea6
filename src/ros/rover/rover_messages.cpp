#include "src/ros/rover/rover_messages.hpp"

#include <algorithm>

#include "src/core/hash_text.hpp"
#include "src/core/rotation.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/rover/urdf.hpp"

namespace desert_sim {

namespace {

geometry_msgs::Quaternion quaternion(double roll, double pitch, double yaw) {
  const Eigen::Quaterniond q = turn_of_halves(
      elementary::direction(roll / 2), elementary::direction(pitch / 2), elementary::direction(yaw / 2));
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child,
                                          const ros::Time& stamp, const Pose& pose) {
  geometry_msgs::TransformStamped t;
  t.header.stamp = stamp;
  t.header.frame_id = parent;
  t.child_frame_id = child;
  t.transform.translation.x = pose.x;
  t.transform.translation.y = pose.y;
  t.transform.translation.z = pose.z;
  t.transform.rotation = quaternion(pose.roll, pose.pitch, pose.yaw);
  return t;
}

/// Where base_footprint is in odom.
Pose footprint(const RoverState& state) {
  const Pose& o = state.odometry;
  return {o.x, o.y, o.z, 0, 0, o.yaw};
}

/// The pose of odom in the terrain's frame at which base_link is where it is.
Pose odom_in_terrain(const RoverState& state, double wheel_radius) {
  const Pose &o = state.odometry, &p = state.pose;
  const double yaw = p.yaw - o.yaw;
  const auto [c, s] = elementary::direction(yaw);
  return {p.x - (c * o.x - s * o.y), p.y - (s * o.x + c * o.y), p.z - wheel_radius - o.z, 0, 0, yaw};
}

template <class Covariance>
void set_diagonal(Covariance& covariance, std::size_t first, std::size_t end, std::size_t size,
                  double value) {
  for (std::size_t n = first; n < end; ++n) covariance[n * size + n] = value;
}

}  // namespace

geometry_msgs::Pose pose_message(const Pose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.x;
  message.position.y = pose.y;
  message.position.z = pose.z;
  message.orientation = quaternion(pose.roll, pose.pitch, pose.yaw);
  return message;
}

nav_msgs::Odometry odometry_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp) {
  const RoverState& s = rover.state();
  nav_msgs::Odometry m;
  m.header.stamp = stamp;
  m.header.frame_id = setup.frame("odom");
  m.child_frame_id = setup.frame("base_footprint");
  m.pose.pose = pose_message(footprint(s));
  m.twist.twist.linear.x = s.rims.forward;
  m.twist.twist.linear.y = s.rims.sideways;
  m.twist.twist.angular.z = s.rims.yaw_rate;
  // Slip is a share of the way, mostly below a tenth, and odometry knows nothing of it.
  const double way = 0.1 * s.way_commanded;
  set_diagonal(m.pose.covariance, 0, 6, 6, way * way + 1e-6);
  set_diagonal(m.twist.covariance, 0, 6, 6, 1e-4);
  return m;
}

nav_msgs::Odometry ground_truth_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp,
                                        const std::string& terrain_frame) {
  const RoverState& s = rover.state();
  nav_msgs::Odometry m;
  m.header.stamp = stamp;
  m.header.frame_id = terrain_frame;
  m.child_frame_id = setup.frame("base_link");
  m.pose.pose = pose_message(s.pose);
  const Eigen::Vector3d v =
      turned(rotation_of(s.pose).transpose(), {s.velocity[0], s.velocity[1], s.velocity[2]});
  m.twist.twist.linear.x = v.x();
  m.twist.twist.linear.y = v.y();
  m.twist.twist.linear.z = v.z();
  m.twist.twist.angular.x = s.angular_velocity[0];
  m.twist.twist.angular.y = s.angular_velocity[1];
  m.twist.twist.angular.z = s.angular_velocity[2];
  return m;
}

sensor_msgs::Imu imu_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp) {
  const RoverParameters& p = rover.parameters();
  const ImuReading reading = rover.imu();
  sensor_msgs::Imu m;
  m.header.stamp = stamp;
  m.header.frame_id = setup.frame("base_link");
  m.orientation = quaternion(rover.state().pose.roll, rover.state().pose.pitch, rover.state().pose.yaw);
  m.angular_velocity.x = reading.angular_velocity[0];
  m.angular_velocity.y = reading.angular_velocity[1];
  m.angular_velocity.z = reading.angular_velocity[2];
  m.linear_acceleration.x = reading.acceleration[0];
  m.linear_acceleration.y = reading.acceleration[1];
  m.linear_acceleration.z = reading.acceleration[2];
  constexpr double least = 1e-9;  // 0 would mean that it is unknown
  set_diagonal(m.orientation_covariance, 0, 3, 3, least);
  set_diagonal(m.angular_velocity_covariance, 0, 3, 3, std::max(p.gyro_noise * p.gyro_noise, least));
  set_diagonal(m.linear_acceleration_covariance, 0, 3, 3,
               std::max(p.accelerometer_noise * p.accelerometer_noise, least));
  return m;
}

sensor_msgs::JointState joint_message(const Rover& rover, const ros::Time& stamp) {
  sensor_msgs::JointState m;
  m.header.stamp = stamp;
  for (const JointValue& joint : joint_values(rover.parameters(), rover.state())) {
    m.name.push_back(joint.name);
    m.position.push_back(joint.position);
    m.velocity.push_back(joint.velocity);
  }
  return m;
}

std::vector<geometry_msgs::TransformStamped> transforms(const Rover& rover, const RoverSetup& setup,
                                                        const ros::Time& stamp,
                                                        const std::string& terrain_frame) {
  const RoverState& s = rover.state();
  const double radius = rover.parameters().wheel_radius;
  std::vector<geometry_msgs::TransformStamped> all;
  if (!terrain_frame.empty())
    all.push_back(transform(terrain_frame, setup.frame("odom"), stamp, odom_in_terrain(s, radius)));
  all.push_back(transform(setup.frame("odom"), setup.frame("base_footprint"), stamp, footprint(s)));
  all.push_back(transform(setup.frame("base_footprint"), setup.frame("base_link"), stamp,
                          {0, 0, radius, s.pose.roll, s.pose.pitch, 0}));
  return all;
}

RoverStatus status_message(const Rover& rover) {
  const RoverState& s = rover.state();
  RoverStatus m;
  m.state = rover_conditions[static_cast<int>(s.condition)];
  m.reason = s.reason;
  m.command.linear.x = s.command.forward;
  m.command.linear.y = s.command.sideways;
  m.command.angular.z = s.command.yaw_rate;
  for (int n = 0; n < rover.suspension().wheels(); ++n) {
    const WheelState& w = s.wheels[static_cast<std::size_t>(n)];
    m.wheels.push_back(wheel_name(n, rover.suspension().wheels()));
    m.slip.push_back(w.slip);
    m.sinkage.push_back(w.sunk);
  }
  m.mean_slip = s.slip;
  m.way_commanded = s.way_commanded;
  m.way_made = s.way_made;
  m.contact_error = s.contact_error;
  m.terrain_step = s.terrain_step;
  m.terrain_time = s.terrain_time;
  m.state_hash = hash_text(hash_of(s));
  return m;
}

}  // namespace desert_sim

#pragma once
/// Messages and transforms of a rover's state.

#include <desert_sim/RoverStatus.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>

#include <vector>

#include "src/ros/rover/rover_node_parameters.hpp"
#include "src/rover/rover.hpp"

namespace desert_sim {

geometry_msgs::Pose pose_message(const Pose& pose);
/// base_footprint in odom, by the wheels; the twist is that of the rims.
nav_msgs::Odometry odometry_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp);
/// base_link in the terrain's frame, as it is; the twist in the frame of base_link.
nav_msgs::Odometry ground_truth_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp,
                                        const std::string& terrain_frame);
sensor_msgs::Imu imu_message(const Rover& rover, const RoverSetup& setup, const ros::Time& stamp);
sensor_msgs::JointState joint_message(const Rover& rover, const ros::Time& stamp);
/// odom → base_footprint → base_link, and before them terrain → odom if `terrain_frame` is not empty.
std::vector<geometry_msgs::TransformStamped> transforms(const Rover& rover, const RoverSetup& setup,
                                                        const ros::Time& stamp,
                                                        const std::string& terrain_frame);
/// What follows from the rover's state; the rest is left empty.
RoverStatus status_message(const Rover& rover);

}  // namespace desert_sim

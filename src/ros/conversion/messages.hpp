#pragma once
/// Parts that many messages have in common. What is special to a topic stands in the file of that topic.

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <string>

#include "src/ros/simulation/terrain_state.hpp"

namespace desert_sim {

std_msgs::Header header_of(const Moment& moment, const std::string& frame);
/// The lower left corner of cell (0, 0) of a grid.
geometry_msgs::Pose origin_of(const Snapshot& snapshot);
geometry_msgs::Vector3 vector_of(wind::Vector v);

}  // namespace desert_sim

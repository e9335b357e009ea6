#pragma once
/// Names of what is around a rover. A rover, its planner and their topics share a namespace, /rover; the
/// desert, rviz and its goals are in the one around it: / here, /mars if all of it was started in the
/// namespace /mars.

#include <ros/node_handle.h>

#include <string>

#include "src/core/error.hpp"
#include "src/core/validation_errors.hpp"

namespace desert_sim {

/// Adds an error if `name` is no name of a node or topic.
void check_name(const std::string& name, const std::string& key, ValidationErrors& errors);

/// The full name of `name` seen from the namespace around that of the node whose private handle it is:
/// /mars/desert_sim for desert_sim and the node /mars/rover/desert_rover. One that begins with a slash is
/// full.
std::string outer_name(const ros::NodeHandle& private_node, const std::string& name);

}  // namespace desert_sim

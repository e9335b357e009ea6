#pragma once
/// ROS parameters as YAML, so that the loader of files reads both.

#include <yaml-cpp/yaml.h>

#include <string>

namespace desert_sim {

/// All parameters below the name of a node, as a map; an empty one if there are none. Throws ConfigError
/// for types that YAML does not have, and Error if the ROS master does not answer.
YAML::Node private_parameters(const std::string& name);

}  // namespace desert_sim

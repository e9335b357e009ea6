#pragma once
/// The files of scenarios, by name.

#include <string>

namespace desert_sim {

/// The file that a scenario's name stands for: `name` itself if it has a '/' or ends in .yaml or .yml, else
/// the file of that name in config/scenarios of this package, which is looked up in ROS_PACKAGE_PATH. Throws
/// ConfigError that lists the scenarios there are.
std::string scenario_file(const std::string& name);

}  // namespace desert_sim

#pragma once
/// Where this package's own files are.

#include <string>

namespace desert_sim {

/// The folder of desert_sim among ROS_PACKAGE_PATH's packages, found as rospack does: entries in turn,
/// folders below them, not into packages. Empty if it is not there.
std::string package_folder();

/// The file that a scenario's name stands for: `name` itself if it has a '/' or ends in .yaml or .yml, else
/// the file of that name in the package's config/scenarios. Throws ConfigError that lists the scenarios there
/// are.
std::string scenario_file(const std::string& name);

}  // namespace desert_sim

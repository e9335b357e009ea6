#pragma once
/// Where this package's files are.

#include <string>

namespace desert_sim {

/// The folder of this package with config/: the one in ROS_PACKAGE_PATH, or that of the prefix in which this
/// program is installed; empty if neither is there. It is looked up once in the life of a process.
const std::string& package_folder();

}  // namespace desert_sim

#pragma once
/// The files of scenarios, by name.

#include <string>
#include <vector>

namespace desert_sim {

/// The file that a scenario's name stands for: `name` itself if it has a '/' or ends in .yaml or .yml, else
/// the file of that name in config/scenarios of this package, which is looked up in ROS_PACKAGE_PATH. Throws
/// ConfigError that lists the scenarios there are.
std::string scenario_file(const std::string& name);

/// The folder config/scenarios of this package, links followed; empty if ROS_PACKAGE_PATH does not have the
/// package. It is looked up once in the life of a process.
const std::string& installed_scenario_folder();

/// The names of the scenarios in that folder, sorted.
std::vector<std::string> installed_scenarios();

/// The file of the installed scenario of exactly this name; empty if there is none.
std::string installed_scenario_file(const std::string& name);

}  // namespace desert_sim

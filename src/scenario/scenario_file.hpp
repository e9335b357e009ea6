#pragma once
/// The files of scenarios, by name.

#include <string>
#include <vector>

namespace desert_sim {

/// The file that a scenario's name stands for: `name` itself if it has a '/' or ends in .yaml or .yml, else
/// the file of that name in config/scenarios of this package. Throws ConfigError that lists the scenarios
/// there are.
std::string scenario_file(const std::string& name);

/// The file that an argument of a program stands for: the file of exactly this name if there is one, else
/// scenario_file() of it.
std::string scenario_argument(const std::string& argument);

/// The folder config/scenarios of package_folder(), links followed; empty if there is none.
const std::string& installed_scenario_folder();

/// The names of the scenarios in that folder, sorted.
std::vector<std::string> installed_scenarios();

/// The file of the installed scenario of exactly this name; empty if there is none.
std::string installed_scenario_file(const std::string& name);

}  // namespace desert_sim

#pragma once
/// The files of scenarios, by name.

#include <string>
#include <vector>

#include "src/scenario/scenario_names.hpp"

namespace desert_sim {

/// The file that a scenario's name stands for: `name` itself if it has a '/' or ends in .yaml or .yml, or
/// saved_scenario_file in it if that is a folder which has one; else, and for the name that
/// installed_scenario_uri() makes, the file in config/scenarios of this package. Throws ConfigError that
/// lists the scenarios there are.
std::string scenario_file(const std::string& name);

/// The file that an argument of a program stands for: the file of exactly this name if there is one, or that
/// of a saved scenario in the folder of this name; else scenario_file() of it. Throws ConfigError also if a
/// name is both that of such a folder and of an installed scenario.
std::string scenario_argument(const std::string& argument);

/// The folder config/scenarios of package_folder(), links followed; empty if there is none.
const std::string& installed_scenario_folder();

/// The names of the scenarios in that folder, sorted.
std::vector<std::string> installed_scenarios();

/// The file of the installed scenario of exactly this name, or of the name that installed_scenario_uri()
/// makes of it; empty if there is none.
std::string installed_scenario_file(const std::string& name);

/// What to say where a name means both an installed scenario and the file that `other` names.
std::string two_meanings(const std::string& name, const std::string& other);

}  // namespace desert_sim

#pragma once
/// The key `rover` selects a class of rovers from config/rovers: its section `traversability` completes
/// that of the scenario, whose own values override it. The files have a section `rover_dimensions` besides,
/// which is not for a scenario but for who draws and drives the rover; rover_preset_text() has it.

#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace desert_sim {

class ValidationErrors;

/// Names of the classes, in alphabetical order.
std::vector<std::string> rover_presets();
/// The comment in the first line of a class's file, without "# ".
std::string rover_preset_doc(const std::string& name);
/// The whole file, as YAML. Throws ConfigError, which names all classes, if there is none of this name.
std::string rover_preset_text(const std::string& name);

/// The scenario completed with the values of the class that it names; unchanged if it names none. An
/// unknown class is added to `errors`.
YAML::Node apply_rover(const YAML::Node& root, ValidationErrors& errors);

}  // namespace desert_sim

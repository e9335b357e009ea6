#pragma once
/// The key `climate` selects a preset of rain, evaporation, soil and species from config/climates. Values
/// that the scenario itself gives override the preset.

#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace desert_sim {

class ValidationErrors;

/// Names of the climates, in alphabetical order.
std::vector<std::string> climates();
/// The comment in the first line of a climate's file, without "# ".
std::string climate_doc(const std::string& name);

/// The scenario completed with the values of the climate that it names; unchanged if it names none. An
/// unknown climate is added to `errors`.
YAML::Node apply_climate(const YAML::Node& root, ValidationErrors& errors);

}  // namespace desert_sim

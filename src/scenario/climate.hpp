#pragma once
/// `climate`: one word that sets rain, evaporation, soil and species together; what else the scenario says
/// about them overrides it. The climates are config/climates.

#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace desert_sim {

class Faults;

/// Names of the climates, in alphabetical order, and the first line of each.
std::vector<std::string> climates();
std::string climate_doc(const std::string& name);

/// The scenario with what its climate sets and it does not say; itself if it names none.
YAML::Node with_climate(const YAML::Node& root, Faults& faults);

}  // namespace desert_sim

#pragma once
/// Names by which scenarios are loaded; all in this header, because rviz's plugins have no other part of it.

#include <string>

namespace desert_sim {

/// In the folder of a scenario saved with its state.
constexpr const char* saved_scenario_file = "scenario.yaml";

/// A name that no file of a user has: "package://desert_sim/config/scenarios/barchan.yaml".
constexpr const char* installed_scenario_start = "package://desert_sim/config/scenarios/";
inline std::string installed_scenario_uri(const std::string& name) {
  return installed_scenario_start + name + ".yaml";
}

}  // namespace desert_sim

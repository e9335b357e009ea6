#pragma once
/// Settings that a scenario gives and nothing in it reads.

#include <string>
#include <vector>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// A line for each of them, with the reason: sections of processes that differ from their defaults, of which
/// no process that takes part reads any; segments of a wind that is constant; sand that blows in over edges
/// that are none; a sea without water. Nothing for a section that is switched off (enabled: false).
std::vector<std::string> settings_without_effect(const Scenario& scenario);

}  // namespace desert_sim

#pragma once
/// What micro-relief depends on besides layers, as a message and back.

#include <desert_sim/MicroReliefState.h>

#include <string>

#include "src/ros/simulation/terrain_state.hpp"

namespace desert_sim {

MicroReliefStatePtr micro_relief_message(const TerrainState& state, const std::string& frame);

/// The same in a snapshot without cells and layers: `micro_relief`, the wind above, periods, step and time.
/// Size and place of the terrain are those of maps. Throws ConfigError that lists all that is wrong.
Snapshot snapshot_of(const MicroReliefState& message);

}  // namespace desert_sim

#pragma once
/// What the detail of the surface depends on besides layers, as a message and back.

#include <desert_sim/DetailState.h>

#include <string>

#include "src/ros/node/terrain_state.hpp"

namespace desert_sim {

DetailStatePtr detail_message(const TerrainState& state, const std::string& frame);

/// The same in a snapshot without cells and layers: `detail`, the wind above, periods, step and time. Size
/// and place of the terrain are those of maps. Throws ConfigError that lists all that is wrong.
Snapshot snapshot_of(const DetailState& message);

}  // namespace desert_sim

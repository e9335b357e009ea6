#pragma once
/// Tiles of ~elevation_updates.

#include <desert_sim/ElevationTile.h>

#include "src/simulation/views/elevation_changes.hpp"

namespace desert_sim {

/// The smallest box in `change` that has all cells that changed, of which there is at least one.
ElevationTile tile_message(const TileChange& change);

}  // namespace desert_sim

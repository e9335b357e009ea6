#pragma once
/// The tiles of ~elevation_updates and of the updates of layers.

#include <desert_sim/LayerTile.h>

#include "src/simulation/views/layer_changes.hpp"

namespace desert_sim {

/// The cells of `change` that changed, of which there is at least one, in the smallest box that has them all.
LayerTile tile_message(const TileChange& change);

}  // namespace desert_sim

#pragma once
/// Snapshots in the form in which src/render takes terrains.

#include <vector>

#include "src/render/plant_shapes.hpp"
#include "src/render/terrain_block.hpp"
#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

/// The values of a snapshot in rectangles of cells. It must outlive what is returned.
render::LayerWindow layer_windows(const Snapshot& snapshot);

/// The layers of a snapshot that a look needs.
std::vector<Layer> layers_of(const render::TerrainLook& look);

/// All plants, in the colours of their species, with feet that are `exaggeration` times as high.
render::Mesh plants_of(const PlantList& list, double exaggeration = 1, bool light = true);

}  // namespace desert_sim

#pragma once
/// Snapshots as rasters and pictures.

#include "src/io/picture.hpp"
#include "src/io/raster.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// One of the snapshot's layers where the snapshot lies.
Raster raster_of(const Snapshot& snapshot, const std::vector<float>& values, const std::string& projection);

/// Points into the snapshot's layers.
PictureInput picture_of(const Snapshot& snapshot);

}  // namespace desert_sim

#pragma once
/// Converts snapshots to rasters and to the input of pictures.

#include "src/io/picture.hpp"
#include "src/io/raster.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// A raster of `values`, one of the snapshot's layers, with the snapshot's grid and position.
Raster to_raster(const Snapshot& snapshot, const std::vector<float>& values, const std::string& projection);

/// The snapshot's layers as input of a picture, which points into the snapshot and must not outlive it.
PictureInput to_picture_input(const Snapshot& snapshot);

}  // namespace desert_sim

#pragma once
/// A scenario whose terrain is one raster file with named bands, such as a GridMap in a bag.

#include <string>

#include "src/scenario/raster_grid.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// Whether a path has the extension .bag, so that it names a rosbag.
bool is_bag(const std::string& path);

/// A scenario with the file's grid and open boundaries. Each layer is read from the band of the same name, or
/// of that name followed by _depth; other bands are ignored. Without a band `bedrock`, the bedrock is
/// `elevation` minus the soil and sand. With `fill_nodata`, cells without data are filled from their
/// neighbours; otherwise build_terrain() refuses them. Throws ConfigError, listing the bands, if the file has
/// neither `bedrock` nor `elevation`.
Scenario scenario_from_bands(const std::string& path, const RasterLoader& load_raster, bool fill_nodata);

}  // namespace desert_sim

#pragma once
/// A terrain whose layers are the named bands of one file, such as a GridMap in a bag.

#include <string>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// Whether a path is that of a bag (rosbag), by its ending.
bool is_bag(const std::string& path);

/// A scenario whose grid is the file's, with open edges, and whose layers are its bands of the same name, or
/// of that name with _depth behind it; other bands are not looked at. Without a band `bedrock`, the bedrock
/// is `elevation` less the soil and sand on it. Gaps are filled from around, or else refused when the terrain
/// is built. Throws ConfigError, naming the bands, if there is neither.
Scenario scenario_of_bands(const std::string& path, const RasterLoader& load_raster, bool fill_nodata);

}  // namespace desert_sim

#pragma once
/// Bags (rosbag) with a terrain as grid_map_msgs/GridMap.

#include <string>

#include "src/grid_map/grid_map_msg.hpp"
#include "src/io/raster.hpp"
#include "src/scenario/band_terrain.hpp"

namespace desert_sim {

/// Writes a bag with one message, latched when it is played. To a temporary name first. Throws ConfigError if
/// it cannot be written or the map is beyond what a bag can hold (2 GB); a file of that name is then as
/// before.
void write_grid_map(const std::string& path, const std::string& topic, const GridMap& map);

/// The last GridMap in a bag. Throws ConfigError, naming the file and the reason: missing, no bag, cut off or
/// corrupt, none in it, several topics that have some, one of another definition.
GridMap read_grid_map(const std::string& path);

/// Layer `band` (counted from 1) as a raster; the map's start indices are honoured. value = raw · scale +
/// offset. Throws ConfigError, naming `source`, for what is no map (see LoadTerrain.srv).
Raster raster_of(const GridMap& map, const RasterOptions& options, const std::string& source);

/// As gdal_raster_loader(), and reads GridMaps in bags too: their layers are its bands.
RasterLoader raster_loader_with_bags();

}  // namespace desert_sim

#pragma once
/// Reads and writes bags (rosbag) that contain a terrain as grid_map_msgs/GridMap.

#include <string>

#include "src/grid_map/grid_map_msg.hpp"
#include "src/io/raster.hpp"
#include "src/scenario/band_terrain.hpp"
#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

/// Writes a bag with one message, which is latched when the bag is played, by write_file(). Throws
/// ConfigError if the path cannot be written or the map is larger than a bag allows (2 GB), WriteError if
/// the disk is full or broken; an existing file of that name is then unchanged.
void write_grid_map(const std::string& path, const std::string& topic, const GridMap& map);

/// Reads the last GridMap in a bag; with a `folder`, of one below it. Throws ConfigError that names the
/// file and the reason: the file cannot be opened (see InputFile), is not a bag, is truncated or corrupt,
/// has no GridMap, has GridMaps on several topics, or has one with another message definition.
GridMap read_grid_map(const std::string& path, const std::string& folder = "");

/// Converts layer `band` (counted from 1) to a raster, with value = raw · scale + offset. The start indices
/// of the map's circular buffer are taken into account. Throws ConfigError that names `source` for an invalid
/// map (see LoadTerrain.srv).
Raster to_raster(const GridMap& map, const RasterOptions& options, const std::string& source);

/// A loader that reads .bag files as GridMaps, whose layers are its bands, and other files like
/// gdal_raster_loader().
RasterLoader raster_loader_with_bags(const RasterAccess& access = {});

}  // namespace desert_sim

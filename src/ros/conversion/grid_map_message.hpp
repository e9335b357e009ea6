#pragma once
/// Windows of the terrain as messages.

#include <desert_sim/TerrainSubmap.h>

#include <boost/shared_ptr.hpp>
#include <string>
#include <vector>

#include "src/grid_map/grid_map_msg.hpp"
#include "src/ros/node/moment.hpp"
#include "src/ros/topics/map_window.hpp"

namespace desert_sim {

/// Blocks of `decimation`² cells (see window_values()); resolution is their width. basic_layers is elevation,
/// where it is one of the layers.
GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MapWindow& window, int decimation = 1);

TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MapWindow& window);

}  // namespace desert_sim

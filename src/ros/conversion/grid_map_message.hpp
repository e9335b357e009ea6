#pragma once
/// Windows of the terrain as messages: a grid_map_msgs/GridMap, and the answer of ~get_submap.

#include <desert_sim/TerrainSubmap.h>

#include <boost/shared_ptr.hpp>
#include <string>
#include <vector>

#include "src/grid_map/grid_map_msg.hpp"
#include "src/ros/conversion/map_window.hpp"
#include "src/ros/simulation/terrain_state.hpp"

namespace desert_sim {

/// A cell of the map is a block of `decimation`² cells of the terrain (see window_values()). `basic_layers`
/// is elevation, where that is one of the layers.
GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MapWindow& window, int decimation = 1);

/// The elevation with micro-relief, and of other layers the values of the cells in which the points lie.
GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MicroReliefWindow& window);

// The same as submaps.
TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MapWindow& window);
TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MicroReliefWindow& window);

}  // namespace desert_sim

#pragma once
/// ~get_submap and ~get_grid_map: rectangles of the terrain's cells on request.

#include <desert_sim/GetSubmap.h>

#include "src/ros/conversion/grid_map_message.hpp"
#include "src/ros/node/frames.hpp"
#include "src/ros/topics/map_cut.hpp"

namespace desert_sim {

class Submaps {
 public:
  /// Keeps references to both.
  Submaps(SimulationThread& simulation, const Frames& frames) : simulation_(simulation), frames_(frames) {}

  // Throw ConfigError that names the field, its value and what is allowed.
  TerrainSubmap get(const GetSubmapRequest& request) const;
  GridMap get(const GetGridMapRequest& request) const;

 private:
  MapCut cut(const std::vector<MapLayer>& layers, const std_msgs::Header& header,
             const geometry_msgs::Point& center, double length_x, double length_y) const;

  SimulationThread& simulation_;
  const Frames& frames_;
};

}  // namespace desert_sim

#pragma once
/// How the maps are published: ~grid_map, ~local_map, ~costmap, ~image.

#include <yaml-cpp/yaml.h>

#include <set>
#include <string>
#include <vector>

#include "src/core/parameters.hpp"
#include "src/ros/topics/map_window.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

/// A rate of 0 leaves only what is sent to new subscribers, after the service step, and after a reset or
/// load.
struct MapParameters {
  double grid_map_rate = 1;
  int grid_map_decimation = 1;
  double grid_map_x = 0;
  double grid_map_y = 0;
  double grid_map_length_x = 0;
  double grid_map_length_y = 0;
  double local_map_rate = 5;
  double local_map_length_x = 20;
  double local_map_length_y = 20;
  std::string robot_frame = "base_link";
  double costmap_update_rate = 1;
  double costmap_keyframe_rate = 0.1;
  int costmap_update_threshold = 3;
  double image_rate = 1;
};
constexpr auto parameter_table(const MapParameters*) {
  using P = MapParameters;
  return std::make_tuple(
      parameter("grid_map_rate", &P::grid_map_rate, 0, 1000, "Hz", "~grid_map."),
      parameter("grid_map_decimation", &P::grid_map_decimation, 1, 65536, "cells",
                "Cells of the terrain in a row that make one of ~grid_map."),
      parameter("grid_map_x", &P::grid_map_x, -1e9, 1e9, "m", "Centre of the region of ~grid_map."),
      parameter("grid_map_y", &P::grid_map_y, -1e9, 1e9, "m", "Centre of the region of ~grid_map."),
      parameter("grid_map_length_x", &P::grid_map_length_x, 0, 1e9, "m",
                "Length of the region; both 0: the whole terrain."),
      parameter("grid_map_length_y", &P::grid_map_length_y, 0, 1e9, "m",
                "Length of the region; both 0: the whole terrain."),
      parameter("local_map_rate", &P::local_map_rate, 0, 1000, "Hz", "~local_map."),
      parameter("local_map_length_x", &P::local_map_length_x, 1e-3, 1e9, "m", "Length of ~local_map."),
      parameter("local_map_length_y", &P::local_map_length_y, 1e-3, 1e9, "m", "Length of ~local_map."),
      parameter("robot_frame", &P::robot_frame, "Frame whose origin ~local_map follows."),
      parameter("costmap_update_rate", &P::costmap_update_rate, 0, 1000, "Hz",
                "~costmap_updates; not above the update_frequency of a costmap_2d that listens."),
      parameter("costmap_keyframe_rate", &P::costmap_keyframe_rate, 0, 1000, "Hz", "~costmap, whole."),
      parameter(
          "costmap_update_threshold", &P::costmap_update_threshold, 0, 98, "1",
          "Change of a cost, since what subscribers hold, that sends it; lethal and unknown always do."),
      parameter("image_rate", &P::image_rate, 0, 1000, "Hz", "~image."));
}
static_assert(table_is_complete<MapParameters>());

struct MapSetup {
  MapParameters parameters;
  std::vector<MapLayer> grid_map_layers =
      choose_map_layers({"elevation", "sand_depth", "slope", "traversability"}, "");
  std::vector<MapLayer> local_map_layers = choose_map_layers({"elevation", "traversability"}, "");
};

/// Reads the table above and the lists grid_map_layers and local_map_layers, and adds their keys to `known`.
void read_map_setup(const YAML::Node& root, Faults& faults, MapSetup& maps, std::set<std::string>& known);

/// Throws ConfigError, naming the parameter, if a map would have more than 67108864 values on this grid.
void check_map_sizes(const MapSetup& maps, const GridParameters& grid);

/// Throws ConfigError, naming `what`, if `layers` of this window have more than 67108864 values (256 MiB).
void require_moderate(const MapWindow& window, std::size_t layers, const std::string& what);

}  // namespace desert_sim

#pragma once
/// The parameters of the topics: how often each is published, and how finely. config/publishers.yaml has them
/// all, and all can change while the node runs. A rate of 0 leaves what is sent to new subscribers, before
/// ~step answers, and after a reset or a load.

#include <yaml-cpp/yaml.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "src/core/parameter_values.hpp"
#include "src/ros/conversion/map_window.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

/// The rates and sizes of the topics that are no maps.
struct PublisherParameters {
  double refresh_rate = 0.05;
  double appearance_rate = 1;
  double keyframe_rate = 1;
  double update_rate = 10;
  double update_threshold = 0.005;
  int update_tile = 32;
  double layer_keyframe_rate = 1;
  double layer_update_rate = 10;
  double micro_relief_rate = 10;
  double wind_rate = 2;
  int wind_decimation = 1;
  double wind_features_rate = 2;
  double wind_markers_rate = 2;
  int wind_markers_count = 180;
  double points_rate = 4;
  int points_count = 70000;
  double water_points_rate = 4;
  double plants_rate = 1;
  int plants_count = 4000000;
  double particle_paths_rate = 1;
  int particle_paths_count = 300;
  double plant_markers_rate = 1;
  int plant_markers_count = 10000;
  double forecast_rate = 0;
  double forecast_horizon = 60;
  int forecast_moments = 6;
  int forecast_stride = 1;
  double status_rate = 1;
};
constexpr auto parameter_table(const PublisherParameters*) {
  using P = PublisherParameters;
  return std::make_tuple(
      parameter("refresh_rate", &P::refresh_rate, 0, 1000, "Hz",
                "Every topic that shows something as a whole, whether it has changed or not, so that what "
                "is recorded from any moment on has all of it; not updates."),
      parameter("appearance_rate", &P::appearance_rate, 0, 1000, "Hz", "~appearance."),
      parameter("keyframe_rate", &P::keyframe_rate, 0, 1000, "Hz", "~elevation."),
      parameter("update_rate", &P::update_rate, 0, 1000, "Hz", "~elevation_updates."),
      parameter("update_threshold", &P::update_threshold, 0, 1000, "m",
                "A cell whose value differs by more than this from what subscribers hold is sent, so that "
                "theirs is never further off."),
      parameter("update_tile", &P::update_tile, 1, 65536, "cells",
                "Largest width of a rectangle of cells that is sent as one."),
      parameter("layer_keyframe_rate", &P::layer_keyframe_rate, 0, 1000, "Hz",
                "~layers/<name>, while a node takes keyframes of the layer but no updates."),
      parameter("layer_update_rate", &P::layer_update_rate, 0, 1000, "Hz", "~layers/<name>_updates."),
      parameter("micro_relief_rate", &P::micro_relief_rate, 0, 1000, "Hz", "~micro_relief."),
      parameter("wind_rate", &P::wind_rate, 0, 1000, "Hz", "~wind and ~wind_array."),
      parameter("wind_decimation", &P::wind_decimation, 1, 65536, "cells",
                "Cells of the terrain in a row that are averaged into one of ~wind and of ~wind_array."),
      parameter("wind_features_rate", &P::wind_features_rate, 0, 1000, "Hz", "~wind_features."),
      parameter("wind_markers_rate", &P::wind_markers_rate, 0, 1000, "Hz", "~wind_markers."),
      parameter("wind_markers_count", &P::wind_markers_count, 1, 100000, "1", "At most so many arrows."),
      parameter("points_rate", &P::points_rate, 0, 1000, "Hz", "~points."),
      parameter("points_count", &P::points_count, 1, 100000000, "1",
                "At most so many points; rviz stays fluid with 40000 to 100000."),
      parameter("water_points_rate", &P::water_points_rate, 0, 1000, "Hz",
                "~water_points; at most points_count of them."),
      parameter("plants_rate", &P::plants_rate, 0, 1000, "Hz", "~plants."),
      parameter("plants_count", &P::plants_count, 1, 100000000, "1",
                "At most so many plants, of 18 bytes each; if there are more, the widest."),
      parameter("particle_paths_rate", &P::particle_paths_rate, 0, 1000, "Hz", "~particle_paths."),
      parameter("particle_paths_count", &P::particle_paths_count, 1, 100000, "1", "At most so many grains."),
      parameter("plant_markers_rate", &P::plant_markers_rate, 0, 1000, "Hz", "~plant_markers."),
      parameter("plant_markers_count", &P::plant_markers_count, 1, 1000000, "1",
                "At most so many plants, the widest; a tenth of them with trunk and crown."),
      parameter("forecast_rate", &P::forecast_rate, 0, 1000, "Hz",
                "~forecast/maps and ~forecast/costmap, as far as forecasts are as fast; 0: none."),
      parameter("forecast_horizon", &P::forecast_horizon, 1e-6, 1e12, "s",
                "Of ~forecast/maps: how far ahead, in ROS time; at most 10^6 steps."),
      parameter("forecast_moments", &P::forecast_moments, 1, 100, "1",
                "Of ~forecast/maps: states to tell, evenly spaced, the last at the horizon."),
      parameter("forecast_stride", &P::forecast_stride, 1, 1000, "1",
                "Of ~forecast/maps: steps of the live run that one step stands for; 1: the live run's states "
                "to the bit, "
                "more: as much faster, and coarser in time."),
      parameter("status_rate", &P::status_rate, 0, 1000, "Hz", "~status; it is also sent on change."));
}
static_assert(table_is_complete<PublisherParameters>());

/// The rates and cells of ~grid_map, ~local_map, ~costmap and ~image.
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
  double local_map_resolution = 0;
  std::string robot_frame = "base_link";
  double costmap_update_rate = 1;
  double costmap_keyframe_rate = 0.1;
  int costmap_update_threshold = 3;
  int costmap_update_rectangles = 4;
  double costmap_update_spacing = 0.3;
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
      parameter(
          "local_map_resolution", &P::local_map_resolution, 0, 1000, "m",
          "Side of a cell of ~local_map, whose elevation then has ripples and bumps (section micro_relief); "
          "0.001 m at least; 0: the terrain's cells, without."),
      parameter("robot_frame", &P::robot_frame, "Frame whose origin ~local_map follows."),
      parameter("costmap_update_rate", &P::costmap_update_rate, 0, 1000, "Hz",
                "~costmap_updates; not above the update_frequency of a costmap_2d that listens."),
      parameter("costmap_keyframe_rate", &P::costmap_keyframe_rate, 0, 1000, "Hz", "~costmap, whole."),
      parameter(
          "costmap_update_threshold", &P::costmap_update_threshold, 0, 98, "1",
          "Change of a cost, since what subscribers hold, that sends it; lethal and unknown always do."),
      parameter(
          "costmap_update_rectangles", &P::costmap_update_rectangles, 1, 64, "1",
          "An update is divided into at most so many messages of one rectangle each, where changes are far "
          "apart; 1: each has all changes, and those of the last one and a half periods again."),
      parameter(
          "costmap_update_spacing", &P::costmap_update_spacing, 0.001, 1000, "s",
          "From one of these to the next; above 1 / update_frequency of a costmap_2d that listens, which "
          "looks at the last one in each of its cycles only."),
      parameter("image_rate", &P::image_rate, 0, 1000, "Hz", "~image."));
}
static_assert(table_is_complete<MapParameters>());

/// The parameters of the maps: those of the table, and two lists, which a table has no rows for.
struct MapSetup {
  MapParameters parameters;
  std::vector<MapLayer> grid_map_layers =
      map_layers_named({"elevation", "sand_depth", "slope", "traversability"}, "");
  std::vector<MapLayer> local_map_layers = map_layers_named({"elevation", "traversability"}, "");
};

/// By name, thresholds of layers that differ from those of map_layers, in the layer's unit.
using LayerThresholds = std::map<std::string, double>;

/// As in YAML: {sand_depth: 0.01, wind_x: 0.1}.
std::string yaml_map(const LayerThresholds& thresholds);

/// The parameters of all topics.
struct PublisherSetup {
  PublisherParameters topics;
  LayerThresholds layer_thresholds;
  MapSetup maps;
};

/// Reads the keys that `root` has, adds all keys that there are to `known`, and what is wrong to `errors`.
void read_publisher_setup(const YAML::Node& root, ValidationErrors& errors, PublisherSetup& setup,
                          std::set<std::string>& known);

/// Throws ConfigError, naming the parameter, if a map would have more than 67108864 values on this grid.
void check_map_sizes(const MapSetup& maps, const GridParameters& grid);

/// Visits all parameters except the lists of layers.
inline void visit_publisher_parameters(const PublisherSetup& setup, const ConstParameterVisit& visit) {
  visit_parameters(setup.topics, visit);
  visit_parameters(setup.maps.parameters, visit);
}

}  // namespace desert_sim

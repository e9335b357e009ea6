#pragma once
/// How often and how finely the node publishes: all that config/publishers.yaml says. All of it can change
/// while the node runs.

#include "src/ros/topics/map_parameters.hpp"

namespace desert_sim {

/// How often topics are published, and how finely. A rate of 0 leaves only what is sent to new subscribers,
/// after the service step, and after a reset or load.
struct PublisherParameters {
  double keyframe_rate = 1;
  double update_rate = 10;
  double update_threshold = 0.005;
  int update_tile = 32;
  double wind_rate = 2;
  int wind_decimation = 1;
  double wind_markers_rate = 2;
  int wind_markers_count = 180;
  double points_rate = 4;
  int points_count = 70000;
  double water_points_rate = 4;
  double plants_rate = 1;
  int plants_count = 200000;
  double plant_markers_rate = 1;
  int plant_markers_count = 10000;
  double status_rate = 1;
};
constexpr auto parameter_table(const PublisherParameters*) {
  using P = PublisherParameters;
  return std::make_tuple(
      parameter("keyframe_rate", &P::keyframe_rate, 0, 1000, "Hz", "~elevation."),
      parameter("update_rate", &P::update_rate, 0, 1000, "Hz", "~elevation_updates."),
      parameter("update_threshold", &P::update_threshold, 0, 1000, "m",
                "Change of a cell, since what subscribers hold, that is sent; so far one may be off there."),
      parameter("update_tile", &P::update_tile, 1, 65536, "cells",
                "Largest width of a rectangle of cells that is sent as one."),
      parameter("wind_rate", &P::wind_rate, 0, 1000, "Hz", "~wind."),
      parameter("wind_decimation", &P::wind_decimation, 1, 65536, "cells",
                "Cells of the terrain in a row that are averaged into one of ~wind."),
      parameter("wind_markers_rate", &P::wind_markers_rate, 0, 1000, "Hz", "~wind_markers."),
      parameter("wind_markers_count", &P::wind_markers_count, 1, 100000, "1", "At most so many arrows."),
      parameter("points_rate", &P::points_rate, 0, 1000, "Hz", "~points."),
      parameter("points_count", &P::points_count, 1, 100000000, "1",
                "At most so many points; rviz stays fluid with 40000 to 100000."),
      parameter("water_points_rate", &P::water_points_rate, 0, 1000, "Hz",
                "~water_points; at most points_count of them."),
      parameter("plants_rate", &P::plants_rate, 0, 1000, "Hz", "~plants."),
      parameter("plants_count", &P::plants_count, 1, 100000000, "1",
                "At most so many plants; if there are more, the widest."),
      parameter("plant_markers_rate", &P::plant_markers_rate, 0, 1000, "Hz", "~plant_markers."),
      parameter("plant_markers_count", &P::plant_markers_count, 1, 1000000, "1",
                "At most so many plants, the widest; a tenth of them with trunk and crown."),
      parameter("status_rate", &P::status_rate, 0, 1000, "Hz", "~status; it is also sent on change."));
}
static_assert(table_is_complete<PublisherParameters>());

/// Of all topics.
struct PublisherSetup {
  PublisherParameters topics;
  MapSetup maps;
};

/// Reads the keys that `root` has, adds all that there are to `known`, and what is wrong to `faults`.
void read_publisher_setup(const YAML::Node& root, Faults& faults, PublisherSetup& setup,
                          std::set<std::string>& known);

/// Calls visit(row, value) for all parameters but the lists of layers.
template <class Setup, class Visit>
void for_each_publisher_parameter(Setup& setup, Visit&& visit) {
  for_each_parameter(setup.topics, visit);
  for_each_parameter(setup.maps.parameters, visit);
}

}  // namespace desert_sim

#include "src/ros/services/submaps.hpp"

#include "src/core/error.hpp"
#include "src/ros/services/requests.hpp"
#include "src/ros/topics/map_parameters.hpp"

namespace desert_sim {

namespace {

std::vector<MapLayer> asked_layers(const std::vector<std::string>& names) {
  if (names.empty()) return {map_layers.begin(), map_layers.end()};
  return choose_map_layers(names, "layers");
}

}  // namespace

MapCut Submaps::cut(const std::vector<MapLayer>& layers, const std_msgs::Header& header,
                    const geometry_msgs::Point& center, double length_x, double length_y) const {
  require_finite(center, "center");
  const tf2::Vector3 c = frames_.to_terrain(header) * tf2::Vector3(center.x, center.y, center.z);
  const MapRegion region{c.x(), c.y(), length_x, length_y};
  return cut_terrain(simulation_, layers, [&](const Snapshot& s) {
    const MapWindow window = window_of(region, s);
    require_inside(window, region, s);
    require_moderate(window, layers.size(), "region");
    return window;
  });
}

TerrainSubmap Submaps::get(const GetSubmapRequest& r) const {
  const std::vector<MapLayer> layers = asked_layers(r.layers);
  const MapCut c = cut(layers, r.header, r.center, r.length_x, r.length_y);
  return terrain_submap(c.state, frames_.terrain_frame(), layers, c.window);
}

GridMap Submaps::get(const GetGridMapRequest& r) const {
  const std::vector<MapLayer> layers = asked_layers(r.layers);
  std_msgs::Header header;
  header.frame_id = r.frame_id;
  geometry_msgs::Point center;
  center.x = r.position_x;
  center.y = r.position_y;
  const MapCut c = cut(layers, header, center, r.length_x, r.length_y);
  return grid_map(c.state, frames_.terrain_frame(), layers, c.window);
}

}  // namespace desert_sim

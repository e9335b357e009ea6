#include "desert_sim/ros/submaps.hpp"

#include "desert_sim/core/error.hpp"
#include "desert_sim/ros/map_parameters.hpp"
#include "desert_sim/ros/requests.hpp"

namespace desert_sim {

Submaps::Cut Submaps::cut(const std_msgs::Header& header, const geometry_msgs::Point& center, double length_x,
                          double length_y, const std::vector<std::string>& layers) const {
  require_finite(center, "center");
  Cut cut;
  cut.layers = layers.empty() ? std::vector<MapLayer>(map_layers.begin(), map_layers.end())
                              : choose_map_layers(layers, "layers");
  const tf2::Vector3 c = frames_.to_terrain(header) * tf2::Vector3(center.x, center.y, center.z);
  const MapRegion region{c.x(), c.y(), length_x, length_y};
  const auto check = [&](const Snapshot& s) {
    cut.window = window_of(region, s);
    require_inside(cut.window, region, s);
    require_moderate(cut.window, cut.layers.size(), "region");
  };
  check(*simulation_.terrain({}).get().snapshot);  // nothing is computed for what is refused
  cut.state = simulation_.terrain(terrain_layers(cut.layers)).get();
  check(*cut.state.snapshot);  // a checkpoint may have been loaded in between
  return cut;
}

TerrainSubmap Submaps::get(const GetSubmapRequest& r) const {
  const Cut c = cut(r.header, r.center, r.length_x, r.length_y, r.layers);
  return terrain_submap(c.state, frames_.terrain_frame(), c.layers, c.window);
}

GridMap Submaps::get(const GetGridMapRequest& r) const {
  std_msgs::Header header;
  header.frame_id = r.frame_id;
  geometry_msgs::Point center;
  center.x = r.position_x;
  center.y = r.position_y;
  const Cut c = cut(header, center, r.length_x, r.length_y, r.layers);
  return grid_map(c.state, frames_.terrain_frame(), c.layers, c.window);
}

}  // namespace desert_sim

#include "src/ros/conversion/grid_map_message.hpp"

#include <algorithm>

#include "src/ros/conversion/messages.hpp"

namespace desert_sim {

namespace {

std_msgs::MultiArrayDimension dimension(const char* label, std::uint32_t size, std::uint32_t stride) {
  std_msgs::MultiArrayDimension d;
  d.label = label;
  d.size = size;
  d.stride = stride;
  return d;
}

}  // namespace

GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MapWindow& window, int decimation) {
  const Snapshot& s = *state.snapshot;
  const int along_x = (window.width + decimation - 1) / decimation,
            along_y = (window.height + decimation - 1) / decimation;
  GridMap map;
  map.info.header = header_of(state.moment, frame);
  map.info.resolution = s.cell_size * decimation;
  map.info.length_x = along_x * map.info.resolution;
  map.info.length_y = along_y * map.info.resolution;
  map.info.pose.position.x = s.origin_x + window.x0 * s.cell_size + 0.5 * map.info.length_x;
  map.info.pose.position.y = s.origin_y + window.y0 * s.cell_size + 0.5 * map.info.length_y;
  map.info.pose.orientation.w = 1;
  const auto rows = static_cast<std::uint32_t>(along_x), columns = static_cast<std::uint32_t>(along_y);
  for (const MapLayer& layer : layers) {
    map.layers.emplace_back(layer.name);
    if (layer.layer == Layer::elevation) map.basic_layers.emplace_back(layer.name);
    map.data.emplace_back();
    map.data.back().layout.dim = {dimension("column_index", columns, rows * columns),
                                  dimension("row_index", rows, rows)};
    // A GridMap counts rows from the largest x and columns from the largest y, with rows as the inner index:
    // this is the order of a snapshot, reversed.
    map.data.back().data = window_values(s, layer, window, decimation);
    std::reverse(map.data.back().data.begin(), map.data.back().data.end());
  }
  return map;
}

TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MapWindow& window) {
  const Snapshot& s = *state.snapshot;
  TerrainSubmap map;
  map.header = header_of(state.moment, frame);
  map.step = s.step;
  map.sim_time = s.time;
  map.width = static_cast<std::uint32_t>(window.width);
  map.height = static_cast<std::uint32_t>(window.height);
  map.cell_size = s.cell_size;
  map.origin = origin_of(s);
  map.origin.position.x += window.x0 * s.cell_size;
  map.origin.position.y += window.y0 * s.cell_size;
  for (const MapLayer& layer : layers) {
    map.layers.emplace_back();
    map.layers.back().name = layer.name;
    map.layers.back().unit = info(layer.layer).unit;
    map.layers.back().data = window_values(s, layer, window);
  }
  return map;
}

}  // namespace desert_sim

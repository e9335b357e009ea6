#include "src/ros/conversion/grid_map_message.hpp"

#include <algorithm>
#include <utility>

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

/// A map without layers, with its south-west corner at (west, south).
GridMap empty_map(const TerrainState& state, const std::string& frame, double resolution, int along_x,
                  int along_y, double west, double south) {
  GridMap map;
  map.info.header = header_of(state.moment, frame);
  map.info.resolution = resolution;
  map.info.length_x = along_x * resolution;
  map.info.length_y = along_y * resolution;
  map.info.pose.position.x = west + 0.5 * map.info.length_x;
  map.info.pose.position.y = south + 0.5 * map.info.length_y;
  map.info.pose.orientation.w = 1;
  return map;
}

/// `values`: row-major from the south-west, `along_x` in a row.
void add_layer(GridMap& map, const MapLayer& layer, std::vector<float> values, int along_x) {
  const auto rows = static_cast<std::uint32_t>(along_x),
             columns = static_cast<std::uint32_t>(values.size()) / rows;
  map.layers.emplace_back(layer.name);
  if (layer.layer == Layer::elevation) map.basic_layers.emplace_back(layer.name);
  map.data.emplace_back();
  map.data.back().layout.dim = {dimension("column_index", columns, rows * columns),
                                dimension("row_index", rows, rows)};
  // A GridMap counts rows from the largest x and columns from the largest y, with rows as the inner index:
  // this is the order of a snapshot, reversed.
  std::reverse(values.begin(), values.end());
  map.data.back().data = std::move(values);
}

/// With micro-relief on the elevation.
std::vector<float> fine_values(const Snapshot& s, const MapLayer& layer, const MicroReliefWindow& window) {
  return layer.layer == Layer::elevation ? MicroRelief(s).elevations(window)
                                         : nearest_values(s, layer, window);
}

/// A submap without layers, with its south-west corner at (west, south).
TerrainSubmap empty_submap(const TerrainState& state, const std::string& frame, double cell_size, int width,
                           int height, double west, double south) {
  TerrainSubmap map;
  map.header = header_of(state.moment, frame);
  map.step = state.snapshot->step;
  map.sim_time = state.snapshot->time;
  map.width = static_cast<std::uint32_t>(width);
  map.height = static_cast<std::uint32_t>(height);
  map.cell_size = cell_size;
  map.origin = origin_of(*state.snapshot);
  map.origin.position.x = west;
  map.origin.position.y = south;
  return map;
}

void add_layer(TerrainSubmap& map, const MapLayer& layer, std::vector<float> values) {
  map.layers.emplace_back();
  map.layers.back().name = layer.name;
  map.layers.back().unit = info(layer.layer).unit;
  map.layers.back().data = std::move(values);
}

}  // namespace

GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MapWindow& window, int decimation) {
  const Snapshot& s = *state.snapshot;
  const int along_x = (window.width + decimation - 1) / decimation,
            along_y = (window.height + decimation - 1) / decimation;
  GridMap map = empty_map(state, frame, s.cell_size * decimation, along_x, along_y,
                          s.origin_x + window.x0 * s.cell_size, s.origin_y + window.y0 * s.cell_size);
  for (const MapLayer& layer : layers)
    add_layer(map, layer, window_values(s, layer, window, decimation), along_x);
  return map;
}

GridMap grid_map(const TerrainState& state, const std::string& frame, const std::vector<MapLayer>& layers,
                 const MicroReliefWindow& window) {
  GridMap map = empty_map(state, frame, window.resolution, window.columns, window.rows, window.x0, window.y0);
  for (const MapLayer& layer : layers)
    add_layer(map, layer, fine_values(*state.snapshot, layer, window), window.columns);
  return map;
}

TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MapWindow& window) {
  const Snapshot& s = *state.snapshot;
  TerrainSubmap map =
      empty_submap(state, frame, s.cell_size, window.width, window.height,
                   s.origin_x + window.x0 * s.cell_size, s.origin_y + window.y0 * s.cell_size);
  for (const MapLayer& layer : layers) add_layer(map, layer, window_values(s, layer, window));
  return map;
}

TerrainSubmap terrain_submap(const TerrainState& state, const std::string& frame,
                             const std::vector<MapLayer>& layers, const MicroReliefWindow& window) {
  TerrainSubmap map =
      empty_submap(state, frame, window.resolution, window.columns, window.rows, window.x0, window.y0);
  for (const MapLayer& layer : layers) add_layer(map, layer, fine_values(*state.snapshot, layer, window));
  return map;
}

}  // namespace desert_sim

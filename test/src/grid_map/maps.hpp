#pragma once
/// GridMaps as somebody else might record them.

#include <functional>
#include <string>
#include <vector>

#include "src/grid_map/grid_map_bag.hpp"

namespace desert_sim::test {

using Value = std::function<double(int x, int y)>;

/// A layer of cells counted from the south-west, kept in a circular buffer that starts at (outer, inner).
inline void add_layer(GridMap& map, const std::string& name, const Value& value) {
  const int rows = static_cast<int>(map.info.length_x / map.info.resolution + 0.5),
            columns = static_cast<int>(map.info.length_y / map.info.resolution + 0.5);
  std_msgs::Float32MultiArray layer;
  layer.layout.dim.resize(2);
  layer.layout.dim[0].label = "column_index";
  layer.layout.dim[0].size = static_cast<std::uint32_t>(columns);
  layer.layout.dim[0].stride = static_cast<std::uint32_t>(rows * columns);
  layer.layout.dim[1].label = "row_index";
  layer.layout.dim[1].size = layer.layout.dim[1].stride = static_cast<std::uint32_t>(rows);
  layer.data.resize(static_cast<std::size_t>(rows * columns));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int in_row = (row + map.outer_start_index) % rows,
                in_column = (column + map.inner_start_index) % columns;
      layer.data[static_cast<std::size_t>(in_column * rows + in_row)] =
          static_cast<float>(value(rows - 1 - row, columns - 1 - column));
    }
  map.layers.push_back(name);
  map.data.push_back(layer);
}

/// width x height cells of half a metre around (20, -30), without layers.
inline GridMap an_empty_map(int width, int height) {
  GridMap map;
  map.info.header.frame_id = "odom";
  map.info.header.stamp = ros::Time(1600000000, 5);
  map.info.resolution = 0.5;
  map.info.length_x = 0.5 * width;
  map.info.length_y = 0.5 * height;
  map.info.pose.position.x = 20;
  map.info.pose.position.y = -30;
  map.info.pose.orientation.w = 1;
  return map;
}

/// Of 5 x 4 cells, with one layer in which no two cells are alike.
inline GridMap a_map(const std::string& layer = "elevation") {
  GridMap map = an_empty_map(5, 4);
  map.basic_layers = {layer};
  add_layer(map, layer, [](int x, int y) { return 100 + x + 10 * y; });
  return map;
}

}  // namespace desert_sim::test

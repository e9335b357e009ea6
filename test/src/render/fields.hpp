#pragma once
/// Grids of heights, and cameras that look at them, for tests of src/render.

#include <cmath>
#include <functional>
#include <limits>

#include "src/render/terrain_block.hpp"

namespace render_test {

using namespace desert_sim::render;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

using Height = std::function<float(int x, int y)>;

inline CellWindow window_of(const CellRectangle& cells, const Height& height) {
  std::vector<float> values;
  for (int y = cells.y; y < cells.top(); ++y)
    for (int x = cells.x; x < cells.right(); ++x) values.push_back(height(x, y));
  return {cells, values};
}

/// Dunes that no level of detail draws exactly.
inline float dunes(int x, int y) {
  return 5 * std::sin(0.31f * static_cast<float>(x)) + 3 * std::cos(0.23f * static_cast<float>(y));
}

inline Mesh block_of(const BlockLayout& layout, int block, int level, const Height& height,
                     double cell_size = 1) {
  return build_block(layout, block, level, cell_size, window_of(layout.needed_cells(block, level), height),
                     [](int, int, float, float, float) {
                       return pack({1, 1, 1});
                     });
}

/// The product of a rotation and a translation of a camera that is at (x, y, z), looks down (pitch -90°) or
/// to the horizon in the north (0°).
inline Eigen::Matrix4d camera_at(double x, double y, double z, double pitch_deg) {
  const double pitch = pitch_deg * 3.14159265358979 / 180, c = std::cos(pitch), s = std::sin(pitch);
  // Rows: right (east), up, backwards.
  Eigen::Matrix4d turn, move;
  turn << 1, 0, 0, 0, 0, -s, c, 0, 0, -c, -s, 0, 0, 0, 0, 1;
  move << 1, 0, 0, -x, 0, 1, 0, -y, 0, 0, 1, -z, 0, 0, 0, 1;
  return turn * move;
}

/// A field of view of 90° upwards and sideways.
inline Eigen::Matrix4d perspective(double near = 0.1, double far = 1e5) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.bottomRightCorner<2, 2>() << -(far + near) / (far - near), -2 * far * near / (far - near), -1, 0;
  return m;
}

/// So many metres from the lower to the upper edge of the picture.
inline Eigen::Matrix4d orthographic(double metres, double near = -1e5, double far = 1e5) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<2, 2>() *= 2 / metres;
  m.row(2) << 0, 0, -2 / (far - near), -(far + near) / (far - near);
  return m;
}

inline std::vector<Box> flat_boxes(const BlockLayout& layout, double cell_size) {
  std::vector<Box> boxes;
  for (int block = 0; block < layout.count(); ++block) {
    const CellRectangle r = layout.vertices(block);
    boxes.emplace_back(Point(r.x * cell_size, r.y * cell_size, 0),
                       Point(r.right() * cell_size, r.top() * cell_size, 1));
  }
  return boxes;
}

}  // namespace render_test

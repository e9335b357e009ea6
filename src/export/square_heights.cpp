#include "src/export/square_heights.hpp"

#include <algorithm>

namespace desert_sim {

namespace {

constexpr int least_side = 33;  // what OGRE, which draws for Gazebo, makes a terrain of

int side_for(int cells) {
  int side = least_side;
  while (side < cells) side = 2 * (side - 1) + 1;
  return side;
}

/// How many points lie west, or south, of the terrain.
int margin(int side, int cells) { return (side - cells) / 2; }

/// The cells at the points along an axis.
std::vector<std::size_t> cells_along(int side, int count, bool periodic) {
  std::vector<std::size_t> cells;
  cells.reserve(static_cast<std::size_t>(side));
  for (int point = 0; point < side; ++point) {
    const int cell = point - margin(side, count);
    cells.push_back(
        static_cast<std::size_t>(periodic ? (cell % count + count) % count : std::clamp(cell, 0, count - 1)));
  }
  return cells;
}

/// The middle of the side along an axis on which the terrain begins at `origin` [m].
double middle(double origin, double cell_size, int side, int count) {
  return origin + cell_size * (0.5 - margin(side, count) + 0.5 * (side - 1));
}

}  // namespace

Square::Square(const Snapshot& s)
    : side_(side_for(std::max(s.width, s.height))),
      width_(static_cast<std::size_t>(s.width)),
      cell_size_(s.cell_size),
      middle_x_(middle(s.origin_x, s.cell_size, side_, s.width)),
      middle_y_(middle(s.origin_y, s.cell_size, side_, s.height)),
      columns_(cells_along(side_, s.width, s.periodic_x)),
      rows_(cells_along(side_, s.height, s.periodic_y)) {}

}  // namespace desert_sim

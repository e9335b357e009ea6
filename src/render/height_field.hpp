#pragma once
/// The heights of a grid as a surface. Places are relative to the south-west corner of the grid [m].

#include <functional>

#include "src/render/view.hpp"

namespace desert_sim::render {

/// A place on the map.
struct Place {
  double x = 0, y = 0;
};

double distance(const Place& a, const Place& b);

struct HeightField {
  int width = 0, height = 0;  ///< [cells]
  double cell_size = 1;       ///< [m]
  /// The height at the centre of a cell of the grid [m]; NaN if unknown.
  std::function<float(int x, int y)> at;

  bool empty() const { return width <= 0 || height <= 0; }
  /// The height at a place [m]: interpolated bilinearly between the centres of cells, and constant beyond the
  /// outermost ones. NaN outside the grid, and where an interpolated cell is unknown.
  double height_at(const Place& place) const;
};

}  // namespace desert_sim::render

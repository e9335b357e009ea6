#pragma once
/// Differences of heights of the surface, for the laws of traversability.hpp.

#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim::traversability {

/// Moves a place beyond a periodic edge to where it lies on the grid; false beyond an open one.
DESERT_HD bool move_onto(const Grid& g, int& x, int& y) {
  if (g.periodic_x) x = wrap(x, g.width);
  if (g.periodic_y) y = wrap(y, g.height);
  return g.inside(x, y);
}

/// Differences of heights [quanta]. They are exact integers, whose sums do not depend on the order, so that
/// mirrored or rotated terrain gives the same bits.
struct Surface {
  Grid grid;
  const Quanta* elevation;
  float quantum;

  /// Height of the neighbour (x, y) above cell i; returns false where the grid ends.
  DESERT_HD bool rise(int i, int x, int y, Quanta& quanta) const {
    const int j = neighbour_index(grid, x, y);
    if (j < 0) return false;
    quanta = elevation[j] - elevation[i];
    return true;
  }
  /// Central difference [m per cell], one-sided where the grid ends; 0 on an axis of a single cell.
  DESERT_HD float central(int x, int y, int dx, int dy) const {
    const int i = grid.index(x, y);
    Quanta ahead = 0, behind = 0;
    const int sides = rise(i, x + dx, y + dy, ahead) + rise(i, x - dx, y - dy, behind);
    return sides == 0 ? 0.0f : (static_cast<float>(ahead) - static_cast<float>(behind)) * quantum / sides;
  }
  /// The flatter of the two one-sided differences [m per cell], 0 where their signs differ (minmod).
  DESERT_HD float minmod_difference(int x, int y, int dx, int dy) const {
    const int i = grid.index(x, y);
    Quanta ahead = 0, back = 0;
    const bool has_ahead = rise(i, x + dx, y + dy, ahead), has_back = rise(i, x - dx, y - dy, back);
    const float a = ahead * quantum, b = -(back * quantum);
    if (!has_ahead || !has_back) return has_ahead ? a : (has_back ? b : 0.0f);
    if (a > 0.0f && b > 0.0f) return minimum(a, b);
    return a < 0.0f && b < 0.0f ? maximum(a, b) : 0.0f;
  }
  /// Tangent of the slope.
  DESERT_HD float steepness(int x, int y) const {
    return hypotenuse(central(x, y, 1, 0), central(x, y, 0, 1)) / grid.cell_size;
  }
};

}  // namespace desert_sim::traversability

#pragma once
/// The grid of cells: its shape, its boundaries and index arithmetic.

#include "kernels/base/macros.hpp"

namespace desert_sim {

/// Largest number of cells of a grid. Indices are ints, also those of rows by which a tile or a brush reaches
/// beyond the grid: this leaves room for 64 rows of the widest grid, which has 65536 cells a row.
constexpr long long max_grid_cells = (1LL << 31) - (1LL << 22);

/// A grid of `width` × `height` square cells of `cell_size` metres, row-major, x (east) fastest, row 0 in the
/// south. An axis is either periodic (the last cell's neighbour is the first) or open (nothing lies beyond
/// the edge).
struct Grid {
  int width = 0, height = 0;
  float cell_size = 1;
  bool periodic_x = true, periodic_y = true;

  DESERT_HD int cells() const { return width * height; }
  DESERT_HD int index(int x, int y) const { return y * width + x; }
  DESERT_HD bool inside(int x, int y) const {
    return static_cast<unsigned>(x) < static_cast<unsigned>(width) &&
           static_cast<unsigned>(y) < static_cast<unsigned>(height);
  }
  DESERT_HD bool periodic() const { return periodic_x && periodic_y; }
};

/// i modulo n in 0…n−1; fast if it already is.
DESERT_HD int wrap(int i, int n) {
  if (static_cast<unsigned>(i) < static_cast<unsigned>(n)) return i;
  i %= n;
  return i < 0 ? i + n : i;
}

/// The same for −n ≤ i < 2n, without division or branch.
DESERT_HD int wrap_once(int i, int n) {
  return i + (n & -static_cast<int>(i < 0)) - (n & -static_cast<int>(i >= n));
}

DESERT_HD int clamp_index(int i, int n) { return i < 0 ? 0 : (i >= n ? n - 1 : i); }

/// Index of the cell whose value stands for (x, y): wrapped on a periodic axis, clamped to the edge (zero
/// gradient) on an open one.
DESERT_HD int sample_index(const Grid& g, int x, int y) {
  x = g.periodic_x ? wrap(x, g.width) : clamp_index(x, g.width);
  y = g.periodic_y ? wrap(y, g.height) : clamp_index(y, g.height);
  return g.index(x, y);
}

/// Index of a neighbour for a flux, or −1 beyond an open edge.
DESERT_HD int neighbour_index(const Grid& g, int x, int y) {
  if (g.periodic_x) x = wrap(x, g.width);
  if (g.periodic_y) y = wrap(y, g.height);
  return g.inside(x, y) ? g.index(x, y) : -1;
}

/// The eight neighbours, the four straight ones first, opposite ones next to each other. Sums over them are
/// formed as
///
///   ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7))
///
/// which is the same to the bit for a mirrored terrain and for one that is turned by 90 degrees.
struct Neighbours {
  static constexpr int count = 8;
  DESERT_HD static constexpr int dx(int k) {
    return k == 0 || k == 4 || k == 7 ? 1 : (k == 1 || k == 5 || k == 6 ? -1 : 0);
  }
  DESERT_HD static constexpr int dy(int k) {
    return k == 2 || k == 4 || k == 6 ? 1 : (k == 3 || k == 5 || k == 7 ? -1 : 0);
  }
  /// Distance of the centres [cells].
  DESERT_HD static constexpr float distance(int k) { return k < 4 ? 1.0f : 1.41421356f; }
  DESERT_HD static float sum(const float (&v)[8]) {
    return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
  }
};

/// Index of the kth neighbour of a cell, or −1 beyond an open edge; `inside`: none lies over an edge.
template <bool inside>
DESERT_HD int neighbour(const Grid& g, int x, int y, int k) {
  const int at_x = x + Neighbours::dx(k), at_y = y + Neighbours::dy(k);
  return inside ? g.index(at_x, at_y) : neighbour_index(g, at_x, at_y);
}

}  // namespace desert_sim

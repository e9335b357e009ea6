#pragma once
/// The micro-relief at the points of a window. Patches of ripples and bumps are computed once for all
/// points; they are those of Relief::offset(), so that both give the same bits.

#include <cstddef>

#include "kernels/micro_relief/relief.hpp"

namespace desert_sim::micro_relief {

/// Points in rows from the south-west. Point (i, j) is at (west + i step, south + j step).
struct Points {
  double west = 0, south = 0, step = 1;  ///< [m] from the terrain's south-west corner
  int columns = 1, rows = 1;

  DESERT_HD double x(int i) const { return rounded(west + i * step); }
  DESERT_HD double y(int j) const { return rounded(south + j * step); }
};

/// The squares of a lattice that points may ask for, row-major in memory of the device. On a periodic terrain
/// a window may go around it, even more than once.
struct SquareTable {
  Axis x, y;
  int first_column = 0, first_row = 0, columns = 0, rows = 0;

  SquareTable(const Lattice& lattice, const Points& points);
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  DESERT_HD int index(int i, int j) const {
    return along(j - first_row, y) * columns + along(i - first_column, x);
  }

 private:
  DESERT_HD static int along(int n, const Axis& axis) { return axis.periodic ? wrap(n, axis.count) : n; }
};

/// Writes the offsets [m] at the points, row-major. `patches` and `bumps`: memory for as many as the tables
/// of the lattices of ripples and bumps have squares. All pointers, those of `relief` too, are the device's.
template <class E>
void offsets(E& exec, const Relief& relief, const Points& points, RipplePatch* patches, Bump* bumps,
             float* to);

}  // namespace desert_sim::micro_relief

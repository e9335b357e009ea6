#pragma once
/// The micro-relief at the points of a window, or at those that beams meet. Patches of ripples and bumps are
/// computed once for all points; they are those of Relief::offset(), so that both give the same bits.

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

/// Squares of a lattice, row-major in memory of the device.
struct SquareBox {
  int first_column = 0, first_row = 0, columns = 0, rows = 0;

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  /// −1: it is not among them.
  DESERT_HD int find(int i, int j) const {
    const int column = i - first_column, row = j - first_row;
    const bool inside = static_cast<unsigned>(column) < static_cast<unsigned>(columns) &&
                        static_cast<unsigned>(row) < static_cast<unsigned>(rows);
    return inside ? row * columns + column : -1;
  }
};

/// The squares that points may ask for. On a periodic terrain a window may go around it, even more than once.
struct SquareTable : SquareBox {
  Axis x, y;

  SquareTable(const Lattice& lattice, const Points& points);
  DESERT_HD int index(int i, int j) const {
    return along(j - first_row, y) * columns + along(i - first_column, x);
  }

 private:
  DESERT_HD static int along(int n, const Axis& axis) { return axis.periodic ? wrap(n, axis.count) : n; }
};

/// Some patches and bumps, from which others are computed where they are needed.
struct KnownSquares {
  SquareBox patch_box, bump_box;
  const RipplePatch* patches = nullptr;
  const Bump* bumps = nullptr;

  /// Relief::offset().
  DESERT_HD float offset(const Relief& relief, double x, double y) const {
    return relief.offset(
        x, y,
        [&](int i, int j) {
          const int n = patch_box.find(i, j);
          return n >= 0 ? patches[n] : relief.patch(i, j);
        },
        [&](int i, int j) {
          const int n = bump_box.find(i, j);
          return n >= 0 ? bumps[n] : relief.bump(i, j);
        });
  }
};

/// Computes the patches and bumps of boxes, which may be empty. Squares beyond an edge have those that
/// Relief::offset() takes there.
template <class E>
void fill_squares(E& exec, const Relief& relief, const SquareBox& patch_box, RipplePatch* patches,
                  const SquareBox& bump_box, Bump* bumps);

/// Writes the offsets [m] at the points, row-major. `patches` and `bumps`: memory for as many as the tables
/// of the lattices of ripples and bumps have squares. All pointers, those of `relief` too, are the device's.
template <class E>
void offsets(E& exec, const Relief& relief, const Points& points, RipplePatch* patches, Bump* bumps,
             float* to);

}  // namespace desert_sim::micro_relief

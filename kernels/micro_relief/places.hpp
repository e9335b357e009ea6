#pragma once
/// Places on a terrain: among its cells, and among the squares of a lattice over it. Coordinates are metres
/// from the terrain's south-west corner, in double precision, rounded to 2⁻²⁰ m first: a place is then the
/// same to the bit whatever window it is a point of.

#include <algorithm>
#include <cmath>

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"

namespace desert_sim::micro_relief {

/// Rounded to 2⁻²⁰ m.
DESERT_HD double rounded(double metres) { return floor(metres * 1048576.0 + 0.5) * (1.0 / 1048576.0); }

/// An axis that is divided into `count` equal parts.
struct Axis {
  int count = 1;
  double parts_per_metre = 1;
  bool periodic = false;

  /// A coordinate [parts], within the first period if there are periods.
  DESERT_HD double parts(double metres) const {
    const double p = metres * parts_per_metre;
    return periodic ? p - count * floor(p / count) : p;
  }
  /// The part of this number on a ring, or the nearest one there is. n lies −count … 2 count − 1 on a ring.
  DESERT_HD int part(int n) const {
    if (!periodic) return n < 0 ? 0 : n >= count ? count - 1 : n;
    return n < 0 ? n + count : n >= count ? n - count : n;
  }
};

/// Layers of the cells, as floats in rows from `first_row` on; rows of a periodic terrain go on over its
/// north edge. Values are bilinear between the centres of cells and constant beyond the outermost, as for
/// wheels.
struct Cells {
  Axis x, y;  ///< of the whole terrain
  int first_row = 0, rows = 0;
  const float* sand = nullptr;    ///< depth [m]
  const float* mobile = nullptr;  ///< 1 where the wind moves sand … 0 in its shadow, in water, on obstacles
  const float* level = nullptr;   ///< 1 on gentle slopes … 0 at the angle of repose
  const float* growth = nullptr;  ///< density of plants
  const float* stones = nullptr;  ///< 1 where an obstacle stands
  const float* turn_x = nullptr;  ///< the wind at the surface over that high above, as a complex number
  const float* turn_y = nullptr;

  /// The four cells around a place, and its share of the way between them.
  struct Corners {
    int south_west, south_east, north_west, north_east;
    float east, north;
  };
  DESERT_HD Corners corners(double metres_x, double metres_y) const {
    const double a = x.parts(metres_x) - 0.5, b = y.parts(metres_y) - 0.5;
    const double west = floor(a), south = floor(b);
    const int i = static_cast<int>(west), j = static_cast<int>(south);
    const int i0 = x.part(i), i1 = x.part(i + 1), j0 = row(j) * x.count, j1 = row(j + 1) * x.count;
    return {j0 + i0, j0 + i1, j1 + i0, j1 + i1, static_cast<float>(a - west), static_cast<float>(b - south)};
  }
  DESERT_HD float value(const float* layer, const Corners& c) const {
    return lerp(lerp(layer[c.south_west], layer[c.south_east], c.east),
                lerp(layer[c.north_west], layer[c.north_east], c.east), c.north);
  }

 private:
  DESERT_HD int row(int n) const {
    const int r = y.part(n) - first_row, around = r < 0 && y.periodic ? r + y.count : r;
    return around < 0 ? 0 : around >= rows ? rows - 1 : around;
  }
};

/// A lattice of squares, in each of which one thing has its place. A place meets only those of the nine
/// squares around it.
struct Lattice {
  Axis x, y;
  float pitch_x = 1, pitch_y = 1;  ///< side of a square [m]

  Lattice() = default;
  /// Squares of about `pitch` metres that divide the terrain, at least three along a side.
  Lattice(double length_x, double length_y, double pitch, bool periodic_x, bool periodic_y)
      : x(axis(length_x, pitch, periodic_x)),
        y(axis(length_y, pitch, periodic_y)),
        pitch_x(static_cast<float>(1 / x.parts_per_metre)),
        pitch_y(static_cast<float>(1 / y.parts_per_metre)) {}

  struct Square {
    int i, j;
    float east, north;  ///< where in it, 0 … 1
  };
  DESERT_HD Square square(double metres_x, double metres_y) const {
    const double a = x.parts(metres_x), b = y.parts(metres_y), west = floor(a), south = floor(b);
    return {static_cast<int>(west), static_cast<int>(south), static_cast<float>(a - west),
            static_cast<float>(b - south)};
  }
  /// The number of a square next to one on the terrain, or to one beyond an open edge.
  DESERT_HD int column(int i) const { return x.periodic ? x.part(i) : i; }
  DESERT_HD int row(int j) const { return y.periodic ? y.part(j) : j; }
  /// The same of any square, however many periods away.
  DESERT_HD int column_anywhere(int i) const { return x.periodic ? wrap(i, x.count) : i; }
  DESERT_HD int row_anywhere(int j) const { return y.periodic ? wrap(j, y.count) : j; }

 private:
  static Axis axis(double length, double pitch, bool periodic) {
    const int count = static_cast<int>(std::max(3.0, std::floor(length / pitch + 0.5)));
    return {count, count / length, periodic};
  }
};

}  // namespace desert_sim::micro_relief

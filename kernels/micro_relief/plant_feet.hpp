#pragma once
/// Where plants stand among the squares of the lattice of bumps (bumps.hpp): the widest plant of each square,
/// as one number. Its upper half is the plant's radius, as the bits of the float, its lower half where in the
/// square the plant stands, in 2⁻¹⁶ of a side; of equally wide ones the largest number counts. So the order
/// of plants does not matter, and 0 is a square without plants.

#include <cstddef>

#include "kernels/micro_relief/places.hpp"

namespace desert_sim::micro_relief {

using FootNumber = unsigned long long;  // for which CUDA has atomicMax()

struct Foot {
  float east, north;  ///< its place in its square, 0 … 1
  float radius;       ///< [m]

  DESERT_HD explicit Foot(FootNumber number)
      : east(share(static_cast<std::uint32_t>(number) & 0xffffu)),
        north(share(static_cast<std::uint32_t>(number) >> 16)),
        radius(float_from_bits(static_cast<std::uint32_t>(number >> 32))) {}
  DESERT_HD static FootNumber number(const Lattice::Square& at, float radius) {
    return FootNumber{bits_of(radius)} << 32 | part(at.north) << 16 | part(at.east);
  }

 private:
  DESERT_HD static float share(std::uint32_t part) {
    return (static_cast<float>(part) + 0.5f) * (1.0f / 65536.0f);
  }
  DESERT_HD static std::uint32_t part(float share) {
    return static_cast<std::uint32_t>(clamp(share * 65536.0f, 0.0f, 65535.0f));
  }
};

/// The widest plants of rows of squares, row-major from row `first_row` on, which go on over the north edge
/// of a periodic terrain. Squares of other rows count as bare.
struct Feet {
  const FootNumber* widest = nullptr;
  bool live = false;  ///< whether plants live; if not, the density of the layer says where they stand
  int columns = 0, first_row = 0, rows = 0;

  /// Of a square that Lattice::column() and row() number.
  DESERT_HD FootNumber at(const Lattice& lattice, int i, int j) const {
    const int from = j - first_row, row = from < 0 && lattice.y.periodic ? from + lattice.y.count : from;
    if (row < 0 || row >= rows || i < 0 || i >= columns) return 0;
    return widest[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(i)];
  }
};

/// Plants one by one.
struct Plants {
  const float *x, *y;   ///< [m] from the terrain's south-west corner
  const float* radius;  ///< [m]
  int count;
};

/// Finds the widest plants of rows first_row … first_row + rows − 1. Plants off the terrain, and without a
/// radius above 0, do not count. All pointers are the device's; `widest` has room for the squares of the
/// rows.
template <class E>
void find_feet(E& exec, const Lattice& lattice, const Plants& plants, int first_row, int rows,
               FootNumber* widest);

}  // namespace desert_sim::micro_relief

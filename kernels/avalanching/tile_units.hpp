#pragma once
/// Heights inside a tile, as floats whose own rounding is the law's. In [1, 2) neighbouring floats are 2⁻²³
/// apart; that is the unit in which sand slides there. A height less an amount is then rounded to whole units
/// by the subtraction itself, and sums and differences of whole units are exact: a sweep needs no conversion,
/// and loses nothing. Between integers and such floats lies one addition to the bits.
///
/// A unit is a power of two of quanta, at most 2⁻¹⁵ cell sizes, or 2⁻²² of the tile's relief where that is
/// more (relief of more than 128 cell sizes within 32 cells). What is below a unit stays where it is.

#include "kernels/field/grid.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim::avalanching {

struct Units {
  static constexpr float floor = 1.0f, unit = 1.0f / 8388608.0f;
  /// The highest cell stands less than this over the lowest; sand that slides never leaves what lies between.
  static constexpr int relief = 8388608;
  /// The height of walls, out of reach from below; the top of their ground; and a drop at repose that nothing
  /// exceeds.
  static constexpr float wall = 4.0f;

  Quanta lowest;  ///< of the tile's cells but walls
  int shift;      ///< log₂ of the quanta in a unit

  /// `quanta_per_cell`: cell size / quantum.
  DESERT_HD Units(Quanta lowest_height, Quanta highest_height, float quanta_per_cell)
      : lowest(lowest_height) {
    const int exponent = static_cast<int>(bits_of(quanta_per_cell) >> 23) - 127 - 15;
    shift = exponent > 0 ? exponent : 0;
    while ((highest_height - lowest_height) >> shift >= relief) ++shift;
  }

  DESERT_HD float height(Quanta h) const {
    return float_of(bits_of(floor) +
                    ((static_cast<std::uint32_t>(h) - static_cast<std::uint32_t>(lowest)) >> shift));
  }
  /// The top of the ground below the sand; or the lowest cell, if that is higher: no cell falls below it.
  DESERT_HD float ground(Quanta h, Quanta sand) const {
    const Quanta units = ((h - lowest) >> shift) - (sand >> shift);
    return float_of(bits_of(floor) + static_cast<std::uint32_t>(units > 0 ? units : 0));
  }
  /// Drop over one cell at repose; from 1 on nothing slides.
  DESERT_HD float drop(float repose, float quanta_per_cell) const {
    const float scale = float_of(static_cast<std::uint32_t>(127 - 23 - shift) << 23);  // 2^(−23 − shift)
    return lower(repose * (quanta_per_cell * scale), floor);
  }
  /// A cell's sand less this of its height [quanta] stays as it is: modulo 2³², as all sums of Quanta here.
  DESERT_HD Quanta of_height(float height) const { return static_cast<Quanta>(bits_of(height) << shift); }
};

}  // namespace desert_sim::avalanching

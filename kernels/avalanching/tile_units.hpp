#pragma once
/// Heights inside a tile as fixed-point numbers in the mantissas of floats. Neighbouring floats in [1, 2) are
/// 2⁻²³ apart, and that is the unit in which sand slides. Subtracting an amount from a height thus rounds to
/// whole units by itself, and sums and differences of whole units are exact: a sweep needs no conversions and
/// loses no sand. The conversion from and to integers is one addition to the float's bits.
///
/// A unit is a power of two of quanta: at most 2⁻¹⁵ cell sizes, or 2⁻²² of the tile's relief where that is
/// more (where the relief within 32 cells exceeds 128 cell sizes). The part of a height below one unit stays
/// where it is.

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"

namespace desert_sim::avalanching {

struct Units {
  static constexpr float floor = 1.0f, unit = 1.0f / 8388608.0f;
  /// The highest cell stands less than this many units above the lowest; sand that slides never leaves that
  /// range.
  static constexpr int relief = 8388608;
  /// Height of a wall, out of reach from below. Also stands for the top of its ground, and for a drop at
  /// repose that nothing exceeds.
  static constexpr float wall = 4.0f;

  Quanta lowest;  ///< lowest height of the tile's cells that are not walls
  int shift;      ///< log₂ of the quanta in a unit

  /// `quanta_per_cell`: cell size / quantum.
  DESERT_HD Units(Quanta lowest_height, Quanta highest_height, float quanta_per_cell)
      : lowest(lowest_height) {
    const int exponent = static_cast<int>(bits_of(quanta_per_cell) >> 23) - 127 - 15;
    shift = exponent > 0 ? exponent : 0;
    while ((highest_height - lowest_height) >> shift >= relief) ++shift;
  }

  DESERT_HD float height(Quanta h) const {
    return float_from_bits(bits_of(floor) +
                           ((static_cast<std::uint32_t>(h) - static_cast<std::uint32_t>(lowest)) >> shift));
  }
  /// The top of the ground below the sand; at most half a relief below the lowest cell. Down there floats lie
  /// half a unit apart.
  DESERT_HD float ground(Quanta h, Quanta sand) const {
    const Quanta units = ((h - lowest) >> shift) - (sand >> shift);
    const Quanta below = units > -relief / 2 ? 2 * units : -relief;
    return float_from_bits(bits_of(floor) + static_cast<std::uint32_t>(units > 0 ? units : below));
  }
  /// Drop at repose over one cell. With 1 or more nothing slides, so it is limited to that.
  DESERT_HD float drop(float repose, float quanta_per_cell) const {
    const float scale =
        float_from_bits(static_cast<std::uint32_t>(127 - 23 - shift) << 23);  // 2^(−23 − shift)
    return fast_min(repose * (quanta_per_cell * scale), floor);
  }
  /// The quanta that a height stands for. A cell's sand minus this value does not change while sand slides.
  /// It is computed modulo 2³², and as large as that for a wall.
  DESERT_HD Quanta of_height(float height) const { return static_cast<Quanta>(bits_of(height) << shift); }
};

}  // namespace desert_sim::avalanching

#pragma once
/// Heights inside a tile, as floats whose own rounding is the law's. In [1, 2) neighbouring floats are 2⁻²³
/// apart; that is the unit in which sand slides there. A height less a product is then rounded to whole units
/// by the fused multiply-add itself, and sums and differences of whole units are exact whatever their order:
/// a sweep needs no conversion, and loses nothing. Between integers and such floats lies one addition to the
/// bits.
///
/// A unit is a power of two of quanta, at most 2⁻¹⁵ cell sizes, or 2⁻²¹ of the tile's relief where that is
/// more (relief of more than 64 cell sizes within 32 cells). What is below a unit stays where it is, and so
/// does a film of up to four units, the most by which rounding to nearest could take too much from a cell.

#include <type_traits>

#include "desert_sim/kernels/grid.hpp"
#include "desert_sim/kernels/math.hpp"
#include "desert_sim/kernels/quanta.hpp"

namespace desert_sim::avalanching {

/// Sweeps that a tile may take before it is stored: what follows bounds how far heights can rise.
constexpr int most_sweeps = 8;

struct Units {
  static constexpr float floor = 1.0f, unit = 1.0f / 8388608.0f;
  static constexpr int per_one = 8388608;
  /// The lowest cell stands so many units over `floor`: rounding digs four units at most a sweep below it.
  static constexpr int margin = 64;
  static_assert(margin >= 4 * most_sweeps);
  /// No cell gives more in a sweep: 1 to 2 cell sizes, or more where the relief needs coarser units.
  static constexpr float most_given = 1.0f / 128.0f;
  /// The highest cell stands less than this over the lowest. Eight neighbours add most_given and half a unit
  /// each a sweep, so that no cell reaches 2.
  static constexpr int relief = per_one / 2 - 128;
  static_assert(relief + margin + 8 * most_sweeps * (per_one / 128) + 4 * most_sweeps < per_one);
  static constexpr int film = 4;
  /// Walls are out of reach from below and have less than no sand.
  static constexpr float wall = 4.0f, wall_ground = 8.0f;

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
    return float_of(bits_of(floor) + static_cast<std::uint32_t>(margin + ((h - lowest) >> shift)));
  }
  /// Of deep sand counts what eight sweeps can take.
  DESERT_HD float depth_over_film(Quanta sand) const {
    const Quanta units = sand >> shift, most = per_one / 2;
    const float one_and = float_of(bits_of(floor) + static_cast<std::uint32_t>(units < most ? units : most));
    return one_and - (floor + film * unit);  // exact, and without a conversion
  }
  /// Drop over one cell at repose; from 1 on nothing slides.
  DESERT_HD float drop(float repose, float quanta_per_cell) const {
    const float scale = float_of(static_cast<std::uint32_t>(127 - 23 - shift) << 23);  // 2^(−23 − shift)
    return lower(repose * (quanta_per_cell * scale), floor);
  }
  /// What a cell has gained [quanta].
  DESERT_HD Quanta gain(float before, float after) const {
    return static_cast<Quanta>((bits_of(after) - bits_of(before)) << shift);  // modulo 2³²: may be negative
  }
};

/// 1/x, too low by up to 0.3 % and never too high: a guess from the exponent's bits, one step of Newton's.
DESERT_HD float reciprocal_below(float x) {
  const float guess = float_of(0x7EF311C7u - bits_of(x));
  return guess * fused(-x, guess, 2.0f);
}

/// Says that slides are not handed on; spares four instructions a cell and sweep.
struct NoOnward {};

/// What a cell gives to its neighbours in one sweep: shares of its excesses B in whole units (equations in
/// avalanching.hpp):
///
///   A = min(k_c min(B_max/(1 + B_max/B_sum) + o d, B_max), s)
///
/// with s the sand over the film, at most most_given; nothing, if no neighbour is lower by more than the drop
/// over which sand starts to slide. With o = 0 that is the equation, which reckons that what receivers get
/// stays there. On a slope it does not: each cell hands on half of what it gets, so that slides spread
/// instead of running down. So o lets a cell give more, by a share of the drop d at rest, up to all that is
/// too much; with o = ½ a cell and its only receiver end level at worst. The cell stays above the lowest
/// neighbour but for rounding (A ≤ B_max). Rounding to nearest takes at most ½ unit too much eight times:
/// hence the film.
struct Slide {
  float part[Neighbours::count];
  float left;  ///< the cell's height less all parts; exactly

  /// `around`: heights of the neighbours; `straight`, `diagonal`: the lowest of each four; `ground`: the
  /// film's top; `start`: the drop over one cell at which sand starts to slide, `rest` the share of it that a
  /// slide aims at; `onward`: o, or NoOnward for 0.
  template <class Onward>
  DESERT_HD Slide(float height, const float (&around)[Neighbours::count], float straight, float diagonal,
                  float ground, float start, float rest, float transfer, Onward onward) {
    const bool slides =
        higher(height - straight, (height - diagonal) * (1.0f / Neighbours::distance(4))) > start;
    // A product of the drop would be kept for each cell through all sweeps, and registers are few.
    const float top = fused(-rest, start, height),
                diagonal_top = fused(-Neighbours::distance(4) * rest, start, height);
    float b[Neighbours::count];
    Neighbours::unrolled(
        [&](auto k) DESERT_INLINE { b[k] = positive_part((k < 4 ? top : diagonal_top) - around[k]); });
    const float largest = higher(positive_part(top - straight), positive_part(diagonal_top - diagonal));
    const float sum = Neighbours::sum(b), both = sum + largest;
    const float sand = lower(positive_part(height - ground), Units::most_given);
    constexpr float tiny = 1e-30f;
    float amount = largest * sum;  // times `both`
    if constexpr (!std::is_same_v<Onward, NoOnward>)
      amount = lower(fused(onward * (rest * start), both, amount), largest * both);
    const float per_both = reciprocal_below(fused(sum, both, tiny));  // a branch around it costs a GPU more
    const float share = lower(transfer * amount, sand * both) * (slides ? per_both : 0.0f);
    left = height;
    Neighbours::unrolled([&](auto k) DESERT_INLINE {
      const float after = fused(-share, b[k], left);
      part[k] = left - after;
      left = after;
    });
  }
};

}  // namespace desert_sim::avalanching

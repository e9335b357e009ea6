#pragma once
/// How continuum.hpp shares sand between the places of a line: across the way of the undisturbed wind, which
/// meets the next line between two of them, and off it. Shares of whole quanta are whole, and what one place
/// gives another gets.

#include <cstdint>

#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"
#include "kernels/wind/downwind.hpp"

namespace desert_sim::continuum {

using wind::Downwind;

/// parts/2³² of an amount that is not negative, rounded down.
DESERT_HD Quanta share(Quanta of, std::uint32_t parts) {
  return static_cast<Quanta>(multiply_high(static_cast<std::uint32_t>(of), parts));
}

/// Shares of what comes to a place that are turned to its neighbours in the line: to the one after it, to the
/// one before it, or, from a ridge, to both.
struct Turn {
  std::uint32_t both;  ///< before << 16 | after [2⁻¹⁶]

  /// Of negative ones nothing is turned.
  DESERT_HD static Turn of(float after, float before) {
    constexpr float most = 65535.0f / 65536.0f;
    const float to_after = clamp(after, 0.0f, most), to_before = clamp(before, 0.0f, most - to_after);
    return {static_cast<std::uint32_t>(static_cast<int>(to_before * 65536.0f)) << 16 |
            static_cast<std::uint32_t>(static_cast<int>(to_after * 65536.0f))};
  }
  /// [cells]
  DESERT_HD float mean() const {
    return (static_cast<float>(static_cast<int>(both & 65535u)) -
            static_cast<float>(static_cast<int>(both >> 16))) /
           65536.0f;
  }
  DESERT_HD Quanta after(Quanta all) const { return share(all, both << 16); }
  DESERT_HD Quanta before(Quanta all) const { return share(all, both & 0xffff0000u); }
};

/// The way of the undisturbed wind from a line to the next: to a place and the one after it.
struct Drift {
  int cells;             ///< to the first of the two, from the cell's own place
  std::uint32_t beyond;  ///< share of the second one [2⁻³²]
  float share_beyond;    ///< [1]
  float per_slope;       ///< ½ f (1 − f), where f is share_beyond
  float shift;           ///< [cells a line], at most 1
  // Steps from a cell to the next place of its line, and to the next line [cells]. Kept as numbers: compilers
  // would make choices between loads of what Downwind says, and vectorise no loop with such a choice.
  int across_x, across_y, forward_x, forward_y;

  Drift(const Downwind& order, wind::Vector above)
      : shift(order.shift(above.x, above.y)),
        across_x(order.across_x()),
        across_y(order.across_y()),
        forward_x(order.forward_x()),
        forward_y(order.forward_y()) {
    const int fixed_point = to_fixed_point(shift);
    cells = fixed_point >> 16;
    beyond = static_cast<std::uint32_t>(fixed_point) << 16;
    share_beyond = fraction(fixed_point);
    per_slope = 0.5f * share_beyond * (1.0f - share_beyond);
  }
};

/// Of what a cell hands on, the part that goes to the second place, between what the cells before and after
/// it in the line hand on. It is that on the last share_beyond of the cell's width, over which the flux is
/// linear; van Leer 1977, with monotonized central slopes. A flux that is constant over a cell would spread
/// across the wind by ½ f (1 − f) cells² a line.
DESERT_HD Quanta to_second(const Drift& drift, Quanta before, Quanta here, Quanta after) {
  const float to_after = static_cast<float>(after - here), from_before = static_cast<float>(here - before);
  const float steepest = 2.0f * minimum(fabsf(to_after), fabsf(from_before));
  const float slope =
      to_after * from_before > 0.0f ? clamp(0.5f * (to_after + from_before), -steepest, steepest) : 0.0f;
  // Whole quanta that are right in the mean, in the same way for both places: low waves differ by a few.
  const std::uint32_t word = static_cast<std::uint32_t>(here) * 0x9e3779b1u +
                             static_cast<std::uint32_t>(after - before) * 0x85ebca77u;
  const float chance = static_cast<float>(static_cast<int>(word >> 8)) * (1.0f / 16777216.0f);
  const Quanta part =
      share(here, drift.beyond) + static_cast<Quanta>(floorf(drift.per_slope * slope + chance));
  return part < 0 ? 0 : part > here ? here : part;
}

}  // namespace desert_sim::continuum

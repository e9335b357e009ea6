#pragma once
/// The order in which a sweep visits the cells of a grid with the wind: line by line, along the axis to which
/// the wind is nearer. What a cell has to hand on goes to the next line, `shift` cells to the side, and is
/// shared between the two cells around that place.
///
///   shift = w_across / w_along     [cells a line; 16.16 fixed point]
///
/// Fields of a sweep lie line after line (slot), so that a line is contiguous whatever its direction.

#include <cmath>

#include "kernels/base/grid.hpp"
#include "kernels/base/math.hpp"
#include "kernels/base/quanta.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::wind {

struct Downwind {
  /// Winds that point further off the axis are taken as if they pointed by this much [cells a line]: 72°.
  static constexpr float largest_shift = 3.0f;

  Grid grid;
  bool along_x, backward;
  int first_slot, slot_x, slot_y;  ///< slot = first_slot + x · slot_x + y · slot_y

  Downwind(const Grid& g, Vector wind)
      : grid(g),
        along_x(std::fabs(wind.x) >= std::fabs(wind.y)),
        backward(along_x ? wind.x < 0 : wind.y < 0),
        first_slot(backward ? (lines() - 1) * length() : 0),
        slot_x(along_x ? (backward ? -length() : length()) : 1),
        slot_y(along_x ? 1 : (backward ? -length() : length())) {}

  DESERT_HD int lines() const { return along_x ? grid.width : grid.height; }
  DESERT_HD int length() const { return along_x ? grid.height : grid.width; }
  DESERT_HD bool periodic_along() const { return along_x ? grid.periodic_x : grid.periodic_y; }
  DESERT_HD bool periodic_across() const { return along_x ? grid.periodic_y : grid.periodic_x; }

  /// From a cell to the one at the next place of its line, and to the one at its place of the next line.
  DESERT_HD int across_x() const { return along_x ? 0 : 1; }
  DESERT_HD int across_y() const { return along_x ? 1 : 0; }
  DESERT_HD int forward_x() const { return along_x ? (backward ? -1 : 1) : 0; }
  DESERT_HD int forward_y() const { return along_x ? 0 : (backward ? -1 : 1); }

  DESERT_HD int line_of(int x, int y) const {
    const int along = along_x ? x : y;
    return backward ? lines() - 1 - along : along;
  }
  DESERT_HD int place_of(int x, int y) const { return along_x ? y : x; }
  DESERT_HD int slot(int x, int y) const { return first_slot + x * slot_x + y * slot_y; }
  /// A place of the line that lies within the grid: wrapped, or −1 beyond an open edge; at most three cells
  /// beyond the edges.
  DESERT_HD int place_within(int place) const {
    const int n = length();
    if (static_cast<unsigned>(place) < static_cast<unsigned>(n)) return place;
    // Without division, so that compilers vectorise the loops around, also for lines of one cell.
    return periodic_across() ? wrap_once(wrap_once(wrap_once(place, n), n), n) : -1;
  }

  /// How far a direction leads to the side from one line to the next [cells].
  DESERT_HD float shift(float x, float y) const {
    const float along = (along_x ? x : y) * (backward ? -1.0f : 1.0f), across = along_x ? y : x;
    const float size = fabsf(across);
    if (!(along * largest_shift > size))
      return across > 0.0f ? largest_shift : across < 0.0f ? -largest_shift : 0.0f;
    return across / along;
  }
  /// A flux of 1 along the axis and of `across` across it, as parts along x and y.
  DESERT_HD Vector parts(float along, float across) const {
    const float forward = backward ? -along : along;
    return along_x ? Vector{forward, across} : Vector{across, forward};
  }
};

}  // namespace desert_sim::wind

#pragma once
/// Whether thin sand oscillates from cell to cell.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// A cell's deviation is its elevation less the mean of its two neighbours along a row (column). It
/// oscillates where that has the opposite sign of both neighbours' deviations. Sand from 1 cm to 1 m deep is
/// thin; where a deviation is larger than that, a wall stands beside the sand, and nothing oscillates.
struct Oscillation {
  double share = 0;  ///< of the thin cells those that oscillate by more than 2 cm
  double rms = 0;    ///< root mean square of the oscillating deviations over all thin cells [m]
  std::size_t thin_cells = 0;
};

/// The worse of rows and columns. test/bench/grid_oscillation.cpp measures scenarios by it.
Oscillation oscillation(const Field& elevation, const Field& sand);

}  // namespace desert_sim

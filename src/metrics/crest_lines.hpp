#pragma once
/// Crests of a pattern, followed as lines: heights of dunes, lengths of crests, and where crests end.

#include <cstddef>

#include "src/metrics/field.hpp"

namespace desert_sim {

/// Profiles of the relief lie across the crests, a cell apart, and cover the grid; the relief is
/// smoothed by a Gaussian to find crests, and is not smoothed to measure heights. A dune of a profile
/// begins where the relief rises above the mean by a quarter of the standard deviation, and ends where
/// it falls below the mean; its crest is the highest point between. Its height is that of the crest
/// above the mean of the lowest points before and after it. Crests of neighbouring profiles that are at
/// most four cells apart along the profiles belong to one line, each to one only, the nearest first. A
/// crest that has no neighbour on one side terminates there, unless the terrain ends: at the tip of a
/// dune, or at a dislocation, where one crest ends between two others or joins another (Werner & Kocurek
/// 1999).
struct CrestLines {
  std::size_t dunes = 0;         ///< on all profiles, those between two lows
  double mean_height = 0;        ///< of these [m]
  double highest = 0;            ///< of these [m]
  double length = 0;             ///< of all crest lines [m]
  std::size_t terminations = 0;  ///< ends of crest lines
};

/// `crest_deg`: along the crests, see crest_orientation(). `sigma`: of the smoothing [m].
CrestLines crest_lines(const Field& relief, double crest_deg, double sigma);

}  // namespace desert_sim

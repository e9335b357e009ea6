#pragma once
/// Slip faces: sand that is steeper than wind alone makes it.

#include <optional>
#include <vector>

#include "src/metrics/field.hpp"

namespace desert_sim {

/// Directions that cells of at least `least_slope_deg` fall to: maxima of their distribution within ±15
/// degrees that hold at least `least_share` of these cells and lie 45 degrees or more apart; most frequent
/// first.
std::vector<double> slip_face_directions(const Field& elevation, double least_slope_deg = 28,
                                         double least_share = 0.08);

/// Cells that are steeper than `steeper_than_deg` and have at least `least_depth` metres of sand.
struct SlipFaces {
  double share = 0;  ///< of all cells
  /// Of the slip faces that the wind blows over, those that fall within 90 degrees of it; empty in still air.
  std::optional<double> lee_share;
  double direction_deg = 0;            ///< mean of the directions they fall to
  double direction_coherence = 0;      ///< length of the mean of the unit vectors: 1 if all are parallel
  std::vector<double> directions_deg;  ///< slip_face_directions() of these cells
};

/// `wind_x`, `wind_y`: at the surface [m/s].
SlipFaces slip_faces(const Field& elevation, const Field& sand, const Field& wind_x, const Field& wind_y,
                     double steeper_than_deg = 30, double least_depth = 0.1);

}  // namespace desert_sim

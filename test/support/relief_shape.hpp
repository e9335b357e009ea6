#pragma once
/// What a relief looks like as a whole: the side of its steepest slopes, and the arms of a pile of sand.

#include "src/metrics/field.hpp"

namespace desert_sim {

/// The steepest cells of a relief.
struct Steepest {
  double slope_deg = 0;      ///< of the gentlest of them
  double direction_deg = 0;  ///< mean of the directions they fall to
  double coherence = 0;      ///< length of the mean of the unit vectors: 1 if all are parallel
  /// Shares of them that fall within 60 degrees of a direction.
  double towards(double direction) const;
  std::vector<double> directions_deg;
};

/// The `share` of cells that are steepest after smoothing by a Gaussian of `sigma` metres.
Steepest steepest(const Field& elevation, double sigma, double share = 0.05);

/// How dunes of a wind to the east lean and bend, on the steepest 5 % of the relief's cells that fall within
/// 60 degrees of east (lee) or of west (stoss).
struct Crescents {
  double skewness = 0;  ///< of the slope along the wind: below 0 if lees are steeper than stosses
  /// Divergence of the directions in which they fall, mean of all such cells [1/m]: below 0 between the
  /// horns of a crescent, where fall lines run together; above 0 round its back.
  double lee_divergence = 0, stoss_divergence = 0;
};
Crescents crescents(const Field& elevation, double sigma);

/// Arms of a pile that a ring of `radius` metres round (x, y) crosses: maxima of the height along the ring,
/// with dips of at least `dip` metres between neighbours. `sigma`: of the smoothing before [m].
int arms(const Field& elevation, double x, double y, double radius, double dip, double sigma);

}  // namespace desert_sim

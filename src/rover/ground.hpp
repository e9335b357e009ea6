#pragma once
/// The ground that a rover stands on, wherever it comes from.

#include <limits>
#include <optional>

#include "src/core/elementary.hpp"

namespace desert_sim {

/// What is under a wheel.
struct GroundPoint {
  double sand_depth = 0;            ///< [m]
  std::optional<double> looseness;  ///< 0 packed … 1 fresh; none where the terrain does not know it
  double moisture = 0;              ///< relative, 0 … 1
  double obstacle = 0;              ///< above 0 a solid object stands there
  double water = 0;                 ///< depth of water [m]
  double water_x = 0, water_y = 0;  ///< velocity of the water [m/s]

  /// Depth × speed of the water [m²/s].
  double flow() const { return water * elementary::hypot(water_x, water_y); }
};

/// Coordinates are those of the terrain's frame [m].
class GroundSource {
 public:
  virtual ~GroundSource() = default;
  /// Whether a point is on the terrain, known or not.
  virtual bool contains(double x, double y) const = 0;
  /// Elevation of the surface [m], bilinear between cell centres; none where it is unknown or off the
  /// terrain.
  virtual std::optional<double> elevation(double x, double y) const = 0;
  /// Size of the smallest features of the elevation that wheels have to find [m]; infinity: the ground has
  /// none that are small against wheels.
  virtual double finest_feature() const { return std::numeric_limits<double>::infinity(); }
  /// The rest; what is unknown has its default.
  virtual GroundPoint at(double x, double y) const = 0;
};

/// Moisture over what the ground can hold, as in kernels/sand/repose.hpp: `moisture` [m] in `depth` [m] of
/// sand and soil, `capacity` the moisture of a metre of it, `deepest` the depth down to which it holds any.
inline double relative_moisture(double moisture, double depth, double capacity, double deepest = 1) {
  if (!(moisture > 0)) return 0;
  const double held = capacity * (depth < deepest ? (depth > 1e-3 ? depth : 1e-3) : deepest);
  return moisture < held ? moisture / held : 1;
}

}  // namespace desert_sim

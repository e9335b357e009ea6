#pragma once
/// Wheels and body against the ground: where a wheel, a rigid disc along the heading, touches it, how steep
/// it is there, and what is in the way.

#include <optional>
#include <string>

#include "src/rover/drive.hpp"
#include "src/rover/ground.hpp"
#include "src/rover/suspension.hpp"

namespace desert_sim {

/// Means of the ground under all wheels, along and across their ways.
struct GroundUnderWheels {
  double rise = 0;        ///< tangent of the slope along the way, uphill positive
  double cross_rise = 0;  ///< tangent of the slope to the left of the way
  GroundPoint mean;       ///< the looseness is set
};

/// What keeps the rover from going on; `excess` is how far it is over the limit.
struct Hindrance {
  RoverCondition condition = RoverCondition::idle;  ///< idle: nothing is in the way
  double excess = 0;
  std::string reason;
};

class Contact {
 public:
  Contact(const RoverParameters& rover, Suspension suspension);

  /// Whether all hubs are over ground that is known; else why not.
  Hindrance missing_ground(const RoverState& state, const GroundSource& ground) const;
  /// Elevation at which the wheel would stand on top of the ground, its lowest point that of the disc [m]:
  /// max over u of h(x + u cos ψ, y + u sin ψ) + √(r² − u²), less r. Unknown ground counts as the lowest.
  double surface(double x, double y, double yaw, const GroundSource& ground) const;
  /// The ground at a hub, with the assumed looseness where the terrain has none.
  GroundPoint point(const Eigen::Vector3d& hub, const GroundSource& ground) const;
  /// `motion`: what the wheels do.
  GroundUnderWheels under(const RoverState& state, const WheelMotion& motion,
                          const GroundSource& ground) const;
  /// Load of a wheel over the nominal one, by the attitude and the height of the centre of mass.
  double load_share(const RoverState& state, int wheel) const;
  /// The worst of what would be in the way of a rover in this state whose wheels go as `motion` says.
  Hindrance hindrance(const RoverState& state, const WheelMotion& motion, const GroundSource& ground) const;

 private:
  struct Direction {
    double x, y;
  };
  static Direction way_of(const RoverState& state, const WheelMotion& motion, int wheel);
  Hindrance at_wheel(const Eigen::Vector3d& hub, const Direction& way, const GroundSource& ground) const;
  Hindrance under_body(const RoverState& state, const GroundSource& ground) const;

  const RoverParameters rover_;
  const Suspension suspension_;
  double mean_square_x_ = 0, mean_square_y_ = 0;  ///< of the hubs' places [m²]
};

}  // namespace desert_sim

#pragma once
/// What the wheels do to obey a command: limits, steering angles and rim speeds.

#include <array>
#include <utility>

#include "src/rover/suspension.hpp"

namespace desert_sim {

/// Motion of the body that the rims make where nothing slips, and what each wheel does for it.
struct WheelMotion {
  DriveCommand body;
  std::array<double, most_wheels> steer{};      ///< [rad]
  std::array<double, most_wheels> rim_speed{};  ///< [m/s]
};

class Drive {
 public:
  Drive(const RoverParameters& rover, Suspension suspension)
      : rover_(rover), suspension_(std::move(suspension)) {}

  /// The command within the limits of speed, yaw rate and steering. Its direction stays where the steering
  /// allows.
  DriveCommand limited(const DriveCommand& command) const;
  /// `now`, changed towards `wanted` by at most what the accelerations allow in `time` [s].
  DriveCommand approached(const DriveCommand& now, const DriveCommand& wanted, double time) const;
  /// Steering and rim speeds for a motion within the limits. A wheel that stands keeps its angle of before.
  WheelMotion wheels_for(const DriveCommand& motion, const std::array<WheelState, most_wheels>& before) const;

 private:
  struct Velocity {
    double x, y;
  };
  /// Of a hub in the body's frame.
  Velocity at_hub(const DriveCommand& motion, int wheel) const;
  double rim_speed_of(const DriveCommand& motion, int wheel) const;

  const RoverParameters rover_;
  const Suspension suspension_;
};

}  // namespace desert_sim

#pragma once
/// Follows a path by pure pursuit (Coulter 1992): the rover drives on the arc through the point of the path
/// that is a lookahead L ahead. With that point at (x, y) in the rover's frame the arc's curvature is
///
///   κ = 2 y/(x² + y²)
///
/// Where the point is too far to the side, a rover that can turns on the spot.

#include <cstddef>

#include "src/planner/grid_path.hpp"
#include "src/rover/rover_state.hpp"

namespace desert_sim {

struct PursuitParameters {
  double speed = 0.3;             ///< on straight ways [m/s]
  double yaw_rate = 0.5;          ///< at most [rad/s]
  double lookahead = 1;           ///< L [m]
  double turn_angle_deg = 45;     ///< angle to the point from which on it turns on the spot
  bool turns_on_the_spot = true;  ///< otherwise it drives its narrowest arc
  double narrowest_arc = 1.5;     ///< radius of that [m]
};

/// Where a rover is and where it heads, in the terrain's frame [m, rad].
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;
};

/// The angle −π … π from the heading of a pose to a direction (dx, dy).
double bearing(const PlanarPose& pose, double dx, double dy);
/// Turns on the spot by this angle, slower as it becomes small.
DriveCommand turn(double angle, double yaw_rate);

class PurePursuit {
 public:
  explicit PurePursuit(const PursuitParameters& parameters) : parameters_(parameters) {}

  /// A new path, which begins near the rover.
  void follow(GridPath path);
  const GridPath& path() const { return path_; }
  /// Notes where the rover is. It goes on along the path only, so that a path may cross itself.
  void locate(const PlanarPose& pose);
  /// The command at the pose of the last locate(); none without a path.
  DriveCommand command();

  /// What is left of the path, from the point of it that is nearest to the rover.
  GridPath remaining() const;
  double done() const { return done_; }  ///< way along the path up to that point [m]
  double left() const { return way_.empty() ? 0 : way_.back() - done_; }  ///< and from there to its end [m]
  double off_path() const { return off_path_; }                           ///< distance to that point [m]

 private:
  GridPoint point_at(double way) const;

  PursuitParameters parameters_;
  GridPath path_;
  std::vector<double> way_;  ///< along the path up to each point [m]
  PlanarPose pose_;
  double done_ = 0, off_path_ = 0;
  bool turning_ = false;
};

}  // namespace desert_sim

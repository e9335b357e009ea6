#pragma once
/// A navigator and a rover that does exactly what it is told, for tests.

#include <cmath>

#include "src/planner/navigator.hpp"
#include "test/src/planner/grids.hpp"

namespace desert_sim::test {

inline constexpr GridFrame frame{80, 60, 0.5, 0, 0};

/// Turns and drives without slip.
struct IdealRover {
  PlanarPose pose;
  void drive(const DriveCommand& c, double time) {
    pose.yaw += c.yaw_rate * time;
    pose.x += c.forward * std::cos(pose.yaw) * time;
    pose.y += c.forward * std::sin(pose.yaw) * time;
  }
};

class Navigating : public testing::Test {
 protected:
  explicit Navigating(PlannerParameters p = {}) : parameters_(p), navigator_(parameters_) { ground(free_); }
  static float free_(int, int) { return 1.0F; }

  void ground(const Traversability& t) {
    navigator_.update(frame, {0, 0, frame.width, frame.height}, values_of(frame, t).data());
  }
  void go(double x, double y) { navigator_.set_goal({x, y, 0}, time_); }
  /// Until it has ended, or for so long.
  NavigatorState run(double seconds, RoverCondition condition = RoverCondition::driving) {
    for (const double end = time_ + seconds; time_ < end && navigator_.active(); time_ += 0.1)
      rover_.drive(navigator_.act(time_, rover_.pose, condition, "a reason"), 0.1);
    return navigator_.status().state;
  }
  const NavigatorStatus& status() const { return navigator_.status(); }

  PlannerParameters parameters_;
  Navigator navigator_;
  IdealRover rover_{{5, 5, 0}};
  double time_ = 10;
};

}  // namespace desert_sim::test

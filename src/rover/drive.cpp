#include "src/rover/drive.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

namespace {

DriveCommand scaled(const DriveCommand& c, double factor) {
  return {c.forward * factor, c.sideways * factor, c.yaw_rate * factor};
}

}  // namespace

Drive::Velocity Drive::at_hub(const DriveCommand& m, int wheel) const {
  const Eigen::Vector3d& h = suspension_.hub_at_rest(wheel);
  return {m.forward - m.yaw_rate * h.y(), m.sideways + m.yaw_rate * h.x()};
}

double Drive::rim_speed_of(const DriveCommand& m, int wheel) const {
  const Velocity v = at_hub(m, wheel);
  return rover_.steering == Steering::skid ? std::abs(v.x) : elementary::hypot(v.x, v.y);
}

DriveCommand Drive::limited(const DriveCommand& command) const {
  DriveCommand c = command;
  if (rover_.steering != Steering::per_wheel) c.sideways = 0;
  const double speed = elementary::hypot(c.forward, c.sideways);
  if (speed > rover_.max_speed) c.forward *= rover_.max_speed / speed, c.sideways *= rover_.max_speed / speed;
  c.yaw_rate = std::clamp(c.yaw_rate, -rover_.max_yaw_rate, rover_.max_yaw_rate);
  if (rover_.steering == Steering::ackermann) {
    // The wheels of the inner side steer most: tan(steer) = (wheelbase/2)/(radius − track/2).
    const double tightest =
        rover_.track / 2 + rover_.wheelbase / 2 / elementary::tan_deg(rover_.max_steer_deg);
    const double fastest = std::abs(c.forward) / tightest;
    c.yaw_rate = std::clamp(c.yaw_rate, -fastest, fastest);
  }
  double rim = 0;
  for (int n = 0; n < suspension_.wheels(); ++n) rim = std::max(rim, rim_speed_of(c, n));
  return rim > rover_.max_wheel_speed ? scaled(c, rover_.max_wheel_speed / rim) : c;
}

DriveCommand Drive::approached(const DriveCommand& now, const DriveCommand& wanted, double time) const {
  const auto towards = [time](double from, double to, double rate) {
    return from + std::clamp(to - from, -rate * time, rate * time);
  };
  DriveCommand c{towards(now.forward, wanted.forward, rover_.max_acceleration),
                 towards(now.sideways, wanted.sideways, rover_.max_acceleration),
                 towards(now.yaw_rate, wanted.yaw_rate, rover_.max_yaw_acceleration)};
  return rover_.steering == Steering::ackermann ? limited(c)
                                                : c;  // it cannot turn more tightly while it brakes
}

WheelMotion Drive::wheels_for(const DriveCommand& m,
                              const std::array<WheelState, most_wheels>& before) const {
  WheelMotion motion;
  motion.body = m;
  for (int wheel = 0; wheel < suspension_.wheels(); ++wheel) {
    const auto n = static_cast<std::size_t>(wheel);
    const Velocity v = at_hub(m, wheel);
    if (rover_.steering == Steering::skid) {
      motion.rim_speed[n] = v.x;
      continue;
    }
    const double speed = elementary::hypot(v.x, v.y);
    motion.steer[n] = before[n].steer;
    if (!(speed > 1e-9)) continue;
    double angle = elementary::atan2(v.y, v.x), sign = 1;
    if (angle > pi / 2) angle -= pi, sign = -1;
    if (angle < -pi / 2) angle += pi, sign = -1;
    motion.steer[n] = angle;
    motion.rim_speed[n] = sign * speed;
  }
  return motion;
}

}  // namespace desert_sim

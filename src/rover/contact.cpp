#include "src/rover/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "src/core/elementary.hpp"
#include "src/core/number_text.hpp"
#include "src/core/rotation.hpp"

namespace desert_sim {

namespace {

template <class... Parts>
std::string text_of(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

}  // namespace

Contact::Contact(const RoverParameters& rover, Suspension suspension)
    : rover_(rover), suspension_(std::move(suspension)) {
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const Eigen::Vector3d& h = suspension_.hub_at_rest(n);
    mean_square_x_ += h.x() * h.x() / suspension_.wheels();
    mean_square_y_ += h.y() * h.y() / suspension_.wheels();
  }
}

Hindrance Contact::missing_ground(const RoverState& state, const GroundSource& ground) const {
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const Eigen::Vector3d h = suspension_.hub(n, state);
    if (!ground.contains(h.x(), h.y()))
      return {RoverCondition::off_grid, 1,
              text_of("wheel ", n, " is off the terrain at ", point_text(h.x(), h.y()))};
    if (!ground.elevation(h.x(), h.y()))
      return {RoverCondition::no_terrain, 1,
              text_of("the elevation under wheel ", n, " is unknown at ", point_text(h.x(), h.y()))};
  }
  return {};
}

double Contact::surface(double x, double y, double yaw, const GroundSource& ground) const {
  constexpr int fewest = 6;  // points of the rim to either side: 0.4 % of the radius off at most on a plane
  constexpr int most = 200;
  const double r = rover_.wheel_radius;
  const elementary::UnitVector ahead = elementary::direction(yaw);
  const int half =
      static_cast<int>(std::clamp(std::ceil(1.5 * r / ground.finest_feature()), 1.0 * fewest, 1.0 * most));
  double highest = -std::numeric_limits<double>::infinity();
  for (int n = -half; n <= half; ++n) {
    // The points are even in angle, so that they are dense where steep ground touches the rim.
    const elementary::UnitVector rim = elementary::direction(n * (1.5 / half));
    const double u = r * rim.y, drop = r * rim.x;
    if (const std::optional<double> z = ground.elevation(x + u * ahead.x, y + u * ahead.y))
      highest = std::max(highest, *z + drop);
  }
  return highest - r;
}

GroundPoint Contact::point(const Eigen::Vector3d& hub, const GroundSource& ground) const {
  GroundPoint p = ground.at(hub.x(), hub.y());
  if (!p.looseness) p.looseness = rover_.assumed_looseness;
  return p;
}

Contact::Direction Contact::way_of(const RoverState& state, const WheelMotion& motion, int wheel) {
  const auto n = static_cast<std::size_t>(wheel);
  const double sign = motion.rim_speed[n] < 0 ? -1 : 1;
  const elementary::UnitVector way = elementary::direction(state.pose.yaw + motion.steer[n]);
  return {sign * way.x, sign * way.y};
}

GroundUnderWheels Contact::under(const RoverState& state, const WheelMotion& motion,
                                 const GroundSource& ground) const {
  GroundUnderWheels mean;
  mean.mean.looseness = 0;
  const double share = 1.0 / suspension_.wheels(), reach = rover_.wheel_radius;
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const Eigen::Vector3d h = suspension_.hub(n, state);
    const Direction way = way_of(state, motion, n);
    const auto rise = [&](double dx, double dy) {
      const double here = ground.elevation(h.x(), h.y()).value_or(0);
      const double ahead = ground.elevation(h.x() + reach * dx, h.y() + reach * dy).value_or(here),
                   behind = ground.elevation(h.x() - reach * dx, h.y() - reach * dy).value_or(here);
      return (ahead - behind) / (2 * reach);
    };
    mean.rise += share * rise(way.x, way.y);
    mean.cross_rise += share * rise(-way.y, way.x);
    const GroundPoint p = point(h, ground);
    mean.mean.sand_depth += share * p.sand_depth;
    mean.mean.moisture += share * p.moisture;
    *mean.mean.looseness += share * *p.looseness;
  }
  return mean;
}

double Contact::load_share(const RoverState& state, int wheel) const {
  const Eigen::Vector3d& h = suspension_.hub_at_rest(wheel);
  const double height = rover_.mass_height - rover_.wheel_radius;
  const double share = 1 + height * (elementary::tan(state.pose.pitch) * h.x() / mean_square_x_ -
                                     elementary::tan(state.pose.roll) * h.y() / mean_square_y_);
  return std::clamp(share, 0.0, 3.0);
}

Hindrance Contact::at_wheel(const Eigen::Vector3d& h, const Direction& way,
                            const GroundSource& ground) const {
  const double r = rover_.wheel_radius, x = h.x() + r * way.x, y = h.y() + r * way.y;
  if (!ground.contains(x, y))
    return {RoverCondition::off_grid, 1, text_of("the terrain ends at ", point_text(x, y))};
  const std::optional<double> ahead = ground.elevation(x, y), here = ground.elevation(h.x(), h.y());
  if (!ahead || !here)
    return {RoverCondition::no_terrain, 1, text_of("the elevation is unknown at ", point_text(x, y))};
  const GroundPoint p = ground.at(x, y);
  if (p.obstacle > 0)
    return {RoverCondition::blocked, 1 + p.obstacle, text_of("an obstacle is at ", point_text(x, y))};
  const double step = *ahead - *here - rover_.max_step;
  if (step > 0)
    return {RoverCondition::blocked, step,
            text_of("a step of ", *ahead - *here, " m is at ", point_text(x, y), " (at most ",
                    rover_.max_step, " m)")};
  const double water = p.water - rover_.max_water;
  if (water > 0)
    return {RoverCondition::blocked, water,
            text_of("water is ", p.water, " m deep at ", point_text(x, y), " (at most ", rover_.max_water,
                    " m)")};
  const double flow = p.flow() - rover_.max_flow;
  if (flow > 0)
    return {RoverCondition::blocked, flow,
            text_of("water of ", p.water, " m flows with ", p.flow() / p.water, " m/s at ", point_text(x, y),
                    ", ", p.flow(), " m^2/s (at most ", rover_.max_flow, " m^2/s)")};
  return {};
}

/// Sand gives way to the body, firm ground does not.
Hindrance Contact::under_body(const RoverState& state, const GroundSource& ground) const {
  const Eigen::Matrix3d rotation = rotation_of(state.pose);
  const Eigen::Vector3d origin(state.pose.x, state.pose.y, state.pose.z);
  const double ahead = rover_.body_length / 2, low = rover_.clearance - rover_.wheel_radius;
  Hindrance worst;
  for (const double x : {-ahead, -ahead / 2, 0.0, ahead / 2, ahead}) {
    const Eigen::Vector3d p = origin + turned(rotation, {x, 0, low});
    const std::optional<double> elevation = ground.elevation(p.x(), p.y());
    const double excess =
        elevation ? *elevation - std::max(ground.at(p.x(), p.y()).sand_depth, 0.0) - p.z() : 0;
    if (excess > worst.excess)
      worst = {RoverCondition::blocked, excess,
               text_of("firm ground touches the body's underside at ", point_text(p.x(), p.y()))};
  }
  return worst;
}

Hindrance Contact::hindrance(const RoverState& state, const WheelMotion& motion,
                             const GroundSource& ground) const {
  Hindrance worst = under_body(state, ground);
  for (int n = 0; n < suspension_.wheels(); ++n) {
    if (motion.rim_speed[static_cast<std::size_t>(n)] == 0) continue;
    const Hindrance found = at_wheel(suspension_.hub(n, state), way_of(state, motion, n), ground);
    if (found.condition > worst.condition ||
        (found.condition == worst.condition && found.excess > worst.excess))
      worst = found;
  }
  return worst;
}

}  // namespace desert_sim

#include "src/planner/pure_pursuit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

namespace {

constexpr double facing = 0.15;         // angle at which a turn on the spot ends [rad]
constexpr double slow_curvature = 1.5;  // at which it drives at half its speed [1/m]
constexpr double slowest = 0.25;        // share of the speed at the end of the path

}  // namespace

double bearing(const PlanarPose& pose, double dx, double dy) {
  return std::remainder(elementary::atan2(dy, dx) - pose.yaw, 2 * pi);
}

DriveCommand turn(double angle, double yaw_rate) {
  const double rate = std::clamp(1.5 * angle, -yaw_rate, yaw_rate), least = 0.3 * yaw_rate;
  return {0, 0, std::abs(rate) < least ? std::copysign(least, angle) : rate};
}

void PurePursuit::follow(GridPath path) {
  path_ = std::move(path);
  way_.clear();
  for (std::size_t n = 0; n < path_.size(); ++n)
    way_.push_back(n == 0 ? 0
                          : way_.back() +
                                elementary::hypot(path_[n].x - path_[n - 1].x, path_[n].y - path_[n - 1].y));
  done_ = off_path_ = 0;
  turning_ = false;
}

void PurePursuit::locate(const PlanarPose& pose) {
  pose_ = pose;
  if (path_.empty()) return;
  off_path_ = elementary::hypot(path_.front().x - pose.x, path_.front().y - pose.y);
  const double from = done_, reach = from + 3 * parameters_.lookahead;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < path_.size() && way_[n - 1] <= reach; ++n) {
    if (way_[n] < from) continue;
    const GridPoint &a = path_[n - 1], &b = path_[n];
    const double length = way_[n] - way_[n - 1];
    if (!(length > 0)) continue;
    const double along = ((pose.x - a.x) * (b.x - a.x) + (pose.y - a.y) * (b.y - a.y)) / length;
    const double at = std::clamp(along, std::clamp(from - way_[n - 1], 0.0, length), length);
    const double away =
        elementary::hypot(a.x + (b.x - a.x) * at / length - pose.x, a.y + (b.y - a.y) * at / length - pose.y);
    if (away < nearest) nearest = off_path_ = away, done_ = way_[n - 1] + at;
  }
}

GridPoint PurePursuit::point_at(double way) const {
  const auto after = std::upper_bound(way_.begin(), way_.end(), way);
  if (after == way_.end()) return path_.back();
  const auto n = static_cast<std::size_t>(after - way_.begin());
  if (n == 0) return path_.front();
  const double share = (way - way_[n - 1]) / (way_[n] - way_[n - 1]);
  return {path_[n - 1].x + (path_[n].x - path_[n - 1].x) * share,
          path_[n - 1].y + (path_[n].y - path_[n - 1].y) * share};
}

GridPath PurePursuit::remaining() const {
  if (path_.empty()) return {};
  GridPath rest{point_at(done_)};
  for (std::size_t n = 0; n < path_.size(); ++n)
    if (way_[n] > done_) rest.push_back(path_[n]);
  return rest;
}

DriveCommand PurePursuit::command() {
  if (path_.empty()) return {};
  const GridPoint ahead = point_at(done_ + parameters_.lookahead);
  const double dx = ahead.x - pose_.x, dy = ahead.y - pose_.y, distance = elementary::hypot(dx, dy);
  if (!(distance > 0)) return {};
  const double angle = bearing(pose_, dx, dy);
  turning_ = std::abs(angle) > (turning_ ? facing : parameters_.turn_angle_deg * pi / 180);
  if (turning_ && parameters_.turns_on_the_spot) return turn(angle, parameters_.yaw_rate);
  double curvature = 2 * elementary::sin(angle) / distance;
  if (!parameters_.turns_on_the_spot) {
    const double most = 1 / parameters_.narrowest_arc;
    if (std::abs(angle) > pi / 2) curvature = std::copysign(most, angle);
    curvature = std::clamp(curvature, -most, most);
  }
  double speed = parameters_.speed / (1 + std::abs(curvature) / slow_curvature);
  speed = std::min(speed, parameters_.speed * std::max(slowest, left() / parameters_.lookahead));
  if (std::abs(curvature) * speed > parameters_.yaw_rate) speed = parameters_.yaw_rate / std::abs(curvature);
  return {speed, 0, curvature * speed};
}

}  // namespace desert_sim

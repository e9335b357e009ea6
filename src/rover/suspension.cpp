#include "src/rover/suspension.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"

namespace desert_sim {

namespace {

/// About the y axis: positive angles turn the nose down.
Point3 turned_down(const Point3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x + s * p.z, p.y, c * p.z - s * p.x};
}

}  // namespace

double angle_between_turns(double angle) { return angle - 2 * pi * std::round(angle / (2 * pi)); }

Rotation rotation_of(const Pose& pose) {
  const double cr = std::cos(pose.roll), sr = std::sin(pose.roll), cp = std::cos(pose.pitch),
               sp = std::sin(pose.pitch), cy = std::cos(pose.yaw), sy = std::sin(pose.yaw);
  return {{{cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr},
           {sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr},
           {-sp, cp * sr, cp * cr}}};
}

Point3 rotated(const Rotation& r, const Point3& p) {
  const auto row = [&p](const std::array<double, 3>& a) { return a[0] * p.x + a[1] * p.y + a[2] * p.z; };
  return {row(r[0]), row(r[1]), row(r[2])};
}

Point3 rotated_back(const Rotation& r, const Point3& p) {
  const auto column = [&](std::size_t n) { return r[0][n] * p.x + r[1][n] * p.y + r[2][n] * p.z; };
  return {column(0), column(1), column(2)};
}

Suspension::Suspension(const RoverParameters& rover) : rover_(rover), wheels_(wheel_count(rover.suspension)) {
  for (int n = 0; n < wheels_; ++n) {
    const int row = n / 2;
    const bool last = row == wheels_ / 2 - 1;
    const double x = row == 0 ? rover.wheelbase / 2 : last ? -rover.wheelbase / 2 : rover.middle_x;
    rest_[static_cast<std::size_t>(n)] = {x, (is_left(n) ? 0.5 : -0.5) * rover.track, 0};
  }
  invert_level_matrix();
}

/// Gauss–Jordan elimination with pivots. The matrix is regular, because check_rover() wants the pivots
/// between wheels.
void Suspension::invert_level_matrix() {
  Matrix a{};
  const auto n = static_cast<std::size_t>(wheels_);
  for (std::size_t i = 0; i < n; ++i) {
    const int wheel = static_cast<int>(i);
    const Point3& h = rest_[i];
    a[i][0] = 1;
    a[i][1] = h.y;
    a[i][2] = -h.x;
    // A bogie's pivot moves with its rocker; the bogie itself is the further turn about that pivot.
    a[i][3] = -(h.x - rover_.pivot_x) * (is_left(wheel) ? 1 : -1);
    if (on_bogie(wheel)) a[i][is_left(wheel) ? 4 : 5] = -(h.x - rover_.bogie_x);
    inverse_[i][i] = 1;
  }
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < n; ++row)
      if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
    std::swap(a[column], a[pivot]);
    std::swap(inverse_[column], inverse_[pivot]);
    const double scale = 1 / a[column][column];
    for (std::size_t k = 0; k < n; ++k) a[column][k] *= scale, inverse_[column][k] *= scale;
    for (std::size_t row = 0; row < n; ++row) {
      if (row == column) continue;
      const double factor = a[row][column];
      for (std::size_t k = 0; k < n; ++k)
        a[row][k] -= factor * a[column][k], inverse_[row][k] -= factor * inverse_[column][k];
    }
  }
}

Point3 Suspension::hub_in_body(int wheel, double rocker, const std::array<double, 2>& bogie) const {
  Point3 hub = hub_at_rest(wheel);
  if (on_bogie(wheel)) {
    hub.x -= rover_.bogie_x;
    hub.z -= rover_.bogie_height;
    hub = turned_down(hub, bogie[is_left(wheel) ? 0 : 1]);
    hub.x += rover_.bogie_x;
    hub.z += rover_.bogie_height;
  }
  hub.x -= rover_.pivot_x;
  hub.z -= rover_.pivot_height;
  hub = turned_down(hub, is_left(wheel) ? rocker : -rocker);
  hub.x += rover_.pivot_x;
  hub.z += rover_.pivot_height;
  return hub;
}

Point3 Suspension::hub(int wheel, const RoverState& s) const {
  const Point3 p = rotated(rotation_of(s.pose), hub_in_body(wheel, s.rocker, s.bogie));
  return {s.pose.x + p.x, s.pose.y + p.y, s.pose.z + p.z};
}

void Suspension::settle(RoverState& s, const Support& support, int iterations) const {
  const auto n = static_cast<std::size_t>(wheels_);
  const double longest = 0.25 * rover_.wheelbase;  // of a step, so that a cliff does not turn it over
  constexpr double steepest = 1.3;                 // [rad]
  std::array<double, most_wheels> error{};
  const auto measure = [&] {
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Point3 h = hub(static_cast<int>(i), s);
      error[i] = support(static_cast<int>(i), h.x, h.y) - h.z;
      worst = std::max(worst, std::abs(error[i]));
    }
    return worst;
  };
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double worst = measure();
    // The height follows at once, and only what is left of the error turns anything.
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i) mean += error[i] / wheels_;
    const double share = worst > longest ? longest / worst : 1;
    std::array<double, most_wheels> step{};
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t i = 0; i < n; ++i) step[k] += inverse_[k][i] * (error[i] - mean) * share;
    s.pose.z += mean + step[0];
    const auto turn = [&](double& angle, std::size_t k) {
      angle = std::clamp(angle + step[k], -steepest, steepest);
    };
    turn(s.pose.roll, 1);
    turn(s.pose.pitch, 2);
    turn(s.rocker, 3);
    if (wheels_ == 6) turn(s.bogie[0], 4), turn(s.bogie[1], 5);
  }
  s.contact_error = measure();
}

}  // namespace desert_sim

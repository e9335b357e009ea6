#include "src/rover/suspension.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"
#include "src/core/rotation.hpp"

namespace desert_sim {

namespace {

/// About the y axis: positive angles turn the nose down.
Eigen::Vector3d turned_down(const Eigen::Vector3d& p, double angle) {
  const auto [c, s] = elementary::direction(angle);
  return {c * p.x() + s * p.z(), p.y(), c * p.z() - s * p.x()};
}

}  // namespace

double angle_between_turns(double angle) { return angle - 2 * pi * std::round(angle / (2 * pi)); }

Eigen::Matrix3d rotation_of(const Pose& pose) {
  const auto [cr, sr] = elementary::direction(pose.roll);
  const auto [cp, sp] = elementary::direction(pose.pitch);
  const auto [cy, sy] = elementary::direction(pose.yaw);
  Eigen::Matrix3d matrix;
  matrix << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,        //
      -sp, cp * sr, cp * cr;
  return matrix;
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

/// Gauss–Jordan elimination with pivots, row by row and so in one order (src/core/rotation.hpp). The matrix
/// is regular, because check_rover() wants the pivots between wheels.
void Suspension::invert_level_matrix() {
  Matrix a = Matrix::Zero(wheels_, wheels_);
  for (int n = 0; n < wheels_; ++n) {
    const Eigen::Vector3d& h = hub_at_rest(n);
    a(n, 0) = 1;
    a(n, 1) = h.y();
    a(n, 2) = -h.x();
    // A bogie's pivot moves with its rocker; the bogie itself is the further turn about that pivot.
    a(n, 3) = -(h.x() - rover_.pivot_x) * (is_left(n) ? 1 : -1);
    if (on_bogie(n)) a(n, is_left(n) ? 4 : 5) = -(h.x() - rover_.bogie_x);
  }
  inverse_ = Matrix::Identity(wheels_, wheels_);
  for (int column = 0; column < wheels_; ++column) {
    int pivot = column;
    for (int row = column; row < wheels_; ++row)
      if (std::abs(a(row, column)) > std::abs(a(pivot, column))) pivot = row;
    const double scale = 1 / a(pivot, column);
    for (Matrix* m : {&a, &inverse_}) {
      m->row(column).swap(m->row(pivot));
      m->row(column) *= scale;
    }
    for (int row = 0; row < wheels_; ++row) {
      if (row == column) continue;
      const double factor = a(row, column);
      for (Matrix* m : {&a, &inverse_}) m->row(row) -= factor * m->row(column);
    }
  }
}

Eigen::Vector3d Suspension::hub_in_body(int wheel, double rocker, const std::array<double, 2>& bogie) const {
  const Eigen::Vector3d rocker_pivot(rover_.pivot_x, 0, rover_.pivot_height),
      bogie_pivot(rover_.bogie_x, 0, rover_.bogie_height);
  Eigen::Vector3d hub = hub_at_rest(wheel);
  if (on_bogie(wheel)) hub = bogie_pivot + turned_down(hub - bogie_pivot, bogie[is_left(wheel) ? 0 : 1]);
  return rocker_pivot + turned_down(hub - rocker_pivot, is_left(wheel) ? rocker : -rocker);
}

Eigen::Vector3d Suspension::hub(int wheel, const RoverState& s) const {
  return Eigen::Vector3d(s.pose.x, s.pose.y, s.pose.z) +
         turned(rotation_of(s.pose), hub_in_body(wheel, s.rocker, s.bogie));
}

void Suspension::settle(RoverState& s, const Support& support, int iterations) const {
  const double longest = 0.25 * rover_.wheelbase;  // of a step, so that a cliff does not turn it over
  constexpr double steepest = 1.3;                 // [rad]
  using PerWheel = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_wheels, 1>;
  PerWheel error = PerWheel::Zero(wheels_);
  const auto measure = [&] {
    double worst = 0;
    for (int n = 0; n < wheels_; ++n) {
      const Eigen::Vector3d h = hub(n, s);
      error[n] = support(n, h.x(), h.y()) - h.z();
      worst = std::max(worst, std::abs(error[n]));
    }
    return worst;
  };
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const double worst = measure();
    // The height follows at once, and only what is left of the error turns anything.
    double mean = 0;
    for (int n = 0; n < wheels_; ++n) mean += error[n] / wheels_;
    const double share = worst > longest ? longest / worst : 1;
    PerWheel step = PerWheel::Zero(wheels_);
    for (int n = 0; n < wheels_; ++n) step += inverse_.col(n) * (error[n] - mean) * share;
    s.pose.z += mean + step[0];
    const auto turn = [&](double& angle, int k) { angle = std::clamp(angle + step[k], -steepest, steepest); };
    turn(s.pose.roll, 1);
    turn(s.pose.pitch, 2);
    turn(s.rocker, 3);
    if (wheels_ == 6) turn(s.bogie[0], 4), turn(s.bogie[1], 5);
  }
  s.contact_error = measure();
}

}  // namespace desert_sim

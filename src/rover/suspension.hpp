#pragma once
/// Rockers and bogies: where the wheels are at given joint angles, and the pose and joint angles at which
/// all wheels stand on the ground.
///
/// With ψ, θ, φ yaw, pitch and roll, hub i is at p + R_z(ψ) R_y(θ) R_x(φ) h_i(q), where h_i turns about the
/// rocker's pivot by ±q (left +, right −: the differential) and, behind it, about the bogie's pivot.
/// Unknown are z, θ, φ, q, and the angles of two bogies: as many as there are wheels. A fixed number of
/// Newton steps, with the matrix of level ground, solves
///
///   z_i(z, θ, φ, q, …) = support(x_i, y_i)     for every wheel i

#include <Eigen/Core>
#include <array>
#include <functional>

#include "src/rover/rover_parameters.hpp"
#include "src/rover/rover_state.hpp"

namespace desert_sim {

/// The angle without whole turns, −π … π.
double angle_between_turns(double angle);

/// R_z(yaw) R_y(pitch) R_x(roll).
Eigen::Matrix3d rotation_of(const Pose& pose);

class Suspension {
 public:
  explicit Suspension(const RoverParameters& rover);

  int wheels() const { return wheels_; }
  /// Of a wheel's hub in the body's frame while all joints are at 0; z is 0.
  const Eigen::Vector3d& hub_at_rest(int wheel) const { return rest_[static_cast<std::size_t>(wheel)]; }
  /// In the body's frame.
  Eigen::Vector3d hub_in_body(int wheel, double rocker, const std::array<double, 2>& bogie) const;
  /// In the terrain's frame.
  Eigen::Vector3d hub(int wheel, const RoverState& state) const;

  /// Height at which the ground holds the hub of this wheel over (x, y) [m].
  using Support = std::function<double(int wheel, double x, double y)>;
  /// Sets z, roll, pitch and joint angles of the state, beginning with those that it has; x, y and yaw
  /// stay. Sets contact_error, too.
  void settle(RoverState& state, const Support& support, int iterations) const;

 private:
  static bool is_left(int wheel) { return wheel % 2 == 0; }
  bool on_bogie(int wheel) const { return wheels_ == 6 && wheel >= 2; }
  void invert_level_matrix();

  const RoverParameters rover_;
  const int wheels_;
  std::array<Eigen::Vector3d, most_wheels> rest_{};
  /// With a row and a column a wheel.
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_wheels, most_wheels>;
  Matrix inverse_;  ///< of ∂z_i/∂(z, roll, pitch, rocker, left bogie, right bogie) on level ground
};

}  // namespace desert_sim

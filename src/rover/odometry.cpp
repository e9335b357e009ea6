/// What a Rover believes of its way, and what its inertial sensors feel.
#include <cmath>

#include "kernels/field/random.hpp"
#include "src/core/elementary.hpp"
#include "src/core/rotation.hpp"
#include "src/rover/rover.hpp"

namespace desert_sim {

namespace {

/// Two independent normal numbers of mean 0 and variance 1 from counters, by Box and Muller.
std::array<double, 2> normal_pair(std::uint64_t seed, Purpose purpose, std::uint64_t tick,
                                  std::uint32_t which) {
  const RandomWords words = random_words(seed, purpose, static_cast<std::uint32_t>(tick),
                                         static_cast<std::uint32_t>(tick >> 32), which);
  const double unit = 1.0 / 4294967296.0;
  const double radius = std::sqrt(-2 * elementary::log((words.word[0] + 0.5) * unit));
  const elementary::UnitVector direction = elementary::direction_deg(360 * (words.word[1] * unit));
  return {radius * direction.x, radius * direction.y};
}

}  // namespace

/// The way of the rims, along the attitude of the body. Yaw is that of the rims.
void Rover::dead_reckon() {
  Pose& o = state_.odometry;
  double forward = state_.rims.forward * internal_step, sideways = state_.rims.sideways * internal_step,
         turn = state_.rims.yaw_rate * internal_step;
  if (rover_.odometry_noise > 0) {
    const std::array<double, 2> noise = normal_pair(rover_.seed, Purpose::rover_odometry, state_.ticks, 0);
    forward += noise[0] * rover_.odometry_noise * std::sqrt(std::abs(forward));
    turn +=
        noise[1] * rover_.odometry_noise * std::sqrt(elementary::hypot(forward, sideways) + std::abs(turn));
  }
  o.roll = state_.pose.roll;
  o.pitch = state_.pose.pitch;
  o.yaw = angle_between_turns(o.yaw + turn / 2);
  const Eigen::Vector3d way = turned(rotation_of(o), {forward, sideways, 0});
  o.x += way.x();
  o.y += way.y();
  o.z += way.z();
  o.yaw = angle_between_turns(o.yaw + turn / 2);
}

/// Velocity, specific force and angular velocity from what has happened to the body. Ground has edges,
/// which springs and tyres soften: a filter of first order stands for them.
void Rover::feel(const Pose& before) {
  const double share = internal_step / (rover_.imu_filter + internal_step);
  const Pose& now = state_.pose;
  using Eigen::Vector3d;
  const Vector3d velocity =
      (Vector3d(now.x, now.y, now.z) - Vector3d(before.x, before.y, before.z)) / internal_step;
  Eigen::Map<Vector3d> filtered(state_.velocity.data());
  const Vector3d change = (velocity - filtered) * share;
  filtered += change;
  const Vector3d force = Vector3d(0, 0, rover_.gravity) + change / internal_step;
  const Eigen::Matrix3d rotation = rotation_of(now), old = rotation_of(before);
  Vector3d::Map(state_.acceleration.data()) = turned(rotation.transpose(), force);
  // Rᵀ_before R_now = 1 + [ω Δt]ₓ for the small turns of a step.
  Eigen::Matrix3d turn;
  for (int n = 0; n < 3; ++n) turn.col(n) = turned(old.transpose(), rotation.col(n));
  const Vector3d rate = Vector3d(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0), turn(1, 0) - turn(0, 1)) /
                        (2 * internal_step);
  Eigen::Map<Vector3d> turning(state_.angular_velocity.data());
  turning += (rate - turning) * share;
}

ImuReading Rover::imu() const {
  ImuReading reading{state_.angular_velocity, state_.acceleration};
  for (std::uint32_t n = 0; n < 3; ++n) {
    const std::array<double, 2> noise = normal_pair(rover_.seed, Purpose::rover_imu, state_.ticks, n);
    reading.angular_velocity[n] += rover_.gyro_noise * noise[0];
    reading.acceleration[n] += rover_.accelerometer_noise * noise[1];
  }
  return reading;
}

}  // namespace desert_sim

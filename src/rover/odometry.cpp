/// What a Rover believes of its way, and what its inertial sensors feel.
#include <cmath>

#include "kernels/field/random.hpp"
#include "src/core/constants.hpp"
#include "src/rover/rover.hpp"

namespace desert_sim {

namespace {

/// Two independent normal numbers of mean 0 and variance 1 from counters, by Box and Muller.
std::array<double, 2> normal_pair(std::uint64_t seed, Purpose purpose, std::uint64_t tick,
                                  std::uint32_t which) {
  const RandomWords words = random_words(seed, purpose, static_cast<std::uint32_t>(tick),
                                         static_cast<std::uint32_t>(tick >> 32), which);
  const double unit = 1.0 / 4294967296.0;
  const double radius = std::sqrt(-2 * std::log((words.word[0] + 0.5) * unit)),
               turn = 2 * pi * words.word[1] * unit;
  return {radius * std::cos(turn), radius * std::sin(turn)};
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
    turn += noise[1] * rover_.odometry_noise * std::sqrt(std::hypot(forward, sideways) + std::abs(turn));
  }
  o.roll = state_.pose.roll;
  o.pitch = state_.pose.pitch;
  o.yaw = angle_between_turns(o.yaw + turn / 2);
  const Point3 way = rotated(rotation_of(o), {forward, sideways, 0});
  o.x += way.x;
  o.y += way.y;
  o.z += way.z;
  o.yaw = angle_between_turns(o.yaw + turn / 2);
}

/// Velocity, specific force and angular velocity from what has happened to the body. Ground has edges,
/// which springs and tyres soften: a filter of first order stands for them.
void Rover::feel(const Pose& before) {
  const double share = internal_step / (rover_.imu_filter + internal_step);
  const Pose& now = state_.pose;
  const std::array<double, 3> velocity{(now.x - before.x) / internal_step, (now.y - before.y) / internal_step,
                                       (now.z - before.z) / internal_step};
  Point3 force{0, 0, rover_.gravity};
  double* const forces[] = {&force.x, &force.y, &force.z};
  for (std::size_t n = 0; n < 3; ++n) {
    const double change = (velocity[n] - state_.velocity[n]) * share;
    state_.velocity[n] += change;
    *forces[n] += change / internal_step;
  }
  const Rotation rotation = rotation_of(now), old = rotation_of(before);
  const Point3 felt = rotated_back(rotation, force);
  state_.acceleration = {felt.x, felt.y, felt.z};
  // Rᵀ_before R_now = 1 + [ω Δt]ₓ for the small turns of a step.
  const auto turned = [&](std::size_t i, std::size_t j) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += old[k][i] * rotation[k][j];
    return sum;
  };
  const std::array<double, 3> rate{(turned(2, 1) - turned(1, 2)) / (2 * internal_step),
                                   (turned(0, 2) - turned(2, 0)) / (2 * internal_step),
                                   (turned(1, 0) - turned(0, 1)) / (2 * internal_step)};
  for (std::size_t n = 0; n < 3; ++n)
    state_.angular_velocity[n] += (rate[n] - state_.angular_velocity[n]) * share;
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

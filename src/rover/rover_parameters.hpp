#pragma once
/// Parameters of a rover with wheels on rockers: dimensions, limits, and what it takes to stop it. Lengths
/// are those of the rover on a level plane. Body frame: origin between the wheel hubs, x ahead, y to the
/// left, z up.

#include <cstdint>
#include <string>

#include "kernels/rover/traversability_parameters.hpp"
#include "kernels/rover/wheel_ground.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// rocker: four wheels, one rocker a side. rocker_bogie: six wheels, whose middle and rear ones are on a
/// bogie behind the rocker. A differential turns the rockers of both sides by opposite angles.
enum class SuspensionKind : int { rocker, rocker_bogie };
constexpr const char* suspension_kinds[] = {"rocker", "rocker_bogie"};

/// skid: no wheel steers. ackermann: front and rear wheels steer about a centre on the y axis. per_wheel:
/// every wheel steers, up to a quarter turn, so that the rover turns on the spot and drives sideways.
enum class Steering : int { skid, ackermann, per_wheel };
constexpr const char* steering_kinds[] = {"skid", "ackermann", "per_wheel"};

/// The defaults describe a rover of 30 kg with four wheels.
struct RoverParameters {
  SuspensionKind suspension = SuspensionKind::rocker;
  Steering steering = Steering::skid;
  double wheelbase = 0.6;
  double track = 0.6;
  double wheel_radius = 0.1;
  double wheel_width = 0.1;
  double pivot_x = 0;
  double pivot_height = 0.1;
  double middle_x = 0;
  double bogie_x = -0.15;
  double bogie_height = 0;
  double body_length = 0.6;
  double body_width = 0.4;
  double body_height = 0.2;
  double clearance = 0.18;
  double mass_height = 0.25;
  double mass = 30;
  double gravity = 9.81;
  WheelLaw wheel_law = WheelLaw::light;
  double assumed_looseness = 0.3;
  double max_speed = 0.3;
  double max_yaw_rate = 0.6;
  double max_wheel_speed = 0.5;
  double max_acceleration = 0.5;
  double max_yaw_acceleration = 2;
  double max_steer_deg = 40;
  double skid_loss = 0.2;
  double max_step = 0.1;
  double max_water = 0.1;
  double max_flow = 0.1;
  double tip_roll_deg = 40;
  double tip_pitch_deg = 40;
  double stuck_slip = 0.9;
  double free_slip = 0.6;
  double stuck_way = 0.5;
  double buried_depth = 0.2;
  std::uint64_t seed = 1;
  double odometry_noise = 0;
  double gyro_noise = 0;
  double accelerometer_noise = 0;
  double imu_filter = 0.1;
};

constexpr auto parameter_table(const RoverParameters*) {
  using P = RoverParameters;
  return std::make_tuple(
      parameter("suspension", &P::suspension, suspension_kinds, "rocker: four wheels; rocker_bogie: six."),
      parameter(
          "steering", &P::steering, steering_kinds,
          "skid: no wheel steers; ackermann: front and rear wheels do; per_wheel: each by up to 90 deg."),
      parameter("wheelbase", &P::wheelbase, 0.05, 20, "m", "From the front axle to the rear one."),
      parameter("track", &P::track, 0.05, 20, "m",
                "From the middle of the left wheels to that of the right ones."),
      parameter("wheel_radius", &P::wheel_radius, 0.01, 5, "m", "Of each wheel."),
      parameter("wheel_width", &P::wheel_width, 0.005, 5, "m", "Of each wheel."),
      parameter("pivot_x", &P::pivot_x, -10, 10, "m", "Of the rockers' pivot, ahead of the middle."),
      parameter("pivot_height", &P::pivot_height, 0, 10, "m", "Of the rockers' pivot above the hubs."),
      parameter("middle_x", &P::middle_x, -10, 10, "m",
                "Of the middle wheels, ahead of the middle (rocker_bogie)."),
      parameter("bogie_x", &P::bogie_x, -10, 10, "m",
                "Of the bogies' pivot, between middle and rear wheels (rocker_bogie)."),
      parameter("bogie_height", &P::bogie_height, 0, 10, "m", "Of the bogies' pivot above the hubs."),
      parameter("body_length", &P::body_length, 0.01, 20, "m", "Of the body."),
      parameter("body_width", &P::body_width, 0.01, 20, "m", "Of the body."),
      parameter("body_height", &P::body_height, 0.01, 20, "m", "From the body's underside to its top."),
      parameter("clearance", &P::clearance, 0.01, 10, "m", "From firm level ground to the body's underside."),
      parameter("mass_height", &P::mass_height, 0, 20, "m", "From firm level ground to the centre of mass."),
      parameter("mass", &P::mass, 0.1, 1e5, "kg", "Of the rover."),
      parameter("gravity", &P::gravity, 0.01, 100, "m/s^2", "Where it drives."),
      parameter("wheel_law", &P::wheel_law, wheel_laws,
                "Slip and sinkage: see kernels/rover/wheel_ground.hpp."),
      parameter("assumed_looseness", &P::assumed_looseness, 0, 1, "1",
                "Looseness of sand where the terrain has no such layer; 0 packed, 1 fresh."),
      parameter("max_speed", &P::max_speed, 0.001, 20, "m/s", "Faster commands are cut to it."),
      parameter("max_yaw_rate", &P::max_yaw_rate, 0.001, 20, "rad/s", "Faster commands are cut to it."),
      parameter("max_wheel_speed", &P::max_wheel_speed, 0.001, 50, "m/s",
                "Of any rim; commands that need more are slowed down as a whole."),
      parameter("max_acceleration", &P::max_acceleration, 0.001, 1000, "m/s^2", "Of the rims."),
      parameter("max_yaw_acceleration", &P::max_yaw_acceleration, 0.001, 1000, "rad/s^2",
                "Of the yaw that rims make."),
      parameter("max_steer_deg", &P::max_steer_deg, 1, 80, "deg", "Largest angle of a wheel (ackermann)."),
      parameter(
          "skid_loss", &P::skid_loss, 0, 0.99, "1",
          "Share of the yaw rate of the rims that wheels lose because they are dragged sideways (skid)."),
      parameter("max_step", &P::max_step, 0.001, 10, "m",
                "Rise of the ground over one wheel radius that stops it."),
      parameter("max_water", &P::max_water, 0, 100, "m", "Depth of water that stops it."),
      parameter("max_flow", &P::max_flow, 0, 1000, "m^2/s", "Depth x speed of water that stops it."),
      parameter("tip_roll_deg", &P::tip_roll_deg, 1, 89, "deg", "Roll at which it tips over."),
      parameter("tip_pitch_deg", &P::tip_pitch_deg, 1, 89, "deg", "Pitch at which it tips over."),
      parameter("stuck_slip", &P::stuck_slip, 0.1, 1, "1", "Slip from which on it makes no way."),
      parameter("free_slip", &P::free_slip, 0, 1, "1",
                "Slip below which it makes way again; at most stuck_slip."),
      parameter("stuck_way", &P::stuck_way, 0.01, 100, "m",
                "Way of the rims at stuck_slip after which it is stuck."),
      parameter("buried_depth", &P::buried_depth, 0.01, 100, "m",
                "Depth of sand on the wheels' contacts, beyond what they sink, at which it cannot drive."),
      parameter("seed", &P::seed, 0, highest_uint64, "1", "Of all noise."),
      parameter(
          "odometry_noise", &P::odometry_noise, 0, 1, "1",
          "Standard deviation of what odometry measures of the way and the yaw of a metre, over these."),
      parameter("gyro_noise", &P::gyro_noise, 0, 10, "rad/s", "Standard deviation of each reading."),
      parameter("accelerometer_noise", &P::accelerometer_noise, 0, 100, "m/s^2",
                "Standard deviation of each reading."),
      parameter("imu_filter", &P::imu_filter, 0, 10, "s",
                "Time constant of what the body's springs take off the accelerations of the ground."));
}
static_assert(table_is_complete<RoverParameters>());

/// What moisture makes of the strength of the ground, as the scenario's section repose says it to the
/// simulation.
struct WetGroundParameters {
  double half_wet = 1.5;
  double saturated = 0.15;
};

constexpr auto parameter_table(const WetGroundParameters*) {
  using P = WetGroundParameters;
  return std::make_tuple(
      parameter("half_wet", &P::half_wet, 0.1, 10, "1",
                "The scenario's repose.half_wet: strength of half-wet ground over that of dry."),
      parameter("saturated", &P::saturated, 0.001, 10, "1",
                "The scenario's repose.saturated: strength of saturated ground over that of dry."));
}
static_assert(table_is_complete<WetGroundParameters>());

/// Throws ConfigError that names `source` and all parameters that do not go together.
void check_rover(const RoverParameters& rover, const std::string& source);

/// The parameters as YAML, one a line; all digits. Rovers with the same text are the same rover. That of wet
/// ground which is the default leaves it out, as earlier versions did.
std::string rover_text(const RoverParameters& rover, const WheelGroundParameters& ground,
                       const WetGroundParameters& wet = {});

/// The wheels of this rover on such ground.
wheels::WheelGround wheels_of(const RoverParameters& rover, const WheelGroundParameters& ground,
                              const WetGroundParameters& wet = {});

constexpr int wheel_count(SuspensionKind kind) { return kind == SuspensionKind::rocker ? 4 : 6; }

}  // namespace desert_sim

#pragma once
/// A rover on living ground: kinematic, with slip and sinkage by the laws of
/// kernels/rover/wheel_ground.hpp. Each internal step of 0.02 s
///
///   1. lets sand come and go under the wheels: what falls on a wheel that stands buries it, what blows away
///      lets it down,
///   2. turns the rims as the command and the limits say,
///   3. moves the body by (1 − s) of that, s the slip by slope and ground under the wheels, and drifts it
///      downhill, unless something is in the way,
///   4. digs each wheel in (sinkage_after()), and settles the body on the wheels.
///
/// A wheel that stands deeper than its slip explains has to climb out of its hole: this adds (excess
/// depth)/(diameter) to the slope, but not on the way back along its own track. That is why a rover that is
/// stuck can get out backwards.
///
/// Everything is a function of parameters, commands and ground: the same give the same bits.

#include <array>
#include <string>

#include "src/rover/contact.hpp"
#include "src/rover/drive.hpp"
#include "src/rover/ground.hpp"
#include "src/rover/rover_parameters.hpp"
#include "src/rover/rover_state.hpp"
#include "src/rover/suspension.hpp"

namespace desert_sim {

/// A reading of the inertial sensors at the body's origin, in its frame, with their noise.
struct ImuReading {
  std::array<double, 3> angular_velocity{};  ///< [rad/s]
  std::array<double, 3> acceleration{};      ///< specific force: at rest (0, 0, g) [m/s²]
};

class Rover {
 public:
  static constexpr double internal_step = 0.02;   ///< [s]
  static constexpr double longest_advance = 600;  ///< [s]

  /// Throws ConfigError, naming `source`, for parameters that do not go together.
  Rover(const RoverParameters& rover, const WheelGroundParameters& ground,
        const std::string& source = "rover", const WetGroundParameters& wet = {});

  const RoverParameters& parameters() const { return rover_; }
  const Suspension& suspension() const { return suspension_; }
  /// What rover_text() says.
  const std::string& text() const { return text_; }
  const RoverState& state() const { return state_; }
  /// For a state of a rover with the same text.
  void set_state(const RoverState& state) { state_ = state; }

  /// Puts it down at rest. Odometry and ways stay, since wheels do not notice. Throws ConfigError where
  /// there is no known ground; nothing is changed then.
  void place(double x, double y, double yaw, const GroundSource& ground);
  /// Begins anew: place(), with odometry, ways, noise and joints as at the start.
  void reset(double x, double y, double yaw, const GroundSource& ground);
  /// Obeys this command for `seconds`; longer than a year is for ever. Throws ConfigError for speeds
  /// beyond ±1e6.
  void drive(const DriveCommand& command, double seconds);
  /// Lets `seconds` pass, 0 … longest_advance, on this ground (null: none is known), in whole internal
  /// steps; what is left waits for the next call. Throws ConfigError for other times.
  void advance(double seconds, const GroundSource* ground);
  /// Notes which state of the terrain the rover has driven on.
  void note_terrain(std::uint64_t step, double time) {
    state_.terrain_step = step, state_.terrain_time = time;
  }

  ImuReading imu() const;

 private:
  void tick(const GroundSource* ground);
  void follow_ground(const GroundSource& ground);
  bool update_condition(const GroundSource& ground);
  void go(const GroundSource& ground);
  /// Means of the wheels: sand on the contacts beyond what they dig themselves in at full slip, and depth of
  /// the water around them [m]; depth × speed of it [m²/s].
  struct OnWheels {
    double sand = 0, water = 0, flow = 0;
  };
  OnWheels on_wheels(const GroundSource& ground) const;
  double slip_on(const WheelMotion& motion, const GroundUnderWheels& under, const GroundSource& ground) const;
  DriveCommand body_motion(const WheelMotion& motion, const GroundUnderWheels& under, double slip) const;
  void turn_wheels(const WheelMotion& motion, const DriveCommand& body, const GroundSource& ground);
  void note_ways(const WheelMotion& motion, const DriveCommand& body);
  void stand(const GroundSource& ground, int iterations);
  void dead_reckon();
  void feel(const Pose& before);
  void halt(RoverCondition condition, const std::string& reason);
  std::string why_stuck(const GroundUnderWheels& under) const;
  WheelState& wheel(int n) { return state_.wheels[static_cast<std::size_t>(n)]; }
  const WheelState& wheel(int n) const { return state_.wheels[static_cast<std::size_t>(n)]; }

  const RoverParameters rover_;
  const std::string text_;
  const wheels::WheelGround law_;
  const Suspension suspension_;
  const Drive drive_;
  const Contact contact_;
  RoverState state_;
};

/// XXH3-64 of all numbers of the state and its condition.
std::uint64_t hash_of(const RoverState& state);

}  // namespace desert_sim

#pragma once
/// The state of a rover: all that its future follows from, beside parameters, commands and ground.

#include <array>
#include <cstdint>
#include <string>

namespace desert_sim {

constexpr int most_wheels = 6;

/// What the rover says of itself, the worst last.
enum class RoverCondition : int { idle, driving, stuck, blocked, buried, tipped, off_grid, no_terrain };
constexpr const char* rover_conditions[] = {"idle",   "driving", "stuck",    "blocked",
                                            "buried", "tipped",  "off_grid", "no_terrain"};

/// A command in the body's frame; sideways is for rovers whose wheels all steer.
struct DriveCommand {
  double forward = 0;   ///< [m/s]
  double sideways = 0;  ///< to the left [m/s]
  double yaw_rate = 0;  ///< counter-clockwise [rad/s]
};

/// Position of the origin of the body's frame and attitude: yaw about z, then pitch about y (nose down),
/// then roll about x (left side up) [m, rad].
struct Pose {
  double x = 0, y = 0, z = 0, roll = 0, pitch = 0, yaw = 0;
};

/// Wheels in the order front left, front right, (middle left, middle right,) rear left, rear right.
struct WheelState {
  double sunk = 0;       ///< how deep it stands in the ground [m]
  double surface = 0;    ///< elevation at which it would stand on top of the ground [m]
  double angle = 0;      ///< that it has turned [rad]
  double steer = 0;      ///< about z, counter-clockwise [rad]
  double rim_speed = 0;  ///< [m/s]
  double slip = 0;       ///< 1 − (speed along the wheel)/(rim speed); 0 while it does not turn
  double dug = 0;  ///< direction of the rim, −1 or 1, in which the wheel last dug itself in; 0: it has not
};

struct RoverState {
  std::uint64_t ticks = 0;  ///< internal steps since the rover was made
  double rest = 0;          ///< time that waits for a whole internal step [s]
  bool placed = false;      ///< whether it stands on ground
  Pose pose;
  double rocker = 0;  ///< angle of the left rocker, nose down; the right one has the opposite [rad]
  std::array<double, 2> bogie{};  ///< of the left and the right bogie against its rocker [rad]
  DriveCommand command;
  std::uint64_t command_ticks = 0;           ///< internal steps for which the command still holds
  DriveCommand rims;                         ///< what the rims do at present
  Pose odometry;                             ///< by the turning of the wheels and the attitude
  std::array<double, 3> velocity{};          ///< of the body's origin in the terrain's frame, filtered [m/s]
  std::array<double, 3> acceleration{};      ///< specific force in the body's frame, with gravity [m/s²]
  std::array<double, 3> angular_velocity{};  ///< in the body's frame [rad/s]
  double way_commanded = 0;                  ///< way of the rims, mean of the wheels [m]
  double way_made = 0;                       ///< way of the body over the ground [m]
  double stalled_way = 0;                    ///< way of the rims since the rover last made way [m]
  double freed_way = 0;                      ///< way made since slip was last above free_slip [m]
  double contact_error = 0;  ///< largest distance of a wheel from where the ground holds it [m]
  double slip = 0;           ///< of all wheels together, along their way
  RoverCondition condition = RoverCondition::no_terrain;
  std::string reason;              ///< why it is in this condition; empty for idle and driving
  std::uint64_t terrain_step = 0;  ///< step of the terrain that it last drove on
  double terrain_time = 0;         ///< its simulated time [s]
  std::array<WheelState, most_wheels> wheels{};
};

/// Calls visit(name, value) for every number of the state but condition, reason and placed, in a fixed
/// order.
template <class State, class Visit>
void for_each_number(State& s, Visit&& visit) {
  const auto pose = [&](const char* name, auto& p) {
    for (auto* v : {&p.x, &p.y, &p.z, &p.roll, &p.pitch, &p.yaw}) visit(name, *v);
  };
  const auto command = [&](const char* name, auto& c) {
    for (auto* v : {&c.forward, &c.sideways, &c.yaw_rate}) visit(name, *v);
  };
  const auto list = [&](const char* name, auto& values) {
    for (auto& v : values) visit(name, v);
  };
  visit("ticks", s.ticks);
  visit("rest", s.rest);
  pose("pose", s.pose);
  visit("rocker", s.rocker);
  list("bogie", s.bogie);
  command("command", s.command);
  visit("command_ticks", s.command_ticks);
  command("rims", s.rims);
  pose("odometry", s.odometry);
  list("velocity", s.velocity);
  list("acceleration", s.acceleration);
  list("angular_velocity", s.angular_velocity);
  visit("way_commanded", s.way_commanded);
  visit("way_made", s.way_made);
  visit("stalled_way", s.stalled_way);
  visit("freed_way", s.freed_way);
  visit("contact_error", s.contact_error);
  visit("slip", s.slip);
  visit("terrain_step", s.terrain_step);
  visit("terrain_time", s.terrain_time);
  for (auto& wheel : s.wheels)
    for (auto* v :
         {&wheel.sunk, &wheel.surface, &wheel.angle, &wheel.steer, &wheel.rim_speed, &wheel.slip, &wheel.dug})
      visit("wheels", *v);
}

}  // namespace desert_sim

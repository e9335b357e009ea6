#include "src/rover/rover.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

constexpr int settling_iterations = 60, following_iterations = 6;

wheels::Ground wheel_ground(const GroundPoint& p) {
  return {static_cast<float>(p.looseness.value_or(0)), static_cast<float>(p.sand_depth),
          static_cast<float>(p.moisture)};
}

bool turns(const WheelMotion& motion) {
  return std::any_of(motion.rim_speed.begin(), motion.rim_speed.end(), [](double v) { return v != 0; });
}

/// Faster than anything: so that what is commanded can be saved and loaded again.
void require_speed(double value, const char* name, const char* unit) {
  constexpr double fastest = 1e6;
  if (std::abs(value) <= fastest) return;
  throw ConfigError(std::string(name) + ": " + number_text(value) + " is not in [" + number_text(-fastest) +
                    ", " + number_text(fastest) + "] " + unit);
}

void require_finite(double value, const char* name) {
  if (std::isfinite(value)) return;
  std::ostringstream text;
  text << name << ": " << value << " is not a finite number";
  throw ConfigError(text.str());
}

}  // namespace

Rover::Rover(const RoverParameters& rover, const WheelGroundParameters& ground, const std::string& source,
             const WetGroundParameters& wet)
    : rover_((check_rover(rover, source), rover)),
      text_(rover_text(rover, ground, wet)),
      law_(wheels_of(rover, ground, wet)),
      suspension_(rover),
      drive_(rover, suspension_),
      contact_(rover, suspension_) {
  state_.reason = "it has not been put on any ground yet";
}

// ---- commands

void Rover::drive(const DriveCommand& command, double seconds) {
  require_speed(command.forward, "linear.x", "m/s");
  require_speed(command.sideways, "linear.y", "m/s");
  require_speed(command.yaw_rate, "angular.z", "rad/s");
  if (!(seconds >= 0)) throw ConfigError("seconds: " + std::to_string(seconds) + " (allowed: at least 0)");
  constexpr double for_ever = 4e8;
  state_.command = command;
  state_.command_ticks =
      static_cast<std::uint64_t>(std::ceil(std::min(seconds, for_ever) / internal_step - 1e-9));
}

void Rover::place(double x, double y, double yaw, const GroundSource& ground) {
  require_finite(x, "x");
  require_finite(y, "y");
  require_finite(yaw, "yaw");
  RoverState s = state_;
  s.pose = {x, y, ground.elevation(x, y).value_or(0) + rover_.wheel_radius, 0, 0, angle_between_turns(yaw)};
  s.rocker = 0;
  s.bogie = {};
  const Hindrance missing = contact_.missing_ground(s, ground);
  if (missing.condition != RoverCondition::idle)
    throw ConfigError("the rover cannot be put there: " + missing.reason);
  s.placed = true;
  s.rims = s.command = {};
  s.command_ticks = 0;
  s.velocity = s.angular_velocity = {};
  s.stalled_way = s.freed_way = s.slip = 0;
  s.condition = RoverCondition::idle;
  s.reason.clear();
  state_ = s;
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const GroundPoint p = contact_.point(suspension_.hub(n, state_), ground);
    wheel(n) = {law_.sinkage(0, 1, wheel_ground(p)), 0, wheel(n).angle, 0, 0, 0, 0};
  }
  stand(ground, settling_iterations);
  dead_reckon();  // the attitude only: the rims stand
  feel(state_.pose);
}

void Rover::reset(double x, double y, double yaw, const GroundSource& ground) {
  const RoverState before = state_;
  state_ = RoverState();
  state_.terrain_step = before.terrain_step;
  state_.terrain_time = before.terrain_time;
  try {
    place(x, y, yaw, ground);
  } catch (...) {
    state_ = before;
    throw;
  }
  state_.odometry = {0, 0, 0, state_.pose.roll, state_.pose.pitch, 0};
}

void Rover::advance(double seconds, const GroundSource* ground) {
  if (!(seconds >= 0 && seconds <= longest_advance))
    throw ConfigError("seconds: " + std::to_string(seconds) + " (allowed: 0 to " +
                      std::to_string(static_cast<int>(longest_advance)) + ")");
  state_.rest += seconds;
  const double whole = std::floor(state_.rest / internal_step + 1e-9);
  state_.rest = std::max(state_.rest - whole * internal_step, 0.0);
  for (double n = 0; n < whole; ++n) tick(ground);
}

// ---- one internal step

void Rover::tick(const GroundSource* ground) {
  ++state_.ticks;
  if (state_.command_ticks > 0)
    --state_.command_ticks;
  else
    state_.command = {};
  if (!state_.placed) return;
  const Pose before = state_.pose;
  if (!ground) {
    halt(RoverCondition::no_terrain, "the terrain is not known");
  } else if (const Hindrance missing = contact_.missing_ground(state_, *ground);
             missing.condition != RoverCondition::idle) {
    halt(missing.condition, missing.reason);
  } else {
    follow_ground(*ground);
    if (update_condition(*ground)) go(*ground);
    stand(*ground, following_iterations);
  }
  dead_reckon();
  feel(before);
}

void Rover::halt(RoverCondition condition, const std::string& reason) {
  state_.condition = condition;
  state_.reason = reason;
  state_.rims = {};
  state_.slip = 0;
  for (WheelState& each : state_.wheels) each.rim_speed = each.slip = 0;
}

/// Sand that comes buries a wheel that stands in sand, and what goes uncovers it before it lets it down.
/// Rock lifts it.
void Rover::follow_ground(const GroundSource& ground) {
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const Eigen::Vector3d hub = suspension_.hub(n, state_);
    const GroundPoint p = contact_.point(hub, ground);
    WheelState& w = wheel(n);
    const double rise = contact_.surface(hub.x(), hub.y(), state_.pose.yaw, ground) - w.surface;
    if (rise > 0) {
      w.sunk += rise;
    } else if (rise < 0) {
      const double standing =
          law_.sinkage(0, static_cast<float>(contact_.load_share(state_, n)), wheel_ground(p));
      w.sunk = std::max(w.sunk + rise, std::min(w.sunk, standing));
    }
    w.sunk = std::min(w.sunk, std::max(p.sand_depth, 0.0));
  }
}

Rover::OnWheels Rover::on_wheels(const GroundSource& ground) const {
  OnWheels mean;
  const double share = 1.0 / suspension_.wheels();
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const GroundPoint p = contact_.point(suspension_.hub(n, state_), ground);
    mean.sand +=
        share * std::max(wheel(n).sunk - static_cast<double>(law_.sinkage(1, 1, wheel_ground(p))), 0.0);
    mean.water += share * p.water;
    mean.flow += share * p.flow();
  }
  return mean;
}

/// Sets what the rover cannot drive out of; false if there is something. A rover that was buried is free once
/// half of the sand is gone.
bool Rover::update_condition(const GroundSource& ground) {
  const double degree = pi / 180;
  std::ostringstream text;
  text.precision(3);
  const auto stopped = [this](RoverCondition condition, const std::string& reason) {
    halt(condition, reason);
    return false;
  };
  if (state_.condition == RoverCondition::tipped) return stopped(RoverCondition::tipped, state_.reason);
  if (std::abs(state_.pose.roll) > rover_.tip_roll_deg * degree) {
    text << "it tipped over: roll " << state_.pose.roll / degree << " deg (at most " << rover_.tip_roll_deg
         << ")";
    return stopped(RoverCondition::tipped, text.str());
  }
  if (std::abs(state_.pose.pitch) > rover_.tip_pitch_deg * degree) {
    text << "it tipped over: pitch " << state_.pose.pitch / degree << " deg (at most " << rover_.tip_pitch_deg
         << ")";
    return stopped(RoverCondition::tipped, text.str());
  }
  const OnWheels on = on_wheels(ground);
  const double limit = rover_.buried_depth * (state_.condition == RoverCondition::buried ? 0.5 : 1);
  if (on.sand > limit) {
    text << "it is buried: " << on.sand << " m of sand came on its wheels (at most " << rover_.buried_depth
         << ")";
    return stopped(RoverCondition::buried, text.str());
  }
  if (on.flow <= rover_.max_flow) return true;
  text << "it has no hold in water that is " << on.water << " m deep and flows with " << on.flow / on.water
       << " m/s: " << on.flow << " m^2/s (at most " << rover_.max_flow << " m^2/s)";
  return stopped(RoverCondition::blocked, text.str());
}

void Rover::go(const GroundSource& ground) {
  state_.rims = drive_.approached(state_.rims, drive_.limited(state_.command), internal_step);
  const WheelMotion motion = drive_.wheels_for(state_.rims, state_.wheels);
  const GroundUnderWheels under = contact_.under(state_, motion, ground);
  state_.slip = turns(motion) ? slip_on(motion, under, ground) : 0;
  const DriveCommand body = body_motion(motion, under, state_.slip);
  RoverState next = state_;
  const elementary::UnitVector heading =
      elementary::direction(state_.pose.yaw + body.yaw_rate * internal_step / 2);
  const double level = internal_step / std::sqrt(1 + under.rise * under.rise);
  next.pose.x += level * (body.forward * heading.x - body.sideways * heading.y);
  next.pose.y += level * (body.forward * heading.y + body.sideways * heading.x);
  next.pose.yaw = angle_between_turns(state_.pose.yaw + body.yaw_rate * internal_step);
  if (turns(motion)) {
    const Hindrance ahead = contact_.hindrance(next, motion, ground),
                    here = contact_.hindrance(state_, motion, ground);
    if (ahead.condition > here.condition ||
        (ahead.condition == here.condition && ahead.condition != RoverCondition::idle &&
         ahead.excess >= here.excess))
      return halt(ahead.condition, ahead.reason);
  }
  state_.pose = next.pose;
  turn_wheels(motion, body, ground);
  note_ways(motion, body);
  const bool stuck = state_.stalled_way >= rover_.stuck_way;
  state_.condition = stuck           ? RoverCondition::stuck
                     : turns(motion) ? RoverCondition::driving
                                     : RoverCondition::idle;
  if (!stuck)
    state_.reason.clear();
  else if (turns(motion) || state_.reason.empty())
    state_.reason = why_stuck(under);
}

/// Of all wheels together. Those that are deeper than this slip explains climb out of their holes.
double Rover::slip_on(const WheelMotion& motion, const GroundUnderWheels& under,
                      const GroundSource& ground) const {
  const double speed = elementary::hypot(motion.body.forward, motion.body.sideways);
  const wheels::Ground mean = wheel_ground(under.mean);
  const auto slip_at = [&](double rise) {
    return law_.longitudinal_slip(static_cast<float>(elementary::atan(rise)), static_cast<float>(speed),
                                  mean);
  };
  const float steady = slip_at(under.rise);
  double climb = 0;
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const WheelState& w = wheel(n);
    if (w.dug * motion.rim_speed[static_cast<std::size_t>(n)] < 0) continue;  // back along its own track
    const GroundPoint p = contact_.point(suspension_.hub(n, state_), ground);
    const double share = contact_.load_share(state_, n);
    const double excess = w.sunk - law_.sinkage(steady, static_cast<float>(share), wheel_ground(p));
    climb += std::max(excess, 0.0) / (2 * rover_.wheel_radius) / suspension_.wheels();
  }
  return climb > 0 ? slip_at(under.rise + climb) : steady;
}

DriveCommand Rover::body_motion(const WheelMotion& motion, const GroundUnderWheels& under,
                                double slip) const {
  DriveCommand body{motion.body.forward * (1 - slip), motion.body.sideways * (1 - slip),
                    motion.body.yaw_rate * (1 - slip)};
  if (rover_.steering == Steering::skid) body.yaw_rate *= 1 - rover_.skid_loss;
  const double speed = elementary::hypot(body.forward, body.sideways);
  if (!(speed > 0)) return body;
  const double drift =
      law_.lateral_slip(static_cast<float>(elementary::atan(under.cross_rise)), wheel_ground(under.mean));
  const double right_x = body.sideways / speed, right_y = -body.forward / speed;
  body.forward += drift * speed * right_x;
  body.sideways += drift * speed * right_y;
  return body;
}

void Rover::turn_wheels(const WheelMotion& motion, const DriveCommand& body, const GroundSource& ground) {
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const auto i = static_cast<std::size_t>(n);
    WheelState& w = wheel(n);
    w.steer = motion.steer[i];
    w.rim_speed = motion.rim_speed[i];
    w.slip = 0;
    if (w.rim_speed == 0) continue;
    const Eigen::Vector3d& place = suspension_.hub_at_rest(n);
    const elementary::UnitVector steer = elementary::direction(w.steer);
    const double along = (body.forward - body.yaw_rate * place.y()) * steer.x +
                         (body.sideways + body.yaw_rate * place.x()) * steer.y;
    w.slip = std::clamp(1 - along / w.rim_speed, -1.0, 1.0);
    const double way = w.rim_speed * internal_step;
    w.angle = angle_between_turns(w.angle + way / rover_.wheel_radius);
    const Eigen::Vector3d hub = suspension_.hub(n, state_);
    const wheels::Ground under = wheel_ground(contact_.point(hub, ground));
    const auto share = static_cast<float>(contact_.load_share(state_, n));
    const auto slip = static_cast<float>(w.slip);
    const double before = w.sunk;
    w.sunk = law_.sinkage_after(static_cast<float>(before), static_cast<float>(way), slip, share, under);
    if (w.sunk > before && w.slip > rover_.free_slip) w.dug = way > 0 ? 1 : -1;
    if (w.sunk < law_.sinkage(0, share, under) + 1e-3) w.dug = 0;
  }
}

void Rover::note_ways(const WheelMotion& motion, const DriveCommand& body) {
  double rims = 0;
  for (int n = 0; n < suspension_.wheels(); ++n)
    rims += std::abs(motion.rim_speed[static_cast<std::size_t>(n)]) / suspension_.wheels();
  const double way = rims * internal_step,
               made = elementary::hypot(body.forward, body.sideways) * internal_step;
  state_.way_commanded += way;
  state_.way_made += made;
  if (state_.slip >= rover_.stuck_slip) {
    state_.stalled_way += way;
    state_.freed_way = 0;
  } else if (state_.slip < rover_.free_slip) {
    state_.freed_way += way * (1 - state_.slip);  // turning on the spot is a way, too
    if (state_.freed_way > rover_.wheel_radius) state_.stalled_way = 0;
  }
}

/// Lets all wheels stand on the ground, and remembers its elevation there.
void Rover::stand(const GroundSource& ground, int iterations) {
  suspension_.settle(
      state_,
      [&](int n, double x, double y) {
        return contact_.surface(x, y, state_.pose.yaw, ground) - wheel(n).sunk + rover_.wheel_radius;
      },
      iterations);
  for (int n = 0; n < suspension_.wheels(); ++n) {
    const Eigen::Vector3d hub = suspension_.hub(n, state_);
    wheel(n).surface = contact_.surface(hub.x(), hub.y(), state_.pose.yaw, ground);
  }
}

std::string Rover::why_stuck(const GroundUnderWheels& under) const {
  double deepest = 0;
  for (int n = 0; n < suspension_.wheels(); ++n) deepest = std::max(deepest, wheel(n).sunk);
  std::ostringstream text;
  text.precision(3);
  text << "its wheels turn and make no way: slip " << state_.slip << ", sunk by " << deepest << " m, slope "
       << elementary::atan_deg(under.rise) << " deg, looseness " << *under.mean.looseness << ", sand "
       << under.mean.sand_depth << " m";
  return text.str();
}

}  // namespace desert_sim

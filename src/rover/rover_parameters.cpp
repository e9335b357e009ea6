#include "src/rover/rover_parameters.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <sstream>

#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

std::string with_value(double value, const std::string& allowed) {
  std::ostringstream text;
  text << value << " (allowed: " << allowed << ")";
  return text.str();
}

}  // namespace

void check_rover(const RoverParameters& r, const std::string& source) {
  ValidationErrors errors(source);
  const double half = r.wheelbase / 2;
  if (!(std::abs(r.pivot_x) < half))
    errors.add("pivot_x", with_value(r.pivot_x, "between the axles, which is less than wheelbase/2 from 0"));
  if (r.suspension == SuspensionKind::rocker_bogie) {
    if (!(std::abs(r.middle_x) < half))
      errors.add("middle_x", with_value(r.middle_x, "between the other axles"));
    if (!(r.bogie_x < r.middle_x && r.bogie_x > -half))
      errors.add("bogie_x",
                 with_value(r.bogie_x, "between middle and rear wheels, -wheelbase/2 ... middle_x"));
  }
  const double wheels_in_a_row = r.suspension == SuspensionKind::rocker ? 1 : 2;
  if (r.wheelbase < 2 * r.wheel_radius * wheels_in_a_row)
    errors.add("wheelbase", with_value(r.wheelbase, "wheels that do not touch each other"));
  if (r.track < r.wheel_width) errors.add("track", with_value(r.track, "at least wheel_width"));
  if (r.free_slip > r.stuck_slip) errors.add("free_slip", with_value(r.free_slip, "at most stuck_slip"));
  errors.throw_if_any();
}

std::string rover_text(const RoverParameters& rover, const WheelGroundParameters& ground,
                       const WetGroundParameters& wet) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  yaml::emit_parameters(out, rover);
  out << YAML::Key << "wheel_ground" << YAML::Value << YAML::BeginMap;
  yaml::emit_parameters(out, ground);
  out << YAML::EndMap;
  const WetGroundParameters usual;
  if (wet.half_wet != usual.half_wet || wet.saturated != usual.saturated) {
    out << YAML::Key << "wet_ground" << YAML::Value << YAML::BeginMap;
    yaml::emit_parameters(out, wet);
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

wheels::WheelGround wheels_of(const RoverParameters& r, const WheelGroundParameters& ground,
                              const WetGroundParameters& wet) {
  TraversabilityParameters p;
  p.wheel_law = r.wheel_law;
  p.mass = static_cast<float>(r.mass);
  p.gravity = static_cast<float>(r.gravity);
  p.wheels = wheel_count(r.suspension);
  p.wheel_radius = static_cast<float>(r.wheel_radius);
  p.wheel_width = static_cast<float>(r.wheel_width);
  ReposeParameters repose;
  repose.half_wet = static_cast<float>(wet.half_wet);
  repose.saturated = static_cast<float>(wet.saturated);
  return wheels::make_wheel_ground(p, ground, repose);
}

}  // namespace desert_sim

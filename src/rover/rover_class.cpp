#include "src/rover/rover_class.hpp"

#include <set>
#include <vector>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

/// `count` numbers of the entry; 0: any number of them.
std::vector<double> numbers(const YAML::Node& section, const char* key, std::size_t count,
                            ValidationErrors& errors) {
  std::vector<double> list;
  const std::string name = "rover_dimensions." + std::string(key),
                    wanted = count ? std::to_string(count) + " " : "";
  try {
    if (!section[key]) throw ConfigError("is missing");
    list = section[key].IsScalar() ? std::vector<double>{section[key].as<double>()}
                                   : section[key].as<std::vector<double>>();
  } catch (const YAML::Exception&) {
    errors.add(name, yaml::node_text(section[key]) + " is given where " + wanted + "numbers are expected");
    return std::vector<double>(count ? count : 2);
  } catch (const ConfigError& e) {
    errors.add(name, e.what());
    return std::vector<double>(count ? count : 2);
  }
  if (count && list.size() != count)
    errors.add(name, "has " + std::to_string(list.size()) + " numbers (allowed: " + wanted + ")");
  list.resize(count ? count : list.size());
  return list;
}

void read_dimensions(const YAML::Node& d, ValidationErrors& errors, RoverParameters& r) {
  const std::vector<double> axles = numbers(d, "axles", 0, errors);
  if (axles.size() != 2 && axles.size() != 3)
    return errors.add("rover_dimensions.axles",
                      "has " + std::to_string(axles.size()) + " numbers (allowed: 2, 3)");
  r.suspension = axles.size() == 2 ? SuspensionKind::rocker : SuspensionKind::rocker_bogie;
  const double middle = (axles.front() + axles.back()) / 2;
  r.wheelbase = axles.front() - axles.back();
  r.track = numbers(d, "track", 1, errors)[0];
  const std::vector<double> rocker = numbers(d, "rocker_pivot", 2, errors),
                            body = numbers(d, "body", 3, errors);
  r.pivot_x = rocker[0] - middle;
  r.pivot_height = rocker[1];
  if (axles.size() == 3) {
    const std::vector<double> bogie = numbers(d, "bogie_pivot", 2, errors);
    r.middle_x = axles[1] - middle;
    r.bogie_x = bogie[0] - middle;
    r.bogie_height = bogie[1];
    if (d["bogie"] && d["bogie"].IsScalar() && d["bogie"].Scalar() != "rear")
      errors.add("rover_dimensions.bogie", not_one_of(d["bogie"].Scalar(), "rear"));
  }
  r.clearance = numbers(d, "clearance", 1, errors)[0];
  r.body_length = body[0];
  r.body_width = body[1];
  r.body_height = body[2];
  const bool steers = d["steered_axles"] && d["steered_axles"].IsSequence() && d["steered_axles"].size() > 0;
  r.steering = steers ? Steering::ackermann : Steering::skid;
  r.max_speed = numbers(d, "max_speed", 1, errors)[0];
}

}  // namespace

RoverParameters rover_of_class(const YAML::Node& file, const std::string& source) {
  ValidationErrors errors(source);
  RoverParameters r;
  if (!file.IsMap() || !file["traversability"] || !file["rover_dimensions"] ||
      !file["rover_dimensions"].IsMap())
    throw ConfigError(
        source + ": is not a class of rovers: it needs the sections traversability and rover_dimensions");
  TraversabilityParameters t;
  yaml::read_section(file["traversability"], "traversability", errors, t);
  read_dimensions(file["rover_dimensions"], errors, r);
  errors.throw_if_any();
  r.wheel_law = t.wheel_law;
  r.mass = t.mass;
  r.gravity = t.gravity;
  r.wheel_radius = t.wheel_radius;
  r.wheel_width = t.wheel_width;
  r.max_step = t.step_height;
  r.max_water = t.water_depth;
  r.max_flow = t.water_flow;
  r.mass_height = r.clearance + r.body_height / 4;
  r.max_wheel_speed = 2 * r.max_speed;
  r.max_acceleration = 2 * r.max_speed;
  r.max_yaw_rate = r.max_speed / (r.track / 2);
  r.max_yaw_acceleration = 4 * r.max_yaw_rate;
  r.stuck_way = 5 * r.wheel_radius;
  r.buried_depth = 2 * r.wheel_radius;
  check_rover(r, source);
  return r;
}

}  // namespace desert_sim

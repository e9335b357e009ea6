/// Requests that change wind and weather: ~set_wind, ~cmd_wind, ~set_wind_schedule, ~edit_wind, ~set_weather.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "kernels/water/water_parameters.hpp"
#include "src/core/did_you_mean.hpp"
#include "src/core/elementary.hpp"
#include "src/core/joined.hpp"
#include "src/ros/services/request_fields.hpp"
#include "src/ros/services/requests.hpp"
#include "src/scenario/wind_feature_lists.hpp"

namespace desert_sim {

// ---- Wind.

command::SetWind wind_command(const SetWindRequest& request) {
  command::SetWind command;
  command.ramp = to_float(request.ramp);
  command.stroke = request.stroke;
  if (!request.use_vector) {
    require_left_out(request.vector, "vector", "use_vector is false");
    command.speed = to_float(request.speed);
    command.direction_deg = to_float(request.direction_deg);
    return command;
  }
  require_left_out(request.speed, "speed", "use_vector is true");
  require_left_out(request.direction_deg, "direction_deg", "use_vector is true");
  require_finite(request.vector.x, "vector.x");
  require_finite(request.vector.y, "vector.y");
  if (!(request.vector.z == 0))
    throw ConfigError("vector.z: " + std::to_string(request.vector.z) + " must be 0: the wind is horizontal");
  command.speed = to_float(elementary::hypot(request.vector.x, request.vector.y));
  command.direction_deg = to_float(elementary::atan2_deg(request.vector.y, request.vector.x));
  return command;
}

command::SetWind cmd_wind_command(const geometry_msgs::Vector3Stamped& message,
                                  const TerrainTransforms& frames) {
  constexpr double largest_slope = 1e-6;  // the rounding of a rotation leaves less
  require_finite(message.vector.x, "vector.x");
  require_finite(message.vector.y, "vector.y");
  require_finite(message.vector.z, "vector.z");
  const tf2::Vector3 wind = frames.to_terrain(message.header).getBasis() *
                            tf2::Vector3(message.vector.x, message.vector.y, message.vector.z);
  if (std::abs(wind.z()) > largest_slope * wind.length())
    throw ConfigError("vector: its vertical component in frame '" + frames.terrain_frame() + "' is " +
                      std::to_string(wind.z()) + " m/s and must be 0: the wind is horizontal");
  command::SetWind command;
  command.stroke = cmd_wind_stroke;
  command.speed = to_float(elementary::hypot(wind.x(), wind.y()));
  command.direction_deg = to_float(elementary::atan2_deg(wind.y(), wind.x()));
  return command;
}

command::SetWindSchedule wind_schedule_command(const SetWindScheduleRequest& request) {
  constexpr const char* kinds[] = {"timeline", "rose"};
  command::SetWindSchedule command;
  command.stroke = request.stroke;
  WindRegime& regime = command.regime;
  regime.regime =
      choice_named<int>(kinds, request.kind, "kind") == 0 ? WindRegimeKind::timeline : WindRegimeKind::rose;
  const bool rose = regime.regime == WindRegimeKind::rose;
  if (request.segments.size() > 4096)
    throw ConfigError("segments: " + std::to_string(request.segments.size()) +
                      " entries are given (allowed: at most 4096)");
  const std::string kind = "kind '" + request.kind + "' does not use it";
  if (rose) {
    require_left_out(request.repeat, "repeat", kind);
    regime.hold_time = to_float(request.hold_time);
  } else {
    require_left_out(request.hold_time, "hold_time", kind);
    require_left_out(request.seed, "seed", kind);
  }
  regime.repeat = request.repeat;
  regime.rose_seed = request.seed;
  for (std::size_t n = 0; n < request.segments.size(); ++n) {
    const WindScheduleSegment& s = request.segments[n];
    const std::string name = "segments[" + std::to_string(n) + "].";
    WindSegment segment;
    segment.direction_deg = to_float(s.direction_deg);
    segment.speed = to_float(s.speed);
    if (rose) {
      require_left_out(s.duration, name + "duration", kind);
      require_left_out(s.ramp, name + "ramp", kind);
      segment.probability = to_float(s.probability);
    } else {
      require_left_out(s.probability, name + "probability", kind);
      segment.duration = to_float(s.duration);
      segment.ramp = to_float(s.ramp);
    }
    regime.segments.push_back(segment);
  }
  return command;
}

namespace {

/// Refuses fields that features of this kind do not have, or, without a kind, all that a feature has.
void check_feature_fields(const EditWindRequest& request, const std::string& why,
                          std::optional<WindFeatureKind> kind) {
  if (!kind) {
    require_left_out(request.kind, "kind", why);
    require_left_out(request.center, "center", why);
    require_left_out(request.radius, "radius", why);
    require_left_out(request.speed, "speed", why);
    require_left_out(request.begin, "begin", why);
    require_left_out(request.end, "end", why);
    require_left_out(request.velocity, "velocity", why);
    require_left_out(request.path, "path", why);
  }
  if (kind != WindFeatureKind::jet) {
    require_left_out(request.direction_deg, "direction_deg", why);
    require_left_out(request.length, "length", why);
  }
  if (kind != WindFeatureKind::turbulence) {
    require_left_out(request.scale, "scale", why);
    require_left_out(request.life_time, "life_time", why);
    require_left_out(request.seed, "seed", why);
  }
}

void set_path(const EditWindRequest& request, const tf2::Transform& transform, WindFeature& feature) {
  const std::string why = "`path` says where the feature is";
  require_left_out(request.center, "center", why);
  require_left_out(request.velocity, "velocity", why);
  if (request.path.size() > max_wind_path)
    throw ConfigError("path: " + std::to_string(request.path.size()) + " points are given (allowed: 2 to " +
                      std::to_string(max_wind_path) + ")");
  for (std::size_t n = 0; n < request.path.size(); ++n) {
    const WindFeaturePoint& given = request.path[n];
    const std::string name = "path[" + std::to_string(n) + "].";
    require_finite(given.time, name + "time");
    require_finite(given.x, name + "x");
    require_finite(given.y, name + "y");
    const tf2::Vector3 place = transform * tf2::Vector3(given.x, given.y, 0);
    feature.path.push_back({given.time, place.x(), place.y()});
  }
}

/// Sets where the feature is: its path, or its centre and velocity.
void set_place(const EditWindRequest& request, const tf2::Transform& transform, WindFeature& feature) {
  if (!request.path.empty()) return set_path(request, transform, feature);
  require_finite(request.center, "center");
  const tf2::Vector3 center = transform * tf2::Vector3(request.center.x, request.center.y, request.center.z);
  feature.x = center.x();
  feature.y = center.y();
  require_finite(request.velocity.x, "velocity.x");
  require_finite(request.velocity.y, "velocity.y");
  if (!(request.velocity.z == 0))
    throw ConfigError("velocity.z: " + std::to_string(request.velocity.z) +
                      " must be 0: features move over the map");
  const tf2::Vector3 velocity =
      transform.getBasis() * tf2::Vector3(request.velocity.x, request.velocity.y, 0);
  feature.velocity_x = to_float(velocity.x());
  feature.velocity_y = to_float(velocity.y());
}

}  // namespace

command::EditWind wind_edit_command(const EditWindRequest& request, const TerrainTransforms& frames) {
  command::EditWind command;
  command.stroke = request.stroke;
  WindFeature& feature = command.feature;
  command.operation = choice_named<WindEdit>(wind_edits, request.operation, "operation");
  feature.id = request.id;
  if (command.operation == WindEdit::remove || command.operation == WindEdit::clear) {
    check_feature_fields(request, "operation '" + request.operation + "' does not use it", {});
    if (command.operation == WindEdit::clear)
      require_left_out(request.id, "id", "operation 'clear' does not use it");
    return command;
  }
  feature.kind = choice_named<WindFeatureKind>(wind_feature_kinds, request.kind, "kind");
  const tf2::Transform transform = frames.to_terrain(request.header);
  set_place(request, transform, feature);
  feature.radius = to_float(request.radius);
  feature.speed = to_float(request.speed);
  require_finite(request.begin, "begin");
  require_finite(request.end, "end");
  feature.begin = request.begin;
  feature.end = request.end;
  check_feature_fields(request, "kind '" + request.kind + "' does not use it", feature.kind);
  if (feature.kind == WindFeatureKind::jet) {
    require_finite(request.direction_deg, "direction_deg");
    feature.direction_deg = to_float(transform == tf2::Transform::getIdentity()
                                         ? request.direction_deg
                                         : direction_in_terrain(request.direction_deg, transform));
    feature.length = to_float(request.length);
  }
  if (feature.kind == WindFeatureKind::turbulence) {
    feature.scale = to_float(request.scale);
    feature.life_time = to_float(request.life_time);
    feature.seed = request.seed;
  }
  return command;
}

// ---- Weather: fields of the request become settings of parameters.

namespace {

std::string setting(const std::string& path, double value, const std::string& name) {
  require_finite(value, name);
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << path << "=" << value;
  return text.str();
}

std::string springs_setting(const SetWeatherRequest& request) {
  std::ostringstream text;
  text.precision(std::numeric_limits<double>::max_digits10);
  text << "water.springs=[";
  for (std::size_t n = 0; n < request.springs.size(); ++n) {
    const auto& s = request.springs[n];
    const std::string name = "springs[" + std::to_string(n) + "].";
    require_finite(s.x, name + "x");
    require_finite(s.y, name + "y");
    require_finite(s.radius, name + "radius");
    require_finite(s.discharge, name + "discharge");
    text << (n ? ", " : "") << "{x: " << s.x << ", y: " << s.y << ", radius: " << s.radius
         << ", discharge: " << s.discharge << "}";
  }
  return text.str() + "]";
}

}  // namespace

command::SetParameters weather_command(const SetWeatherRequest& r) {
  struct Number {
    const char* name;
    double value;
    std::vector<const char*> paths;
  };
  const std::vector<Number> numbers{{"rain_rate", r.rain_rate, {"rain.rate"}},
                                    {"rain_share", r.rain_share, {"rain.share_low", "rain.share_high"}},
                                    {"evaporation", r.evaporation, {"water.evaporation"}},
                                    {"ground_evaporation", r.ground_evaporation, {"moisture.evaporation"}},
                                    {"sea_level", r.sea_level, {"water.sea_level"}},
                                    {"wave_strength", r.wave_strength, {"water.wave_strength"}},
                                    {"wave_period", r.wave_period, {"water.wave_period"}}};
  require_finite(r.ramp, "ramp");
  const std::string known = joined(numbers, [](const Number& n) { return n.name; }) + ", sea, springs";
  if (r.change.empty()) throw ConfigError("change: is empty (allowed: fields to change, of " + known + ")");
  for (const std::string& field : r.change)
    if (field != "sea" && field != "springs" &&
        std::none_of(numbers.begin(), numbers.end(), [&](const Number& n) { return n.name == field; }))
      throw ConfigError("change: " + not_one_of(field, known));
  const auto changes = [&](const std::string& field) {
    return std::find(r.change.begin(), r.change.end(), field) != r.change.end();
  };
  const std::string why = "`change` does not name it";
  for (const Number& number : numbers)
    if (!changes(number.name)) require_left_out(number.value, number.name, why);
  if (!changes("sea")) require_left_out(r.sea, "sea", why);
  if (!changes("springs")) require_left_out(r.springs, "springs", why);
  command::SetParameters command{{}, r.ramp, r.stroke};
  for (const std::string& field : r.change) {
    const auto number =
        std::find_if(numbers.begin(), numbers.end(), [&](const Number& n) { return n.name == field; });
    if (number != numbers.end()) {
      for (const char* path : number->paths) command.settings.push_back(setting(path, number->value, field));
    } else if (field == "sea") {
      choice_named<Sea>(seas, r.sea, "sea");
      command.settings.push_back("water.sea=" + r.sea);
      if (r.sea != "none") command.settings.push_back("water.enabled=true");
    } else {
      command.settings.push_back(springs_setting(r));
    }
  }
  return command;
}

}  // namespace desert_sim

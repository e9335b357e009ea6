#include "src/ros/services/requests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/ros/conversion/patch_image.hpp"

namespace desert_sim {

namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

void require_finite(double value, const std::string& name) {
  if (std::isfinite(value)) return;
  std::ostringstream text;
  text << name << ": = " << value << " is not a finite number";
  throw ConfigError(text.str());
}

/// Beyond what a float holds it is infinite, which the simulation refuses by name.
float narrow(double value) {
  if (std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isnan(value))
    return static_cast<float>(value);
  return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(std::copysign(1.0, value)));
}

template <class Choice, int N>
Choice choose(const char* const (&choices)[N], const std::string& text, const std::string& name) {
  std::string all;
  for (int n = 0; n < N; ++n) {
    if (text == choices[n]) return static_cast<Choice>(n);
    all += (n ? ", " : "") + std::string(choices[n]);
  }
  throw ConfigError(name + ": " + quoted(text) + " is not one of: " + all);
}

/// A direction of the header's frame in the terrain's, seen from above [deg].
double turned(double angle_deg, const tf2::Transform& transform) {
  const tf2::Vector3 axis =
      transform.getBasis() * tf2::Vector3(std::cos(angle_deg / degrees), std::sin(angle_deg / degrees), 0);
  return std::atan2(axis.y(), axis.x()) * degrees;
}

}  // namespace

void require_finite(const geometry_msgs::Point& point, const std::string& name) {
  require_finite(point.x, name + ".x");
  require_finite(point.y, name + ".y");
  require_finite(point.z, name + ".z");
}

TerrainFormat terrain_format(const std::string& name) {
  return choose<TerrainFormat>(terrain_formats, name, "format");
}

command::SetWind wind_command(const SetWindRequest& request) {
  command::SetWind command;
  command.ramp = narrow(request.ramp);
  if (!request.use_vector) {
    command.speed = narrow(request.speed);
    command.direction_deg = narrow(request.direction_deg);
    return command;
  }
  require_finite(request.vector.x, "vector.x");
  require_finite(request.vector.y, "vector.y");
  if (!(request.vector.z == 0))
    throw ConfigError("vector.z: = " + std::to_string(request.vector.z) +
                      " must be 0: the wind is horizontal");
  command.speed = narrow(std::hypot(request.vector.x, request.vector.y));
  command.direction_deg = narrow(std::atan2(request.vector.y, request.vector.x) * degrees);
  return command;
}

command::SetWind streamed_wind(const geometry_msgs::Vector3Stamped& message, const Frames& frames) {
  constexpr double level = 1e-6;  // what a rotation's rounding leaves
  require_finite(message.vector.x, "vector.x");
  require_finite(message.vector.y, "vector.y");
  require_finite(message.vector.z, "vector.z");
  const tf2::Vector3 wind = frames.to_terrain(message.header).getBasis() *
                            tf2::Vector3(message.vector.x, message.vector.y, message.vector.z);
  if (std::abs(wind.z()) > level * wind.length())
    throw ConfigError("vector: its vertical part in frame '" + frames.terrain_frame() + "' is " +
                      std::to_string(wind.z()) + " m/s and must be 0: the wind is horizontal");
  command::SetWind command;
  command.speed = narrow(std::hypot(wind.x(), wind.y()));
  command.direction_deg = narrow(std::atan2(wind.y(), wind.x()) * degrees);
  return command;
}

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
  if (r.change.empty()) throw ConfigError("change: names nothing that is to change");
  command::SetParameters command{{}, r.ramp};
  for (const std::string& field : r.change) {
    const auto number =
        std::find_if(numbers.begin(), numbers.end(), [&](const Number& n) { return n.name == field; });
    if (number != numbers.end()) {
      for (const char* path : number->paths) command.settings.push_back(setting(path, number->value, field));
    } else if (field == "sea") {
      choose<Sea>(seas, r.sea, "sea");
      command.settings.push_back("water.sea=" + r.sea);
      if (r.sea != "none") command.settings.push_back("water.enabled=true");
    } else if (field == "springs") {
      command.settings.push_back(springs_setting(r));
    } else {
      std::string all = "sea, springs";
      for (const Number& known : numbers) all += std::string(", ") + known.name;
      throw ConfigError("change: " + quoted(field) + " is not one of: " + all);
    }
  }
  return command;
}

command::SetWindSchedule schedule_command(const SetWindScheduleRequest& request) {
  constexpr const char* kinds[] = {"timeline", "rose"};
  command::SetWindSchedule command;
  WindRegime& regime = command.regime;
  regime.regime =
      choose<int>(kinds, request.kind, "kind") == 0 ? WindRegimeKind::timeline : WindRegimeKind::rose;
  const bool rose = regime.regime == WindRegimeKind::rose;
  if (request.segments.size() > 4096)
    throw ConfigError("segments: " + std::to_string(request.segments.size()) + " entries are more than 4096");
  regime.repeat = request.repeat;
  if (rose) regime.hold_time = narrow(request.hold_time);
  regime.rose_seed = request.seed;
  // What the kind does not look at keeps its default, whatever the request says.
  for (const WindScheduleSegment& s : request.segments) {
    WindSegment segment;
    segment.direction_deg = narrow(s.direction_deg);
    segment.speed = narrow(s.speed);
    if (rose) {
      segment.probability = narrow(s.probability);
    } else {
      segment.duration = narrow(s.duration);
      segment.ramp = narrow(s.ramp);
    }
    regime.segments.push_back(segment);
  }
  return command;
}

command::EditWind wind_edit_command(const EditWindRequest& request, const Frames& frames) {
  command::EditWind command;
  WindFeature& feature = command.feature;
  command.operation = choose<WindEdit>(wind_edits, request.operation, "operation");
  feature.id = request.id;
  if (command.operation == WindEdit::remove || command.operation == WindEdit::clear) return command;
  feature.kind = choose<WindFeatureKind>(wind_feature_kinds, request.kind, "kind");
  require_finite(request.center, "center");
  const tf2::Transform transform = frames.to_terrain(request.header);
  const tf2::Vector3 center = transform * tf2::Vector3(request.center.x, request.center.y, request.center.z);
  feature.x = narrow(center.x());
  feature.y = narrow(center.y());
  feature.radius = narrow(request.radius);
  feature.speed = narrow(request.speed);
  // What the kind does not look at keeps its default, whatever the request says.
  if (feature.kind == WindFeatureKind::jet) {
    require_finite(request.direction_deg, "direction_deg");
    feature.direction_deg =
        narrow(transform == tf2::Transform::getIdentity() ? request.direction_deg
                                                          : turned(request.direction_deg, transform));
    feature.length = narrow(request.length);
  }
  if (feature.kind == WindFeatureKind::turbulence) {
    feature.scale = narrow(request.scale);
    feature.life_time = narrow(request.life_time);
    feature.seed = request.seed;
  }
  return command;
}

namespace {

/// Points on a tilted frame are projected; a direction there can lose its meaning.
void require_upright(const tf2::Transform& transform, const std::string& frame) {
  const double up = (transform.getBasis() * tf2::Vector3(0, 0, 1)).z();
  if (up >= std::cos(45 / degrees)) return;
  throw ConfigError("frame " + quoted(frame) + " is tilted by " +
                    std::to_string(std::acos(std::max(-1.0, up)) * degrees) +
                    " deg against the terrain's, which leaves angle_deg without a meaning (allowed: 45)");
}

/// Centre, sizes and angle, as far as the shape has them.
template <class Request, class Command>
void set_rectangle(const Request& request, const tf2::Transform& transform, Command& command) {
  desert_sim::require_finite(request.center, "center");
  require_finite(request.angle_deg, "angle_deg");
  const tf2::Vector3 center = transform * tf2::Vector3(request.center.x, request.center.y, request.center.z);
  command.x = center.x();
  command.y = center.y();
  command.radius = request.radius;
  if (command.shape == BrushShape::circle) return;
  const bool same = transform == tf2::Transform::getIdentity();
  if (!same) require_upright(transform, request.header.frame_id);
  command.radius_y = request.radius_y;
  command.angle_deg = same ? request.angle_deg : turned(request.angle_deg, transform);
}

template <class Request, class Command>
void set_points(const Request& request, const tf2::Transform& transform, Command& command) {
  constexpr std::size_t most = command::EditTerrain::most_points;
  if (request.points.size() > most)
    throw ConfigError("points: " + std::to_string(request.points.size()) +
                      " are given (allowed: " + std::to_string(most) + ")");
  for (std::size_t n = 0; n < request.points.size(); ++n) {
    const geometry_msgs::Point& given = request.points[n];
    desert_sim::require_finite(given, "points[" + std::to_string(n) + "]");
    const tf2::Vector3 p = transform * tf2::Vector3(given.x, given.y, given.z);
    command.points.push_back({p.x(), p.y()});
  }
}

void set_patch(const EditTerrainRequest& request, command::EditTerrain& command) {
  command.patch_use = request.image_use.empty()
                          ? PatchUse::heights
                          : choose<PatchUse>(patch_uses, request.image_use, "image_use");
  const bool heights = command.patch_use == PatchUse::heights;
  if (heights) require_finite(request.image_scale, "image_scale");
  command.patch = patch_of(request.image, heights ? request.image_scale : 1.0);
}

}  // namespace

command::EditTerrain edit_command(const EditTerrainRequest& request, const Frames& frames) {
  command::EditTerrain command;
  command.layer = request.layer;
  command.shape = choose<BrushShape>(brush_shapes, request.shape, "shape");
  command.merge = choose<BrushMerge>(brush_merges, request.merge, "merge");
  const bool capsule = command.shape == BrushShape::capsule, polygon = command.shape == BrushShape::polygon;
  const bool patch = command.shape == BrushShape::patch;
  const tf2::Transform transform = frames.to_terrain(request.header);
  if (capsule || polygon)
    set_points(request, transform, command);
  else
    set_rectangle(request, transform, command);
  if (capsule) command.radius = request.radius;
  if (patch) set_patch(request, command);
  (polygon || patch ? command.falloff : command.inner) = polygon || patch ? request.falloff : request.inner;
  if (command.merge == BrushMerge::smooth) {
    command.smooth_radius = request.smooth_radius;
    command.smooth_passes = request.smooth_passes;
  } else {
    command.value = request.value;
  }
  command.conserve = request.conserve;
  if (command.conserve) command.ring_width = request.ring_width;
  return command;
}

command::EditPlants plants_command(const EditPlantsRequest& request, const Frames& frames) {
  command::EditPlants command;
  command.operation = choose<PlantEdit>(plant_edits, request.operation, "operation");
  command.species = request.species;
  command.shape = choose<BrushShape>(brush_shapes, request.shape, "shape");
  if (command.shape == BrushShape::patch)
    throw ConfigError("shape: 'patch' is not one of: circle, ellipse, rectangle, capsule, polygon");
  const bool capsule = command.shape == BrushShape::capsule;
  const tf2::Transform transform = frames.to_terrain(request.header);
  if (capsule || command.shape == BrushShape::polygon)
    set_points(request, transform, command);
  else
    set_rectangle(request, transform, command);
  if (capsule) command.radius = request.radius;
  if (command.operation == PlantEdit::plant) {
    command.density = request.density;
    command.size = request.size;
    command.seed = request.seed;
  }
  return command;
}

}  // namespace desert_sim

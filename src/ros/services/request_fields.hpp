#pragma once
/// Checks and conversions of the fields of requests. What is refused throws ConfigError that names the field,
/// its value and what is allowed.

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>
#include <tf2/LinearMath/Transform.h>

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include "src/core/did_you_mean.hpp"
#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/joined.hpp"

namespace desert_sim {

inline void require_finite(double value, const std::string& name) {
  if (std::isfinite(value)) return;
  std::ostringstream text;
  text << name << ": " << value << " is not a finite number";
  throw ConfigError(text.str());
}

/// Throws unless all coordinates are finite; `name` is what the point is called.
inline void require_finite(const geometry_msgs::Point& point, const std::string& name) {
  require_finite(point.x, name + ".x");
  require_finite(point.y, name + ".y");
  require_finite(point.z, name + ".z");
}

/// As a float. A number that a float cannot hold becomes infinite, which the simulation refuses by name.
inline float to_float(double value) {
  if (std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()) || std::isnan(value))
    return static_cast<float>(value);
  return std::copysign(std::numeric_limits<float>::infinity(), static_cast<float>(std::copysign(1.0, value)));
}

/// The enumerator, numbered as `choices` are, whose name is `text`.
template <class Choice, int N>
Choice choice_named(const char* const (&choices)[N], const std::string& text, const std::string& name) {
  for (int n = 0; n < N; ++n)
    if (text == choices[n]) return static_cast<Choice>(n);
  throw ConfigError(name + ": " + not_one_of(text, joined(choices)));
}

// Whether a field was left out: such fields of messages are 0 or empty.
template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
bool is_left_out(Number value) {
  return value == 0;
}
inline bool is_left_out(const std::string& text) { return text.empty(); }
template <class T, class Allocator>
bool is_left_out(const std::vector<T, Allocator>& values) {
  return values.empty();
}
inline bool is_left_out(const geometry_msgs::Point& p) { return p.x == 0 && p.y == 0 && p.z == 0; }
inline bool is_left_out(const geometry_msgs::Vector3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/// Refuses a field that is set although nothing uses it, as `why` says: who sets it expects something else
/// than would happen.
template <class Field>
void require_left_out(const Field& field, const std::string& name, const std::string& why) {
  if (!is_left_out(field)) throw ConfigError(name + ": is set, but " + why + " (allowed: leave it out)");
}

/// A direction in another frame as a direction in the terrain's, both seen from above [deg].
inline double direction_in_terrain(double angle_deg, const tf2::Transform& transform) {
  const elementary::UnitVector along = elementary::direction_deg(angle_deg);
  const tf2::Vector3 axis = transform.getBasis() * tf2::Vector3(along.x, along.y, 0);
  return elementary::atan2_deg(axis.y(), axis.x());
}

}  // namespace desert_sim

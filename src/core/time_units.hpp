#pragma once
/// Times that people write with a unit.

#include <string>

namespace desert_sim {

/// The units of time, as error messages list them. A year (a) has 365.25 days.
constexpr const char* time_units = "ms, s, min, h, d, a";
constexpr double seconds_per_year = 365.25 * 86400;

/// Reads a number that is followed by a unit of time, such as "1 h" or "24a". False if `text` is not one;
/// `seconds` is then unchanged.
bool read_time_with_unit(const std::string& text, double& seconds);

/// A time that may have a unit; a plain number is in seconds. Throws ConfigError, in the name of `what`,
/// unless it is one in [lowest, highest] s.
double read_time(const std::string& text, const std::string& what, double lowest, double highest);

}  // namespace desert_sim

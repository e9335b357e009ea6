#include "src/io/declared_values.hpp"

#include <cmath>

#include "src/core/lower_case.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {

namespace {

constexpr double foot = 0.3048, us_survey_foot = 1200.0 / 3937;

struct LengthUnit {
  const char* name;
  double metres;
};
constexpr LengthUnit length_units[] = {{"m", 1},
                                       {"metre", 1},
                                       {"mm", 0.001},
                                       {"millimetre", 0.001},
                                       {"cm", 0.01},
                                       {"centimetre", 0.01},
                                       {"dm", 0.1},
                                       {"decimetre", 0.1},
                                       {"km", 1000},
                                       {"kilometre", 1000},
                                       {"ft", foot},
                                       {"foot", foot},
                                       {"international foot", foot},
                                       {"us-ft", us_survey_foot},
                                       {"us_ft", us_survey_foot},
                                       {"ftus", us_survey_foot},
                                       {"foot_us", us_survey_foot},
                                       {"us survey foot", us_survey_foot},
                                       {"survey foot", us_survey_foot},
                                       {"fathom", 6 * foot}};

void replace_end(std::string& text, const std::string& end, const std::string& other) {
  if (text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0)
    text.replace(text.size() - end.size(), end.size(), other);
}

/// "Meters" is "metre", "feet" is "foot".
std::string one_of(const std::string& unit) {
  std::string name = lower_case(unit);
  replace_end(name, "feet", "foot");
  replace_end(name, "fathoms", "fathom");
  replace_end(name, "meters", "metre");
  replace_end(name, "metres", "metre");
  replace_end(name, "meter", "metre");
  return name;
}

bool without_dimension(const std::string& unit) {
  for (const char* name : {"", "1", "%", "none", "unknown", "unitless", "dimensionless"})
    if (unit == name) return true;
  return false;
}

}  // namespace

std::optional<double> metres_of_unit(const std::string& unit) {
  const std::string name = one_of(unit);
  for (const LengthUnit& known : length_units)
    if (name == known.name) return known.metres;
  return std::nullopt;
}

DeclaredValues declared_values(const std::string& path, double scale, double offset, const std::string& unit,
                               double given_scale, std::vector<std::string>& warnings) {
  if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset))
    throw_raster_error(path, concatenate("declares the scale ", scale, " and the offset ", offset,
                                         " for its values; both must be finite, the scale not 0"));
  const std::optional<double> metres = metres_of_unit(unit);
  if (!metres && !without_dimension(lower_case(unit)))
    warnings.push_back("raster '" + path + "': its values are in the unit '" + unit +
                       "', which is no length known here; they are taken as they are");
  const DeclaredValues declared{scale * metres.value_or(1), offset * metres.value_or(1)};
  if (declared.scale == 1 || std::abs(given_scale / declared.scale - 1) > 1e-3) return declared;
  warnings.push_back(concatenate("raster '", path, "': the scenario's scale of ", given_scale,
                                 " is what the file declares, and is applied once; it is no longer needed"));
  return {};
}

}  // namespace desert_sim

#pragma once
/// Which parameters of a scenario can change while its simulation runs, and changing them.

#include <string>
#include <utility>
#include <vector>

#include "src/scenario/sections.hpp"

namespace desert_sim {

/// What cannot: a parameter, a list, or (without a dot) a whole section.
struct FixedParameter {
  const char *path, *why;
};
constexpr FixedParameter fixed_parameters[] = {
    {"seed", "the terrain was made with it"},
    {"grid", "it shapes the terrain's memory"},
    {"terrain", "it is what the terrain was made of"},
    {"vegetation.enabled", "plants are there from the start, or never"},
    {"vegetation.max_plants", "the plants' memory has that size"},
    {"species", "plants that stand are of them"},
    {"competition", "it goes with species"},
    {"run.steps", "it is of a headless run"},
    {"run.time_step", "simulated time is counted in it"},
    {"run.timeline", "it is followed from the start on"},
    {"wind.segments", "set_wind_schedule changes them together"},
    {"wind.features", "edit_wind adds, changes and removes them"},
};

/// Why the parameter or list `path` ("grid.width", "wind.segments") cannot change while a simulation runs;
/// null if it can, or is unknown.
const char* why_fixed(const std::string& path);

/// Calls visit(section, row, value) for each parameter that can change.
template <class S, class Visit>
void for_each_live_parameter(S& scenario, Visit&& visit) {
  const auto rows = [&](const char* section, auto& parameters) {
    for_each_parameter(parameters, [&](const auto& row, auto& value) {
      if (!why_fixed(std::string(section) + "." + row.name)) visit(section, row, value);
    });
  };
  for_each_section(scenario, rows);
  rows("wind", scenario.wind_regime);
  rows("wind", scenario.wind);
  rows("water", scenario.water);
  rows("run", scenario.run);
}

/// `scenario` with settings ("wind.speed=7") of parameters that can change. Throws ConfigError that lists all
/// that cannot, are unknown, or have a value that is refused.
Scenario with_live_settings(const Scenario& scenario, const Settings& settings);

/// What `now` has other than `before`, as path and value; a list is one value.
std::vector<std::pair<std::string, std::string>> changed_parameters(const Scenario& before,
                                                                    const Scenario& now);

}  // namespace desert_sim

#pragma once
/// Parameters of a scenario that can change while its simulation runs.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// A parameter, a list, or (a path without a dot) a whole section that cannot change, and the reason.
struct FixedParameter {
  const char *path, *reason;
};
constexpr FixedParameter fixed_parameters[] = {
    {"seed", "the initial terrain was generated with it"},
    {"grid", "the layers are allocated for this grid"},
    {"terrain", "it describes the initial terrain"},
    {"vegetation.max_plants", "the memory of the plants is allocated for this number"},
    {"vegetation.largest_plant", "the look-up of plants is made for this radius"},
    {"run.steps", "it is the length of a headless run"},
    {"run.duration", "it is the length of a headless run"},
    {"run.start_from", "it is the start of a simulation"},
    {"wind.series_file", "it is read at the start of a simulation"},
    {"wind.series_direction", "it belongs to wind.series_file"},
    {"wind.series_angle", "it belongs to wind.series_file"},
    {"wind.series_start", "it belongs to wind.series_file"},
    {"wind.series_gap", "it belongs to wind.series_file"},
    {"wind.segments", "set_wind_schedule changes them together"},
    {"wind.features", "edit_wind adds, changes and removes them"},
};

/// The reason why the parameter or list `path` ("grid.width", "wind.segments") cannot change while a
/// simulation runs; null if it can change or is unknown.
const char* fixed_reason(const std::string& path);

/// Calls visit(section, row, value) for each parameter that can change.
using LiveParameterVisit =
    std::function<void(const std::string& section, const ParameterRow& row, ConstParameterValue value)>;
void visit_live_parameters(const Scenario& scenario, const LiveParameterVisit& visit);

/// visit_live_parameters() with the type of each value: visit(section, row, const T& value).
template <class Visit>
void for_each_live_parameter(const Scenario& scenario, Visit&& visit) {
  visit_live_parameters(scenario,
                        [&](const std::string& section, const ParameterRow& row, ConstParameterValue value) {
                          std::visit([&](const auto* at) { visit(section, row, *at); }, value);
                        });
}

/// A copy of `scenario` with some parameters set ("wind.speed=7"). Of the lists `species`, `competition` and
/// `growth_curves`, too, whole or in part ("species.0.max_radius=2"): a species keeps its place and name,
/// because plants refer to it, and others may follow ("species.2={preset: tree}"), which compete by 1. Plants
/// can begin to live (vegetation.enabled), but not end. `run.timeline` is replaced whole. Throws ConfigError
/// that lists all settings that cannot change, are unknown, or have an invalid value.
Scenario with_live_settings(const Scenario& scenario, const Settings& settings);

/// All parameters as YAML in flow style, by path; a list counts as one value.
using ParameterTexts = std::map<std::string, std::string>;
ParameterTexts parameter_texts(const Scenario& scenario);
/// A copy of `scenario` with what parameter_texts() said of another one; none: the parameter is not there.
/// Whether they can change while a simulation runs is for the caller to know. `what` is named in errors.
Scenario with_parameter_texts(const Scenario& scenario,
                              const std::map<std::string, std::optional<std::string>>& texts,
                              const std::string& what);

/// The parameters of `now` that differ from `before`, as path and value; a list counts as one value.
std::vector<std::pair<std::string, std::string>> changed_parameters(const Scenario& before,
                                                                    const Scenario& now);

}  // namespace desert_sim

#include "src/ros/forecast/forecast_request.hpp"

#include <algorithm>
#include <limits>

#include "src/core/did_you_mean.hpp"
#include "src/ros/services/request_fields.hpp"
#include "src/ros/services/requests.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/range_checks.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

int to_int(std::uint32_t number) {
  return static_cast<int>(std::min<std::uint32_t>(number, std::numeric_limits<int>::max()));
}

/// A forecast shows the desert: parameters of topics would have no effect.
template <class Entries>
void require_parameters_of_the_desert(const Entries& entries) {
  for (const auto& entry : entries)
    if (entry.name.find("__") == std::string::npos && entry.name != "step_rate")
      throw ConfigError("parameters: " + in_quotes(entry.name) +
                        " is no parameter of the desert (allowed: SECTION__KEY of the scenario, step_rate)");
}

void add_wind(const ForecastTerrainGoal& goal, std::vector<ForecastCommand>& commands) {
  const bool has_wind = !goal.wind.empty();
  const bool schedule = has_wind && goal.wind_kind != "constant";
  const std::string why =
      has_wind ? "wind_kind '" + goal.wind_kind + "' does not use it" : "there are no segments of wind";
  if (!schedule) {
    require_left_out(goal.wind_repeat, "wind_repeat", why);
    require_left_out(goal.wind_hold_time, "wind_hold_time", why);
    require_left_out(goal.wind_seed, "wind_seed", why);
  }
  if (!has_wind) {
    if (!goal.wind_kind.empty())
      throw ConfigError("wind: has no segments for the wind_kind " + in_quotes(goal.wind_kind) +
                        " (allowed: none of both, or both)");
    return;
  }
  if (goal.wind_kind == "constant") {
    if (goal.wind.size() != 1)
      throw ConfigError("wind: " + std::to_string(goal.wind.size()) +
                        " segments are given for a constant wind (allowed: 1)");
    const WindScheduleSegment& segment = goal.wind.front();
    require_left_out(segment.duration, "wind[0].duration", why);
    require_left_out(segment.probability, "wind[0].probability", why);
    const command::SetWind wind{to_float(segment.direction_deg), to_float(segment.speed),
                                to_float(segment.ramp)};
    check_ranges(wind, "wind");
    commands.push_back(wind);
    return;
  }
  if (goal.wind_kind != "timeline" && goal.wind_kind != "rose")
    throw ConfigError("wind_kind: " + not_one_of(goal.wind_kind, "timeline, rose, constant"));
  SetWindScheduleRequest request;
  request.kind = goal.wind_kind;
  request.segments = goal.wind;
  request.repeat = goal.wind_repeat;
  request.hold_time = goal.wind_hold_time;
  request.seed = goal.wind_seed;
  const command::SetWindSchedule command = wind_schedule_command(request);
  check_wind_schedule(command.regime, "wind");
  commands.push_back(command);
}

}  // namespace

ForecastOptions forecast_options(const ForecastTerrainGoal& goal, const LiveParameters& present,
                                 double step_rate) {
  ForecastOptions options;
  options.horizon = goal.horizon;
  options.moments = to_int(goal.moments);
  options.members = std::max(1, to_int(goal.members));
  options.stride = std::max(1, to_int(goal.stride));
  check_ranges(static_cast<const ForecastParameters&>(options), "forecast");
  if (options.members > 1) {
    options.gusts = {goal.gust_speed, goal.gust_direction_deg, goal.gust_time, goal.seed};
    check_ranges(options.gusts, "forecast");
  } else {
    const std::string why = "there is one member";
    require_left_out(goal.gust_speed, "gust_speed", why);
    require_left_out(goal.gust_direction_deg, "gust_direction_deg", why);
    require_left_out(goal.gust_time, "gust_time", why);
    require_left_out(goal.seed, "seed", why);
  }
  require_parameters_of_the_desert(goal.parameters.bools);
  require_parameters_of_the_desert(goal.parameters.ints);
  require_parameters_of_the_desert(goal.parameters.strs);
  require_parameters_of_the_desert(goal.parameters.doubles);
  const LiveChange change = reconfigure_change(goal.parameters, present);
  options.step_rate = change.step_rate == present.step_rate ? step_rate : change.step_rate;
  if (!change.settings.empty()) {
    process_table().require_runnable(with_live_settings(present.scenario, change.settings));
    options.commands.push_back(command::SetParameters{change.settings});
  }
  add_wind(goal, options.commands);
  return options;
}

}  // namespace desert_sim

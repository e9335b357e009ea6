#include "src/simulation/pipeline/process_table.hpp"

#include <algorithm>
#include <cstdio>

#include "src/core/validation_errors.hpp"

namespace desert_sim {

bool ProcessTable::is_active(const Process& process, const Scenario& scenario) const {
  const auto takes_its_place = [&](const Process& other) {
    return !other.gives_way && other.active(scenario) &&
           std::find_first_of(other.roles.begin(), other.roles.end(), process.roles.begin(),
                              process.roles.end()) != other.roles.end();
  };
  return process.active(scenario) &&
         !(process.gives_way && std::any_of(processes.begin(), processes.end(), takes_its_place));
}

namespace {

void check_wind_series(const Scenario& s, ValidationErrors& errors) {
  if (!s.wind_series) return;
  const double step = s.run.time_step, shortest = s.wind_series->shortest_interval();
  if (step <= max_parts_of_step * shortest) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "%g s is %g times the shortest time between rows of wind.series_file, %g s (allowed: at "
                "most %d times, %g s)",
                step, step / shortest, shortest, max_parts_of_step, max_parts_of_step * shortest);
  errors.add("run.time_step", text);
}

void check_acceleration(const Scenario& s, ValidationErrors& errors) {
  const double step = s.run.time_step, acceleration = s.run.acceleration, rate = acceleration / step;
  if (acceleration == 0 || (rate <= max_accelerated_rate && acceleration >= min_acceleration)) return;
  char text[200];
  std::snprintf(
      text, sizeof text,
      "%g needs %g steps of %g s per second (allowed: 0, or %g to %g, which is %g steps per second)",
      acceleration, rate, step, min_acceleration, max_accelerated_rate * step, max_accelerated_rate);
  errors.add("run.acceleration", text);
}

}  // namespace

void ProcessTable::require_runnable(const Scenario& scenario) const {
  ValidationErrors errors(scenario.name);
  check_wind_series(scenario, errors);
  check_acceleration(scenario, errors);
  for (const Process& process : processes)
    if (process.check && is_active(process, scenario)) process.check(scenario, errors);
  errors.throw_if_any();
}

}  // namespace desert_sim

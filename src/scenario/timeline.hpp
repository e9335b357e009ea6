#pragma once
/// `run.timeline`: parameters that change at given simulated times, at once or over a ramp.
///
///     run:
///       timeline:
///         - {time: 500, ramp: 200, set: {rain.rate: 2.0e-5, wind.speed: 3}}
///
/// Any parameter that can change while a simulation runs can be set. A floating-point parameter changes
/// linearly over `ramp` seconds from its value at `time` to the new one, in Ramp::step_count equal steps; all
/// others change at `time`.

#include <string>
#include <utility>
#include <vector>

#include "src/core/parameter_table.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

struct Scenario;
class ValidationErrors;

struct TimelineEntry {
  double time = 0, ramp = 0;            ///< [s]
  std::vector<std::string> settings{};  ///< "path=value"
};
constexpr std::size_t max_timeline_entries = 4096;

/// A parameter that changes linearly from one value to another, in a number of equal steps.
struct Ramp {
  static constexpr int step_count = 50;
  std::string path;
  double from = 0, to = 0;
  double start = 0, duration = 0;  ///< [s]
  int step_index = 0;              ///< the step that has been reached, 0 … step_count

  /// The step that belongs to a simulated time [s].
  int step_index_at(double time) const;
  /// The parameter's value at the present step.
  double value() const {
    return step_index == step_count ? to : from + (to - from) * step_index / step_count;
  }
};

constexpr auto parameter_table(const Ramp*) {
  using P = Ramp;
  return std::make_tuple(
      parameter("path", &P::path, "Section and name of a floating-point parameter."),
      parameter("from", &P::from, -1e300, 1e300, "", "Its value at the start."),
      parameter("to", &P::to, -1e300, 1e300, "", "Its value at the end."),
      parameter("start", &P::start, 0, 1e20, "s", "Simulated time at which the ramp began."),
      parameter("duration", &P::duration, 0, 1e12, "s", "How long it lasts."),
      parameter("stair", &P::step_index, 0, Ramp::step_count - 1, "1", "The step that has been reached."));
}
static_assert(table_is_complete<Ramp>());

/// Adds an error for each value with which the ramp could not be going on at `time` [s]: a path that is no
/// floating-point parameter or one that cannot change, ends out of its range, a start that lies ahead.
void check_ramp(const Scenario& scenario, const Ramp& ramp, double time, const std::string& key,
                ValidationErrors& errors);

/// Removes the settings of floating-point parameters from `settings` and returns them as ramps that begin at
/// `time` with the values in `scenario`; the others stay. If `duration` is 0 there are no ramps, and all
/// stay.
std::vector<Ramp> extract_ramps(const Scenario& scenario, std::vector<std::string>& settings, double time,
                                double duration);

std::vector<TimelineEntry> read_timeline(const YAML::Node& list, ValidationErrors& errors);
void emit_timeline(YAML::Emitter& out, const std::vector<TimelineEntry>& timeline);
/// Applies the entries in order to a copy of the scenario and adds an error for each that is refused.
void check_timeline(const Scenario& scenario, ValidationErrors& errors);

}  // namespace desert_sim

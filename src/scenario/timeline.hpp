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

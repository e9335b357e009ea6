#pragma once
/// `run.timeline`: what happens at given simulated times, once or repeatedly: parameters change, at once or
/// over a ramp, or a command is applied.
///
///     run:
///       timeline:
///         - {time: 500, ramp: 200, set: {rain.rate: 2.0e-5, wind.speed: 3}}
///         - {time: 600, every: 60, until: 900, command: edit_terrain, layer: sand, x: 40, y: 50, radius: 6,
///            value: 0.2}
///
/// Any parameter that can change while a simulation runs can be set. A floating-point parameter changes
/// linearly over `ramp` seconds from its value at `time` to the new one, in Ramp::step_count equal steps; all
/// others change at `time`. The commands, and their keys, are those of timed_commands.hpp. All happens before
/// the first step that begins at the time or later, in order of time; what is due several times before one
/// step happens once.

#include <optional>
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
  static constexpr double no_end = 1e12, most_frequent = 1e-4;  ///< [s]
  double time = 0, ramp = 0;                                    ///< [s]
  double every = 0;                                             ///< [s]; 0: once
  double until = no_end;                                        ///< [s]; no repetition comes later
  std::vector<std::string> settings{};                          ///< "path=value"
  std::string command{};  ///< in their place: a command as YAML in flow style

  /// The first time after `time` [s] at which it happens; none if it does not happen again.
  std::optional<double> next_after(double time) const;
  /// The last such time that is not later than `now` [s].
  std::optional<double> last_between(double after, double now) const;
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

/// The order in which a simulation holds its ramps.
void sort_by_path(std::vector<Ramp>& ramps);

/// Adds an error for each value with which the ramp could not be going on at `time` [s]: a path that is no
/// floating-point parameter or one that cannot change, ends out of its range, a start that lies ahead.
void check_ramp(const Scenario& scenario, const Ramp& ramp, double time, const std::string& key,
                ValidationErrors& errors);

/// Removes the settings of floating-point parameters from `settings` and returns them as ramps that begin at
/// `time` with the values in `scenario`; the others stay. If `duration` is 0 there are no ramps, and all
/// stay.
std::vector<Ramp> extract_ramps(const Scenario& scenario, std::vector<std::string>& settings, double time,
                                double duration);

/// The file that the entry's command names as `image_file`; empty: none.
std::string timeline_raster(const TimelineEntry& entry);

/// `key` names the list in errors.
std::vector<TimelineEntry> read_timeline(const YAML::Node& list, const std::string& key,
                                         ValidationErrors& errors);
void emit_timeline(YAML::Emitter& out, const std::vector<TimelineEntry>& timeline);
/// Applies the settings in order to a copy of the scenario and adds an error for each entry that is refused.
/// `list` names the timeline in errors.
void check_timeline(const Scenario& scenario, const std::vector<TimelineEntry>& timeline,
                    const std::string& list, ValidationErrors& errors);
/// Adds the entries that a script has: a YAML file with a list as of run.timeline. Throws ConfigError.
void add_script(Scenario& scenario, const std::string& path);

}  // namespace desert_sim

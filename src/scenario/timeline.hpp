#pragma once
/// `run.timeline`: parameters that change by themselves at given times, at once or over a while.
///
///     run:
///       timeline:
///         - {time: 500, ramp: 200, set: {rain.rate: 2.0e-5, wind.speed: 3}}
///
/// Any parameter that can change while a simulation runs can be set. Over `ramp` seconds numbers go straight
/// from what they are at `time` to what is set, in Ramp::stairs equal steps; all else changes at `time`.

#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

struct Scenario;
class Faults;

struct TimelineEntry {
  double time = 0, ramp = 0;            ///< [s]
  std::vector<std::string> settings{};  ///< "path=value"
};
constexpr std::size_t most_timeline_entries = 4096;

/// A number that goes from one value to another.
struct Ramp {
  static constexpr int stairs = 50;
  std::string path;
  double from = 0, to = 0;
  double start = 0, duration = 0;  ///< [s]
  int stair = 0;                   ///< that it is on

  int stair_at(double time) const;
  double value() const { return stair == stairs ? to : from + (to - from) * stair / stairs; }
};

/// Which settings of an entry begin to change as ramps from what `scenario` has; the others stay in
/// `settings`.
std::vector<Ramp> take_ramps(const Scenario& scenario, std::vector<std::string>& settings, double time,
                             double duration);

std::vector<TimelineEntry> read_timeline(const YAML::Node& list, Faults& faults);
void emit_timeline(YAML::Emitter& out, const std::vector<TimelineEntry>& timeline);
/// Adds a fault for each entry that could not be carried out after those before it.
void check_timeline(const Scenario& scenario, Faults& faults);

}  // namespace desert_sim

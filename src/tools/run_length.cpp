#include "src/tools/run_length.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/error.hpp"
#include "src/core/time_units.hpp"

namespace desert_sim {

namespace {

constexpr long long most_steps = 1LL << 40;

double duration_of(const Options& o) { return read_time(o.text("duration", ""), "--duration", 0, 1e12); }

}  // namespace

std::uint64_t steps_until(const Simulation& simulation, double until) {
  for (const TimelineEntry& entry : simulation.scenario().timeline)
    for (const std::string& setting : entry.settings)
      if (setting.compare(0, setting.find('='), "run.time_step") == 0)
        throw ConfigError(
            "a duration says how long the run is, but run.timeline changes run.time_step (allowed: --steps)");
  constexpr double rounding = 1e-7;  // of the time step, a float
  const double steps = (until - simulation.time()) / simulation.scenario().run.time_step;
  if (steps > static_cast<double>(most_steps))
    throw ConfigError("a duration of more than 2^40 steps is asked for");
  return steps > 0 ? static_cast<std::uint64_t>(std::ceil(steps * (1 - rounding))) : 0;
}

void check_run_length(const Options& o) {
  o.number("steps", 0, 0, most_steps);
  if (o.has("duration")) duration_of(o);
}

std::uint64_t steps_to_run(const Options& o, const Simulation& simulation, std::uint64_t usual) {
  if (o.has("duration")) return steps_until(simulation, duration_of(o));
  const double duration = simulation.scenario().run.duration;
  if (!o.has("steps") && !o.has("replay") && duration > 0) return steps_until(simulation, duration);
  const auto asked =
      static_cast<std::uint64_t>(o.number("steps", static_cast<long long>(usual), 0, most_steps));
  if (!o.has("resume")) return asked;
  return asked > simulation.steps() ? asked - simulation.steps() : 0;
}

std::uint64_t snapshot_distance(const Options& o, std::uint64_t steps) {
  const auto every = static_cast<std::uint64_t>(o.number("every", 0, 1, most_steps)),
             count = static_cast<std::uint64_t>(o.number("snapshots", 0, 1, most_steps));
  return count == 0 ? every : std::max<std::uint64_t>(1, (steps + count - 1) / count);
}

}  // namespace desert_sim

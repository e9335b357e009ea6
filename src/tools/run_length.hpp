#pragma once
/// How many steps a run takes, and after which of them it writes.

#include <cstdint>

#include "src/simulation/simulation.hpp"
#include "src/tools/options.hpp"

namespace desert_sim {

/// Steps from now until the simulated time `until` [s]. Throws ConfigError if they are countless, or not to
/// be known because the timeline changes the time step.
std::uint64_t steps_until(const Simulation& simulation, double until);

/// Throws ConfigError unless --steps and --duration are well-formed and not both given.
void check_run_length(const Options& options);

/// Steps from now on: of --steps (of which those that are done count), --duration, run.duration or `usual`.
std::uint64_t steps_to_run(const Options& options, const Simulation& simulation, std::uint64_t usual);

/// When a run writes its terrain, besides the end.
struct SnapshotPlan {
  std::uint64_t every = 0;       ///< steps from one to the next; 0: never
  std::uint64_t before_end = 0;  ///< tick of one more; 0: none

  bool due(std::uint64_t step, std::uint64_t tick) const {
    return every > 0 && (step % every == 0 || tick == before_end);
  }
};

/// By --every or --snapshots, of a run of so many steps. Throws ConfigError if they are malformed, both
/// given, or without --out.
SnapshotPlan snapshots_of(const Options& options, std::uint64_t steps);

}  // namespace desert_sim

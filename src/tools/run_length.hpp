#pragma once
/// How many steps a run takes, and after which of them it writes.

#include <cstdint>

#include "src/command_line/options.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// Steps from now until the simulated time `until` [s]. Throws ConfigError if they are countless, or not to
/// be known because the timeline changes the time step.
std::uint64_t steps_until(const Simulation& simulation, double until);

/// Throws ConfigError unless --steps and --duration are well-formed.
void check_run_length(const Options& options);

/// Steps from now on: of --steps (of which those that are done count), --duration, run.duration or `usual`.
std::uint64_t steps_to_run(const Options& options, const Simulation& simulation, std::uint64_t usual);

/// Steps from one snapshot of the terrain to the next, of a run of so many steps, by --every or --snapshots;
/// 0: there are none. Throws ConfigError if they are malformed.
std::uint64_t snapshot_distance(const Options& options, std::uint64_t steps);

}  // namespace desert_sim

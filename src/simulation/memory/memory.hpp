#pragma once
/// How much memory a simulation takes: counted by making it without memory, before any is allocated.

#include <vector>

#include "src/scenario/scenario.hpp"
#include "src/simulation/pipeline/memory_part.hpp"
#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

/// All that a simulation of these parts holds on the device.
std::vector<MemoryPart> memory_of(const SimulationState& state, const Pipeline& pipeline, const Views& views);
std::size_t total_bytes(const std::vector<MemoryPart>& parts);

/// What memory_of() a simulation of `scenario` would say at its start, layers that its terrain steps fill
/// included. `scenario` must be resolved, with at most max_grid_cells cells. What transforms take for
/// themselves is estimated.
std::vector<MemoryPart> planned_memory(const Scenario& scenario);

/// Bytes a cell that the host holds at once while the terrain of `scenario` is built from its steps.
double bytes_to_build(const Scenario& scenario);

/// Throws ConfigError, before anything is allocated, if `scenario` needs more than there is on the device of
/// `exec`, or on the host, which holds `host_bytes` a cell besides while the terrain is made. The message has
/// what is needed, what there is, bytes a cell, and the grid.
void require_memory(const Exec& exec, const Scenario& scenario, double host_bytes);
/// Likewise for the bytes that something besides needs on the device, and on the host; `what` says what.
void require_bytes(const Exec& exec, const Scenario& scenario, double on_device, double on_host,
                   const std::string& what);
/// Throws ConfigError if what `scenario` needs more than the present one of `state` is not there.
void require_more_memory(const SimulationState& state, const Scenario& scenario);

}  // namespace desert_sim

#pragma once
/// The simulation in its parts: the state, the pipeline of processes that steps it, the commands that change
/// it between steps, and the views that others have of it. Owned by one thread.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/scenario/terrain_builder.hpp"
#include "src/simulation/editing/commands.hpp"
#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/processes/processes.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/views/views.hpp"

namespace desert_sim {

/// Most steps of a simulation: a double counts so far, which the simulated time is a multiple of.
constexpr std::uint64_t max_simulation_steps = 1ULL << 53;

class Simulation {
 public:
  /// Builds the terrain. `scenario` must be resolved (see resolve_grid()), and not begin with a checkpoint
  /// (see simulation_at_start()). Throws ConfigError.
  Simulation(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster,
             const ProcessTable& table = process_table());
  /// A terrain without material, for a checkpoint to fill.
  Simulation(const Scenario& scenario, Terrain terrain, const ProcessTable& table = process_table());

  /// One step of `run.time_step` seconds. Throws StateError after max_simulation_steps.
  void step();
  /// Applies a command between steps; throws ConfigError and changes nothing if it is refused. Reset and
  /// LoadCheckpoint are the Session's business.
  CommandResult apply(const Command& command, bool with_change = false) {
    return commands_.apply(command, with_change);
  }

  SimulationState& state() { return state_; }
  const SimulationState& state() const { return state_; }
  Pipeline& pipeline() { return pipeline_; }
  const Pipeline& pipeline() const { return pipeline_; }
  Commands& commands() { return commands_; }
  const Commands& commands() const { return commands_; }
  Views& views() { return views_; }
  const Views& views() const { return views_; }

  // ---- What is asked most often of the state

  std::uint64_t steps() const { return state_.steps; }
  double time() const { return state_.time(); }
  const Scenario& scenario() const { return state_.scenario; }
  const Terrain& terrain() const { return state_.terrain; }
  Exec& exec() const { return state_.exec(); }

  /// All that is held on the device, part by part.
  std::vector<MemoryPart> memory() const;

 private:
  SimulationState state_;
  Pipeline pipeline_;
  Commands commands_;
  Views views_;
};

}  // namespace desert_sim

#pragma once
/// The simulation in its parts: the state, the pipeline of processes that steps it, the commands that change
/// it between steps, and the views that others have of it. Owned by one thread.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/avalanching/residual.hpp"
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
  /// Builds the terrain. `scenario` must be resolved (see resolve_grid()). Throws ConfigError.
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
  /// What undo can bring back.
  EditHistory& history() { return commands_.history(); }

  SimulationState& state() { return state_; }
  const SimulationState& state() const { return state_; }
  Pipeline& pipeline() { return pipeline_; }
  const Pipeline& pipeline() const { return pipeline_; }

  // ---- What is asked most often of the parts

  std::uint64_t steps() const { return state_.steps; }
  double time() const { return state_.time(); }
  double paced_time() const { return state_.paced_time(); }
  const Scenario& scenario() const { return state_.scenario; }
  const Scenario& start() const { return state_.start; }
  Scenario present_scenario() const { return state_.present_scenario(); }
  const Terrain& terrain() const { return state_.terrain; }
  Exec& exec() const { return state_.exec(); }
  wind::Vector wind_above() const { return state_.wind_above(); }
  std::uint64_t state_hash() const { return state_.hash(); }
  std::array<MaterialBalance, material_count> balance() const { return state_.balance(); }
  std::vector<PlantCount> plant_counts() const { return state_.plant_counts(); }
  std::vector<Layer> layers_in_use() const { return state_.layers_in_use(); }
  std::string describe_changes() const { return commands_.describe_changes(); }

  PendingSnapshot begin_snapshot(const std::vector<Layer>& layers, const RowBand& band = {}) {
    return views_.begin_snapshot(layers, band);
  }
  std::shared_ptr<const Snapshot> snapshot(const std::vector<Layer>& layers, const RowBand& band = {}) {
    return begin_snapshot(layers, band).get();
  }
  PendingPlants begin_plants() { return views_.begin_plants(); }
  bool shows(Layer layer) const { return views_.shows(layer); }
  void release_requested_layers() { views_.release_requested_layers(); }
  PendingChanges begin_changes(const HeldQueries& queries) { return views_.begin_changes(queries); }
  void forget(Layer layer) { views_.forget(layer); }
  bool holds(Layer layer) const { return views_.holds(layer); }
  PendingCosts begin_costs(const CostQuery& query) { return views_.begin_costs(query); }
  void forget_costs() { views_.forget_costs(); }
  Staging& staging() { return views_.staging(); }

  /// All that is held on the device, part by part.
  std::vector<MemoryPart> memory() const;
  /// What avalanching has left too steep.
  Residual residual();
  double max_sand_slope_deg() const;
  double mean_count(const std::string& counter) const;  ///< a step; see Process::counter

  void set_timing(bool on) { pipeline_.set_timing(on); }
  std::vector<ProcessTime> process_times() const { return pipeline_.times(); }
  void clear_process_times() { pipeline_.clear_times(); }

 private:
  SimulationState state_;
  Pipeline pipeline_;
  Commands commands_;
  Views views_;
};

}  // namespace desert_sim

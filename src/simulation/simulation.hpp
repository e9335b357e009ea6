#pragma once
/// The simulation: terrain, processes in their order, clock, books. Owned by one thread.

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/avalanching/soil_and_bedrock.hpp"
#include "kernels/edit/brush_smooth.hpp"
#include "kernels/field/statistics.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/plants/cover.hpp"
#include "kernels/plants/illumination.hpp"
#include "kernels/plants/life.hpp"
#include "kernels/plants/marking.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/view/held_costs.hpp"
#include "kernels/view/held_elevation.hpp"
#include "kernels/view/layer_values.hpp"
#include "kernels/water/hydraulic_erosion.hpp"
#include "kernels/water/rain.hpp"
#include "kernels/water/virtual_pipes.hpp"
#include "kernels/water/water_sources.hpp"
#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/scenario/terrain_builder.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/simulation/pipeline/step_recordings.hpp"
#include "src/simulation/views/cost_changes.hpp"
#include "src/simulation/views/elevation_changes.hpp"
#include "src/simulation/views/snapshot.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

/// What one material did since the start, in quanta and in cubic metres.
struct MaterialBalance {
  long long initial = 0, final = 0, in = 0, out = 0;  ///< [quanta]
  double quantum_volume = 0;                          ///< [m³] of one quantum
  double base_volume = 0;                             ///< [m³] between elevation 0 and the datum; of bedrock
  /// final − initial − in + out, which must be 0 [quanta]
  long long residual() const { return final - initial - in + out; }
  double cubic_metres(long long quanta) const { return static_cast<double>(quanta) * quantum_volume; }
  double initial_m3() const { return base_volume + cubic_metres(initial); }
  double final_m3() const { return base_volume + cubic_metres(final); }
  double relative_residual() const;
};

/// Milliseconds per process, in the order of the step; filled while timing is on.
struct ProcessTime {
  const char* process;
  double milliseconds = 0;
};

/// How many plants of a species there are.
struct PlantCount {
  std::string species;
  int plants = 0, mature = 0;
};

/// A part of the memory that a simulation holds on its backend's device.
struct MemoryPart {
  std::string name;  ///< a layer's, or of what processes work with
  std::size_t bytes = 0;
};

/// Throws ConfigError if a hop or a march could reach too far: they are counted in 16.16 fixed-point cells.
void require_reach(const Scenario& scenario);

/// Whether something but edits changes rock or soil.
bool wears_ground(const Scenario& scenario);

class Simulation {
 public:
  /// Builds the terrain. `scenario` must be resolved (see resolve_grid()). Throws ConfigError.
  Simulation(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster);

  /// One step of `run.time_step` seconds.
  void step();

  /// Applies between steps; throws ConfigError and changes nothing if it is refused. Reset and LoadCheckpoint
  /// are the Session's business.
  CommandResult apply(const command::SetWind& command);
  CommandResult apply(const command::SetWindSchedule& command);
  CommandResult apply(const command::EditWind& command);
  /// `with_change`: the result tells what changed, cell by cell.
  CommandResult apply(const command::EditTerrain& command, bool with_change = false);
  CommandResult apply(const command::EditPlants& command);
  CommandResult apply(const command::SetParameters& command);

  std::uint64_t steps() const { return steps_; }
  double time() const { return static_cast<double>(steps_) * scenario_.run.time_step; }
  const Scenario& scenario() const { return scenario_; }
  /// The scenario that it began with: what a reset goes back to.
  const Scenario& start() const { return start_; }
  /// What the timeline and ramps are changing, and what comes next; empty if nothing.
  std::string describe_changes() const;
  /// The scenario with the wind regime that blows now, which commands may have replaced.
  Scenario present_scenario() const;
  const Terrain& terrain() const { return terrain_; }
  Exec& exec() const { return terrain_.exec(); }
  /// All that is held on the device, part by part.
  std::vector<MemoryPart> memory() const;
  wind::Vector wind_above() const { return regime_.at(time()); }

  /// Starts a copy of layers to the host; the next step may be started at once, and does not show in it.
  /// Elevation and wind are brought up to date first, and layers that exist on request computed, if they are
  /// asked for; what was never asked for takes no memory.
  /// Of a band of rows only those are copied and computed: the snapshot's height and origin are the band's,
  /// less what lies off an open terrain (at least one row is left).
  PendingSnapshot begin_snapshot(const std::vector<Layer>& layers, const RowBand& band = {});
  /// Waits for it.
  std::shared_ptr<const Snapshot> snapshot(const std::vector<Layer>& layers, const RowBand& band = {}) {
    return begin_snapshot(layers, band).get();
  }
  /// Starts a copy of all plants to the host, in the order of their look-up.
  PendingPlants begin_plants();
  /// Gives back the memory of layers that exist on request, until one is asked for again.
  void release_requested_layers();

  /// Notes the present elevation as what others hold, or that they hold none.
  void hold_elevation();
  void forget_elevation() { held_ = {}; }
  bool holds_elevation() const { return static_cast<bool>(held_); }
  /// Starts a copy of the cells whose elevation differs by more than `threshold` [m] from what is held, which
  /// then is held: whoever drops the answer lacks them from then on. `tile`: cells on a side of a tile.
  /// Throws StateError if nothing is held.
  Pending<ElevationChanges> take_elevation_changes(double threshold, int tile);

  /// Starts a copy of what others lack of the costs of the terrain, for the rover of the scenario's section
  /// `traversability`; it is held then: whoever drops the answer lacks it from then on.
  TakenCosts take_costs(const CostQuery& query);
  void forget_costs() { costs_ = {}; }

  /// Memory through which copies go to the host.
  Staging& staging() { return staging_; }
  /// Whether a snapshot of the layer has more to show than 0 everywhere.
  bool shows(Layer layer) const;
  /// Layers that are in use, derived ones included.
  std::vector<Layer> layers_in_use() const;

  /// XXH3-64 over the persistent layers, the clock and the books.
  std::uint64_t state_hash() const;
  std::array<MaterialBalance, material_count> balance();
  Residual residual();
  /// Plants by species, in the order of the scenario; none where plants are off.
  std::vector<PlantCount> plant_counts() const;
  const plants::Workspace& plants() const { return plants_; }
  double max_sand_slope_deg();
  double mean_avalanche_iterations() const;

  /// Per-process timing costs a synchronisation per process; off by default.
  void set_timing(bool on) { timing_ = on; }
  const std::vector<ProcessTime>& process_times() const { return process_times_; }
  void clear_process_times();

 private:
  friend class CheckpointAccess;
  friend std::vector<MemoryPart> planned_memory(const Scenario&);
  /// With the terrain already made (from steps or from a checkpoint).
  Simulation(Exec& exec, const Scenario& scenario, const HostLayers& layers);
  Simulation(const Scenario& scenario, Terrain terrain);

  /// Starts a step's processes; reads nothing back where recordable() holds.
  template <class E>
  void run_processes(E& exec);
  /// Rain, rivers, erosion, moisture: a step of theirs is not recorded, it looks how deep the water is.
  template <class E>
  void run_water(E& exec);
  Quanta sea_level() const;
  /// Whether the next step is the same work as others before and after it.
  bool recordable() const;
  bool shadow_can_wait() const;
  /// Whether the next step looks through the layers that it writes.
  bool checks_layers() const;
  /// Whether nothing moves ground in a step after the avalanches: what they measure is what the next step
  /// needs.
  bool avalanches_end_the_step() const;
  template <class E>
  void update_wind(E& exec, const TerrainView& view);
  /// Runs a process; on checking steps looks through the layers it writes; times it while timing is on.
  template <class E, class Process>
  void run(E& exec, const char* name, std::initializer_list<Layer> writes, Process&& process);
  template <class E>
  void check(E& exec, const char* process, Layer layer);
  /// Before the first step (also of a loaded checkpoint) derived layers and repose tangents are not there
  /// yet.
  void refresh_derived();
  /// Computes those of `layers` that exist on request, in a band that lies on the terrain.
  void judge(const std::vector<Layer>& layers, const RowBand& rows);
  /// A snapshot's frame; its layers are there and empty.
  std::shared_ptr<Snapshot> frame_of(const std::vector<Layer>& layers, const RowBand& rows) const;
  /// Sends rows of the snapshot's layers on their way to the end of what it has.
  void send_rows(const std::shared_ptr<Snapshot>& snapshot, const RowBand& rows,
                 const std::shared_ptr<Readback>& readback);
  void allocate_work();
  /// What depends on parameters that can change live: layers and memory of processes that are on.
  void prepare_processes();
  void prepare_water();
  /// Changes what is due now.
  void follow_timeline();
  /// Of `settings`, numbers become ramps where there is a duration [s]; what ramped before stops.
  void begin_ramps(std::vector<std::string>& settings, double duration);
  void set_parameters(const std::vector<std::string>& settings);
  /// Only terrains whose rock or soil changes need this memory: called when abrasion is on or one of them is
  /// edited.
  void prepare_ground_avalanches();
  template <class E>
  void slide_ground(E& exec, const TerrainView& view);
  /// Brings the scenario's features of the wind to the backend.
  void upload_wind_features();
  void make_plants();
  /// Puts plants (columns as plants::words() gives them) in the place of those that are there.
  void set_plants(const std::vector<std::uint32_t>& words);
  /// What the wind is blocked by.
  const surface::Heights& obstructing_heights() const;
  void start_books();
  void set_regime(WindRegime regime);
  std::vector<long long> read_ledger() const;
  std::uint64_t avalanche_iterations() const;  ///< of all steps
  long long material_now(Material material);
  LedgerView ledger() const { return {ledger_.data()}; }

  Scenario start_;
  Scenario scenario_;  ///< start_, as commands have changed it
  Terrain terrain_;
  Staging staging_{terrain_.exec()};
  WindRegime regime_;
  std::uint64_t steps_ = 0;
  Quanta wind_reference_ = 0;  ///< lowest solid surface at load
  bool derived_ready_ = false;
  bool heights_stale_ = true;   ///< ground has moved since heights_ were measured
  bool bedrock_loose_ = false;  ///< bedrock was edited and has not come to rest since
  bool soil_loose_ = false;     ///< soil, or bedrock below it, was edited and soil has not come to rest since
  std::size_t next_entry_ = 0;  ///< of the timeline
  std::vector<Ramp> ramps_;
  std::uint64_t avalanche_iterations_ = 0;  ///< but those that avalanche_work_ has counted
  std::array<long long, material_count> initial_{};

  // What the processes work with; made once, so that a step allocates nothing.
  Buffer<long long> ledger_;
  surface::Heights heights_;
  wind::Workspace wind_work_;
  wind_shadow::Workspace shadow_work_;
  avalanching::Workspace avalanche_work_;
  avalanching::GroundWorkspace ground_work_;
  virtual_pipes::Workspace pipes_work_;
  hydraulic_erosion::Workspace erosion_work_;
  Buffer<wind_features::Prepared> features_;
  plants::Workspace plants_;  ///< empty where plants are off
  Buffer<float> perturbation_x_, perturbation_y_;
  /// The tangents of repose, from reptation on; what comes before it in a step may scribble there.
  Buffer<float> repose_;
  Buffer<float> reptation_strength_;
  Buffer<Quanta> landed_;  ///< of saltation; what comes after it in a step may scribble there
  Buffer<float> held_;     ///< the elevation that others hold [m]; none if they hold none
  HeldCosts costs_;        ///< likewise

  StepRecordings recordings_;
  bool timing_ = false;
  std::vector<ProcessTime> process_times_;
};

}  // namespace desert_sim

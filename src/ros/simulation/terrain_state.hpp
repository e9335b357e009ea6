#pragma once
/// What the simulation thread answers with: states of the terrain, reports, and the moment that they show.

#include <ros/time.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/simulation/forecast/forecast.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

/// The moment of a state: its time, and counters that tell whether it is still the present one.
struct Moment {
  std::uint64_t step = 0;     ///< since the scenario's start
  double time = 0;            ///< simulated [s]
  ros::Time stamp;            ///< ROS time at which this state was reached
  std::uint64_t change = 0;   ///< grows with each step and each command
  std::uint64_t command = 0;  ///< grows with each command and each request for steps
  std::uint64_t terrain = 0;  ///< grows when the terrain is replaced: by a reset or a checkpoint
};

/// What is asked for besides layers. The simulation keeps what the subscribers of updates hold of layers and
/// of costs, so that it can answer with what they lack.
struct StateQuery {
  HeldQueries held;
  CostQuery costs;
  bool plants = false;     ///< all plants, one by one
  bool feet = false;       ///< in the snapshot, as far as MicroRelief needs them
  int particle_paths = 0;  ///< at most so many
};

/// Layers of the terrain at one moment, and what else was asked for. It never changes once it is made.
struct TerrainState {
  Moment moment;
  std::shared_ptr<const Snapshot> snapshot;  ///< layers that are not in use are absent, and count as 0
  // What follows is empty or null unless it was asked for:
  /// Of layers that subscribers held.
  std::map<Layer, std::shared_ptr<const LayerChanges>> changes;
  std::shared_ptr<const CostChanges> cost_update;  ///< also null if they held no costs: then see whole_costs
  std::shared_ptr<const CostChanges> whole_costs;
  std::shared_ptr<const PlantList> plants;
  std::shared_ptr<const ParticlePaths> particle_paths;
};

/// What save_terrain() takes. The snapshot has the elevation too.
struct TerrainToSave {
  TerrainState state;
  Scenario scenario;
  std::uint64_t hash = 0;
};

/// What export_terrain() and what is asked before it take: all plants, and layers_to_export().
struct TerrainToExport {
  TerrainState state;
  std::vector<std::string> rasters;  ///< that the scenario is built from
};

/// What save_scenario() takes: the present scenario and its state.
struct ScenarioToSave {
  Moment moment;
  Scenario scenario;
  std::string checkpoint;
  std::uint64_t hash = 0;
};

/// The state in which a command or a request for steps ended.
struct ReachedState {
  Moment moment;
  std::uint64_t hash = 0;  ///< of the state; 0 if it was not asked for
  CommandResult result;    ///< of an edit
};

/// A checkpoint in memory.
struct CheckpointCopy {
  Moment moment;
  std::string bytes;
  std::vector<std::string> journal_files;  ///< see Session::journal_files()
};

/// The state that a forecast begins with.
struct ForecastStart {
  Moment moment;
  std::string checkpoint;  ///< as checkpoint_bytes() makes it
  std::string backend;     ///< of the simulation
};

enum class RunState { running, paused, waiting };

/// What ~status and /diagnostics say.
struct StatusReport {
  Moment moment;
  RunState state = RunState::paused;
  std::string scenario, backend, backend_choice, device;
  double time_step = 0;     ///< [s]
  int parts = 1;            ///< in which the next step is done
  double acceleration = 0;  ///< simulated seconds per second of ROS time; 0: not tied to it
  double step_rate = 0, steps_per_second = 0;  ///< wanted and measured [steps/s]
  double lag = 0;                              ///< [s]
  std::vector<ProcessTime> process_times;      ///< means
  std::array<MaterialBalance, material_count> balance;
  std::string changes;                          ///< of parameters, by timeline and ramps
  std::map<std::string, std::string> warnings;  ///< of the last step, by process; see Process::warning
  wind::Vector wind_above;
  bool hashed = false;  ///< only while paused
  std::uint64_t hash = 0;
  int undoable = 0, redoable = 0;    ///< strokes, resets and loads
  std::uint64_t snapshots = 0;       ///< copies of the terrain so far
  std::size_t layer_bytes = 0;       ///< of the terrain, on the backend's device
  std::size_t memory_available = 0;  ///< on that device [bytes]
  double memory_needed = 0;          ///< on that device, for a second terrain like this one [bytes]
};

}  // namespace desert_sim

#pragma once
/// Which state of the simulation something shows.

#include <ros/time.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct Moment {
  std::uint64_t step = 0;     ///< since the scenario's start
  double time = 0;            ///< simulated [s]
  ros::Time stamp;            ///< ROS time at which this state was reached
  std::uint64_t change = 0;   ///< grows with each step and each command
  std::uint64_t command = 0;  ///< grows with each command and each request for steps
  std::uint64_t terrain = 0;  ///< grows when the terrain is replaced: by a reset or a checkpoint
};

/// What is asked for besides layers: what others lack of the elevation, with what they hold afterwards, and
/// of costs; and plants.
struct StateQuery {
  enum class Then { as_before, present, present_if_none, none };
  bool changes = false;  ///< whether the cells are wanted that differ by more than the threshold
  double threshold = 0;  ///< [m]
  int tile = 1;          ///< [cells]
  Then then = Then::as_before;
  CostQuery costs;
  bool plants = false;  ///< whether they are wanted one by one
};

/// Layers of the terrain at one moment; never changes once it is made.
struct TerrainState {
  Moment moment;
  std::shared_ptr<const Snapshot> snapshot;         ///< layers that are not in use are absent, and 0
  std::shared_ptr<const ElevationChanges> changes;  ///< if they were asked for; null if nothing was held
  std::shared_ptr<const CostChanges> cost_update;   ///< likewise; then there is the whole map
  std::shared_ptr<const CostChanges> whole_costs;
  std::shared_ptr<const PlantList> plants;  ///< if they were asked for
};

/// What save_terrain() takes; the snapshot has the elevation too.
struct TerrainToSave {
  TerrainState state;
  Scenario scenario;
  std::uint64_t hash = 0;
};

/// Where a command or a request for steps ended.
struct Reached {
  Moment moment;
  std::uint64_t hash = 0;  ///< of the state; 0 if it was not asked for
  CommandResult result;    ///< of an edit
};

/// A checkpoint in memory.
struct CheckpointCopy {
  Moment moment;
  std::string bytes;
};

enum class RunState { running, paused, waiting };

/// What ~status says.
struct StatusReport {
  Moment moment;
  RunState state = RunState::paused;
  std::string scenario, backend, backend_choice, device;
  double step_rate = 0, steps_per_second = 0, lag = 0;
  std::vector<ProcessTime> process_times;  ///< means
  std::array<MaterialBalance, material_count> balance;
  std::string changes;  ///< of parameters, by timeline and ramps
  wind::Vector wind_above;
  bool hashed = false;  ///< only while paused
  std::uint64_t hash = 0;
  std::uint64_t snapshots = 0;
  std::size_t layer_bytes = 0;       ///< of the terrain, on the backend's device
  std::size_t memory_available = 0;  ///< there [bytes]
  double memory_needed = 0;          ///< there, for a second terrain like this one [bytes]
};

}  // namespace desert_sim

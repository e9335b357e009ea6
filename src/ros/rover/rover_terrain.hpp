#pragma once
/// The terrain that a rover drives on, as a TerrainClient has it: the newest maps, or state after state
/// with all layers of one step.

#include <desert_sim/MicroReliefState.h>
#include <desert_sim/Plants.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/ros/rover/map_ground.hpp"
#include "src/ros/rover/rover_node_parameters.hpp"

namespace desert_sim {

class RoverTerrain {
 public:
  /// `on_change` (may be empty) is called after each change of any layer, on the client's thread. `sensors`:
  /// whether the rover has some; their layers are then parts of the states that next() gives, and of
  /// newest() while want_sensor_layers(true). With the parameter `micro_relief`, the grounds have ripples and
  /// bumps.
  RoverTerrain(const RoverNodeParameters& parameters, bool sensors,
               std::function<void(const MapChange&)> on_change);

  /// The newest map of each layer, perhaps of different steps; null before there is one of each.
  std::shared_ptr<const MapGround> newest();
  /// The next state of which all layers are of one step, in the order of steps. Waits for it up to
  /// `patience`, and is null if none came. States that nobody takes are kept, up to 1000.
  std::shared_ptr<const MapGround> next(std::chrono::milliseconds patience);
  /// Subscribes to the layers that only sensors see, or gives them up, and returns whether all that are
  /// wanted have come since: a scan without them would show a desert without plants. In lockstep, where
  /// states must not depend on who listens, it subscribes to nothing and returns true. From one thread at a
  /// time.
  bool want_sensor_layers(bool wanted);
  /// Whether the elevation has a publisher.
  bool connected() const { return client_->connected("elevation"); }

 private:
  void receive(const MapChange& change);
  void receive_micro_relief(const MicroReliefState::ConstPtr& message);
  void receive_plants(const Plants::ConstPtr& message);
  /// Puts into the state of a step what has come of it. The caller holds the mutex.
  void collect(std::uint64_t step, const std::function<void(TerrainMaps&)>& put);
  std::shared_ptr<const MapGround> ground_of(const TerrainMaps& maps) const;

  static constexpr std::size_t most_states = 1000, most_incomplete = 64;
  const RoverNodeParameters parameters_;
  const bool lockstep_;
  const unsigned uses_;  ///< of maps at all times, as bits of MapUse
  const std::function<void(const MapChange&)> on_change_;
  bool sensor_layers_ = false;  ///< whether they are subscribed to
  std::mutex mutex_;
  std::condition_variable arrived_;
  TerrainMaps newest_maps_;
  std::shared_ptr<const MapGround> newest_;          ///< of newest_maps_, if nothing came since
  std::map<std::uint64_t, TerrainMaps> incomplete_;  ///< by step
  std::deque<TerrainMaps> complete_;
  std::uint64_t last_step_ = 0;  ///< of the last one that became complete
  // Last, because they call what receives:
  std::unique_ptr<TerrainClient> client_;
  ros::CallbackQueue micro_relief_queue_;
  ros::Subscriber micro_relief_subscriber_, plants_subscriber_;
  std::optional<ros::AsyncSpinner> micro_relief_spinner_;
};

}  // namespace desert_sim

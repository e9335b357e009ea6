#pragma once
/// The terrain that a rover drives on, as a TerrainClient has it: the newest maps, or state after state
/// with all layers of one step.

#include <ros/node_handle.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "src/client/terrain_client.hpp"
#include "src/ros/rover/map_ground.hpp"
#include "src/ros/rover/rover_node_parameters.hpp"

namespace desert_sim {

class RoverTerrain {
 public:
  explicit RoverTerrain(const RoverNodeParameters& parameters);

  /// The newest map of each layer, perhaps of different steps; null before there is one of each.
  std::shared_ptr<const MapGround> newest();
  /// The next state of which all layers are of one step, in the order of steps. Waits for it up to
  /// `patience`, and is null if none came. States that nobody takes are kept, up to 1000.
  std::shared_ptr<const MapGround> next(std::chrono::milliseconds patience);
  /// Whether the simulation's topics have a publisher.
  bool connected() const { return client_->connected(); }

 private:
  void receive(const MapChange& change);
  std::shared_ptr<const MapGround> ground_of(const TerrainMaps& maps) const;

  static constexpr std::size_t most_states = 1000, most_incomplete = 64;
  const RoverNodeParameters parameters_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  TerrainMaps newest_maps_;
  std::shared_ptr<const MapGround> newest_;          ///< of newest_maps_, if nothing came since
  std::map<std::uint64_t, TerrainMaps> incomplete_;  ///< by step
  std::deque<TerrainMaps> complete_;
  std::uint64_t last_step_ = 0;            ///< of the last one that became complete
  bool loose_ = false;                     ///< whether the layer looseness has had a cell that is not 0
  std::unique_ptr<TerrainClient> client_;  ///< last: it calls receive()
};

}  // namespace desert_sim

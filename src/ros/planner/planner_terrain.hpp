#pragma once
/// The terrain that a planner plans on, as a TerrainClient has it: changes of traversability in order, and
/// the newest maps of other layers.

#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/planner/heading_costs.hpp"
#include "src/ros/planner/planner_node_parameters.hpp"

namespace desert_sim {

class PlannerTerrain {
 public:
  explicit PlannerTerrain(const PlannerSetup& setup);

  /// The changes of traversability since the last call, up to and with this step; all without one.
  std::deque<MapChange> take(std::optional<std::uint64_t> step = {});
  /// Whether the maps of a state have arrived: those of its step, or of a later one. After a reset, what has
  /// arrived before it is of later steps, but older than `stamp`, when the simulation reached the state.
  bool has(std::uint64_t step, const ros::Time& stamp) const;
  /// Frame of the terrain; empty before there is one.
  std::string frame() const;
  std::shared_ptr<const LayerMap> elevation() const { return client_->layer_map("elevation"); }
  /// The newest maps for costs by heading; those that have not come or have another size than `frame` are
  /// empty.
  HeadingLayers layers(const GridFrame& frame) const;

 private:
  void receive(const MapChange& change);

  mutable std::mutex mutex_;
  std::deque<MapChange> changes_;
  std::shared_ptr<const LayerMap> newest_;
  std::unique_ptr<TerrainClient> client_;  ///< last: it calls receive()
};

}  // namespace desert_sim

#include "src/ros/rover/rover_terrain.hpp"

#include <ros/console.h>

#include <algorithm>

namespace desert_sim {

RoverTerrain::RoverTerrain(const RoverNodeParameters& parameters) : parameters_(parameters) {
  TerrainClient::Options options;
  options.node = parameters.terrain_node;
  options.layers = TerrainMaps::known_names();
  options.tell_each_step = true;
  options.on_change = [this](const MapChange& change) { receive(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
}

void RoverTerrain::receive(const MapChange& change) {
  const std::size_t which = TerrainMaps::index(change.map->info().layer);
  if (which == TerrainMaps::count) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (which == TerrainMaps::looseness && !loose_ && !change.cells.empty()) {
    const std::vector<float> values = change.map->values(change.cells);
    loose_ = std::any_of(values.begin(), values.end(), [](float v) { return v > 0; });
  }
  newest_maps_.maps[which] = change.map;
  newest_.reset();
  if (parameters_.clock == RoverClock::ros) return;
  const std::uint64_t step = change.map->info().step;
  // After a reset, steps that were on their way will not be completed.
  if (step < last_step_) incomplete_.erase(incomplete_.upper_bound(step), incomplete_.end());
  TerrainMaps& state = incomplete_[step];
  state.maps[which] = change.map;
  if (state.complete()) {
    complete_.push_back(state);
    last_step_ = step;
    if (complete_.size() > most_states) {
      ROS_WARN_THROTTLE(5, "The rover is %zu states behind the terrain: the oldest is left out.",
                        most_states);
      complete_.pop_front();
    }
    incomplete_.erase(incomplete_.begin(), incomplete_.upper_bound(step));
    arrived_.notify_all();
  } else if (incomplete_.size() > most_incomplete) {
    incomplete_.erase(incomplete_.begin());
  }
}

std::shared_ptr<const MapGround> RoverTerrain::ground_of(const TerrainMaps& maps) const {
  const bool use = parameters_.looseness == LoosenessSource::layer ||
                   (parameters_.looseness == LoosenessSource::automatic && loose_);
  return std::make_shared<const MapGround>(maps, parameters_.moisture_capacity, use);
}

std::shared_ptr<const MapGround> RoverTerrain::newest() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_ && newest_maps_.complete()) newest_ = ground_of(newest_maps_);
  return newest_;
}

std::shared_ptr<const MapGround> RoverTerrain::next(std::chrono::milliseconds patience) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!arrived_.wait_for(lock, patience, [this] { return !complete_.empty(); })) return nullptr;
  const TerrainMaps maps = complete_.front();
  complete_.pop_front();
  return ground_of(maps);
}

}  // namespace desert_sim

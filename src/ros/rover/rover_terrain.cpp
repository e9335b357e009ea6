#include "src/ros/rover/rover_terrain.hpp"

#include <ros/console.h>

#include <utility>

namespace desert_sim {

RoverTerrain::RoverTerrain(const RoverNodeParameters& parameters, bool sensors,
                           std::function<void(const MapChange&)> on_change)
    : parameters_(parameters),
      lockstep_(parameters.clock == RoverClock::lockstep),
      sensors_in_states_(sensors && lockstep_),
      on_change_(std::move(on_change)),
      sensor_layers_(sensors_in_states_) {
  TerrainClient::Options options;
  options.node = parameters.terrain_node;
  options.layers = TerrainMaps::ground_names();
  if (sensor_layers_)
    for (const std::string& name : TerrainMaps::sensor_names()) options.layers.push_back(name);
  options.tell_each_step = true;
  options.on_change = [this](const MapChange& change) { receive(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
}

bool RoverTerrain::want_sensor_layers(bool wanted) {
  if (lockstep_) return true;
  if (wanted != sensor_layers_) {
    sensor_layers_ = wanted;
    if (wanted) {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_maps_.forget_sensor_layers();
    }
    for (const std::string& name : TerrainMaps::sensor_names())
      wanted ? client_->subscribe_layer(name) : client_->unsubscribe_layer(name);
  }
  if (!wanted) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_maps_.complete(true);
}

void RoverTerrain::receive(const MapChange& change) {
  if (on_change_) on_change_(change);
  const std::size_t which = TerrainMaps::index(change.map->info().layer);
  if (which == TerrainMaps::count) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_maps_.set(which, change);
  newest_.reset();
  if (!lockstep_) return;
  const std::uint64_t step = change.map->info().step;
  // After a reset, steps that were on their way will not be completed.
  if (step < last_step_) incomplete_.erase(incomplete_.upper_bound(step), incomplete_.end());
  TerrainMaps& state = incomplete_[step];
  state.maps[which] = change.map;
  if (which == TerrainMaps::looseness) state.loose = newest_maps_.loose;
  if (state.complete(sensors_in_states_)) {
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
                   (parameters_.looseness == LoosenessSource::automatic && maps.loose);
  return std::make_shared<const MapGround>(maps, parameters_.moisture_capacity, use);
}

std::shared_ptr<const MapGround> RoverTerrain::newest() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_ && newest_maps_.complete(false)) newest_ = ground_of(newest_maps_);
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

#include "src/ros/rover/rover_terrain.hpp"

#include <ros/console.h>

#include <utility>

#include "src/core/error.hpp"
#include "src/ros/conversion/micro_relief_message.hpp"

namespace desert_sim {

namespace {

unsigned uses_at_all_times(const RoverNodeParameters& p, bool sensors) {
  return MapUse::ground | (p.micro_relief ? MapUse::micro_relief : 0) |
         (sensors && p.clock == RoverClock::lockstep ? MapUse::sensors : 0);
}

}  // namespace

RoverTerrain::RoverTerrain(const RoverNodeParameters& parameters, bool sensors,
                           std::function<void(const MapChange&)> on_change)
    : parameters_(parameters),
      lockstep_(parameters.clock == RoverClock::lockstep),
      uses_(uses_at_all_times(parameters, sensors)),
      on_change_(std::move(on_change)) {
  TerrainClient::Options options;
  options.node = parameters.terrain_node;
  options.layers = TerrainMaps::names(uses_);
  options.tell_each_step = true;
  options.on_change = [this](const MapChange& change) { receive(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
  if (!parameters.micro_relief) return;
  // A queue of its own: services of the rover wait for states that are complete with this message.
  ros::NodeHandle node;
  node.setCallbackQueue(&micro_relief_queue_);
  micro_relief_subscriber_ = node.subscribe(parameters.terrain_node + "/micro_relief", most_states,
                                            &RoverTerrain::receive_micro_relief, this);
  plants_subscriber_ = node.subscribe(parameters.terrain_node + "/plants", lockstep_ ? most_states : 1,
                                      &RoverTerrain::receive_plants, this);
  micro_relief_spinner_.emplace(1, &micro_relief_queue_);
  micro_relief_spinner_->start();
}

bool RoverTerrain::want_sensor_layers(bool wanted) {
  if (lockstep_) return true;
  if (wanted != sensor_layers_) {
    sensor_layers_ = wanted;
    if (wanted) {
      const std::lock_guard<std::mutex> lock(mutex_);
      newest_maps_.forget(MapUse::sensors, uses_);
    }
    for (const std::string& name : TerrainMaps::names(MapUse::sensors, uses_))
      wanted ? client_->subscribe_layer(name) : client_->unsubscribe_layer(name);
  }
  if (!wanted) return true;
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_maps_.complete(uses_ | MapUse::sensors);
}

void RoverTerrain::receive(const MapChange& change) {
  if (on_change_) on_change_(change);
  const std::size_t which = TerrainMaps::index(change.map->info().layer);
  if (which == TerrainMaps::count) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_maps_.set(which, change);
  collect(change.map->info().step, [&](TerrainMaps& state) {
    state.maps[which] = change.map;
    if (which == TerrainMaps::looseness) state.loose = newest_maps_.loose;
  });
}

void RoverTerrain::receive_micro_relief(const MicroReliefState::ConstPtr& message) {
  std::shared_ptr<const Snapshot> settings;
  try {
    settings = std::make_shared<const Snapshot>(snapshot_of(*message));
  } catch (const ConfigError& e) {
    ROS_WARN_THROTTLE(5, "%s/micro_relief: a message was refused: %s", parameters_.terrain_node.c_str(),
                      e.what());
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_maps_.micro_relief_settings = settings;
  collect(message->step, [&settings](TerrainMaps& state) { state.micro_relief_settings = settings; });
}

void RoverTerrain::receive_plants(const Plants::ConstPtr& message) {
  std::shared_ptr<const MapPlants> plants;
  try {
    plants = std::make_shared<const MapPlants>(message);
  } catch (const ConfigError& e) {
    ROS_WARN_THROTTLE(5, "%s/plants: a message was refused: %s", parameters_.terrain_node.c_str(), e.what());
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_maps_.plants = plants;
  collect(message->step, [&plants](TerrainMaps& state) { state.plants = plants; });
}

void RoverTerrain::collect(std::uint64_t step, const std::function<void(TerrainMaps&)>& put) {
  newest_.reset();
  if (!lockstep_) return;
  // After a reset, steps that were on their way will not be completed.
  if (step < last_step_) incomplete_.erase(incomplete_.upper_bound(step), incomplete_.end());
  TerrainMaps& state = incomplete_[step];
  put(state);
  if (state.complete(uses_)) {
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
  if (maps.complete(MapUse::micro_relief) && maps.micro_relief_settings->micro_relief.needs_feet())
    if (const std::string shortage = maps.plants->shortage(); !shortage.empty())
      ROS_WARN_ONCE("%s/plants: %s", parameters_.terrain_node.c_str(), shortage.c_str());
  return std::make_shared<const MapGround>(maps, parameters_.moisture_capacity, parameters_.moisture_depth,
                                           use);
}

std::shared_ptr<const MapGround> RoverTerrain::newest() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_ && newest_maps_.complete(uses_)) newest_ = ground_of(newest_maps_);
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

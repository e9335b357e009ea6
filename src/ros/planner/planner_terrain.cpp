#include "src/ros/planner/planner_terrain.hpp"

#include <utility>

#include "src/ros/planner/planner_messages.hpp"

namespace desert_sim {

PlannerTerrain::PlannerTerrain(const PlannerSetup& setup) {
  TerrainClient::Options options;
  options.node = setup.node.terrain_node;
  options.layers = {"elevation", "traversability"};
  if (setup.planner.planner == PlannerKind::ompl)
    for (const char* name : {"slip", "slip_downhill", "slip_across", "sinkage", "water_depth",
                             "water_velocity_x", "water_velocity_y", "wind_x", "wind_y"})
      options.layers.emplace_back(name);
  options.tell_each_step = setup.node.clock == RoverClock::lockstep;
  options.on_change = [this](const MapChange& change) { receive(change); };
  client_ = std::make_unique<TerrainClient>(ros::NodeHandle(), options);
}

void PlannerTerrain::receive(const MapChange& change) {
  if (change.map->info().layer != "traversability") return;
  const std::lock_guard<std::mutex> lock(mutex_);
  // A map of all cells makes those before it needless; so they do not pile up.
  if (change.replaced) changes_.clear();
  changes_.push_back(change);
  newest_ = change.map;
}

std::deque<MapChange> PlannerTerrain::take(std::optional<std::uint64_t> step) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::deque<MapChange> taken;
  if (!step) {
    std::swap(taken, changes_);
    return taken;
  }
  while (!changes_.empty() && changes_.front().map->info().step <= *step) {
    taken.push_back(std::move(changes_.front()));
    changes_.pop_front();
  }
  return taken;
}

bool PlannerTerrain::has(std::uint64_t step, const ros::Time& stamp) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!newest_) return step == 0;
  const MapInfo& newest = newest_->info();
  return newest.step == step || (newest.step > step && newest.stamp >= stamp);
}

std::string PlannerTerrain::frame() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_ ? newest_->info().frame : "";
}

HeadingLayers PlannerTerrain::layers(const GridFrame& frame) const {
  const auto values = [&](const char* name) {
    const std::shared_ptr<const LayerMap> map = client_->layer_map(name);
    return map && grid_frame_of(map->info()) == frame ? map->values() : std::vector<float>();
  };
  return {values("elevation"), values("slip"),        values("slip_downhill"),    values("slip_across"),
          values("sinkage"),   values("water_depth"), values("water_velocity_x"), values("water_velocity_y"),
          values("wind_x"),    values("wind_y")};
}

}  // namespace desert_sim

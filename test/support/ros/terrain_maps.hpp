#pragma once
/// A snapshot as the maps that a TerrainClient would have of it, without messages on their way.

#include <boost/make_shared.hpp>

#include "src/ros/conversion/micro_relief_message.hpp"
#include "src/ros/rover/map_ground.hpp"
#include "src/terrain/map_layers.hpp"

namespace node_test {

/// The keyframe of a layer of maps (config/node_parameters.md); 0 where the snapshot lacks it.
inline boost::shared_ptr<desert_sim::LayerGrid> keyframe_of(const desert_sim::Snapshot& s, const char* name) {
  const auto grid = boost::make_shared<desert_sim::LayerGrid>();
  grid->layer = name;
  grid->keyframe = 1;
  grid->width = static_cast<std::uint32_t>(s.width);
  grid->height = static_cast<std::uint32_t>(s.height);
  grid->cell_size = s.cell_size;
  grid->origin.position.x = s.origin_x;
  grid->origin.position.y = s.origin_y;
  grid->origin.orientation.w = 1;
  const std::vector<float>* const values = s.find(desert_sim::find_map_layer(name)->layer);
  grid->data = values ? *values : std::vector<float>(std::size_t{grid->width} * grid->height, 0.0f);
  return grid;
}

inline std::shared_ptr<const desert_sim::LayerMap> map_of(const desert_sim::Snapshot& s, const char* name) {
  desert_sim::LayerMap::Rectangle changed;
  const desert_sim::MapKeyframe keyframe{desert_sim::LayerGrid::ConstPtr(keyframe_of(s, name))};
  return std::make_shared<const desert_sim::LayerMap>(keyframe, nullptr, changed);
}

/// The plants of a state as ~plants sends all of them.
inline boost::shared_ptr<desert_sim::Plants> plants_message_of(const desert_sim::PlantList& list) {
  const auto message = boost::make_shared<desert_sim::Plants>();
  message->step = list.step;
  message->origin.position.x = list.origin_x;
  message->origin.position.y = list.origin_y;
  message->total = list.plants.size();
  for (const desert_sim::plants::PlantRecord& plant : list.plants) {
    message->x.push_back(plant.x);
    message->y.push_back(plant.y);
    message->radius.push_back(plant.radius);
  }
  return message;
}

/// All that a rover knows of a state.
inline desert_sim::TerrainMaps maps_of(const desert_sim::TerrainState& state) {
  desert_sim::TerrainMaps maps;
  for (std::size_t n = 0; n < desert_sim::TerrainMaps::count; ++n)
    maps.maps[n] = map_of(*state.snapshot, desert_sim::TerrainMaps::rows[n].name);
  maps.micro_relief_settings = std::make_shared<const desert_sim::Snapshot>(
      desert_sim::snapshot_of(*desert_sim::micro_relief_message(state, "map")));
  if (state.plants)
    maps.plants = std::make_shared<const desert_sim::MapPlants>(plants_message_of(*state.plants));
  return maps;
}

}  // namespace node_test

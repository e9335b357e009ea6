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

/// All that a rover knows of a state.
inline desert_sim::TerrainMaps maps_of(const desert_sim::TerrainState& state) {
  desert_sim::TerrainMaps maps;
  for (std::size_t n = 0; n < desert_sim::TerrainMaps::count; ++n)
    maps.maps[n] = map_of(*state.snapshot, desert_sim::TerrainMaps::rows[n].name);
  maps.micro_relief_settings = std::make_shared<const desert_sim::Snapshot>(
      desert_sim::snapshot_of(*desert_sim::micro_relief_message(state, "map")));
  return maps;
}

}  // namespace node_test

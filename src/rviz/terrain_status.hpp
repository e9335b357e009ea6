#pragma once
/// What the display desert_sim/Terrain says of itself in rviz's list of displays.

#include <rviz/properties/status_property.h>

#include <string>

#include "include/desert_sim/client/terrain_client.hpp"
#include "src/rviz/map_windows.hpp"
#include "src/rviz/terrain_scene.hpp"

namespace desert_sim {

struct DisplayStatus {
  rviz::StatusProperty::Level level;
  const char* name;
  std::string text;  ///< says what to do if something is missing
};

/// Whether terrain arrives on `topic`, the elevation's.
DisplayStatus status_of_topic(const std::string& topic, const TerrainClient& client, const LayerMaps& maps);

/// `layer` is the overlay's, empty if there is none; `title` is what its legend calls it.
DisplayStatus status_of_overlay(const char* status, const std::string& layer, const std::string& title,
                                const LayerMaps& maps);

DisplayStatus status_of_terrain(const LayerMap::Info& elevation, const TerrainScene::Counts& counts);

/// How much of the ground waits to be built.
DisplayStatus status_of_blocks(const TerrainScene::Counts& counts);

}  // namespace desert_sim

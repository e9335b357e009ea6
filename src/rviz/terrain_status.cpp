#include "src/rviz/terrain_status.hpp"

#include "src/core/joined.hpp"
#include "src/rviz/terrain_source.hpp"

namespace desert_sim {

using rviz::StatusProperty;

DisplayStatus status_of_topic(const std::string& topic, const TerrainClient& client, const LayerMaps& maps) {
  const auto elevation = maps.find("elevation");
  const bool shown = elevation != maps.end();
  if (!client.connected("elevation") && !shown)
    return {StatusProperty::Error, "Topic",
            "Nobody publishes " + topic +
                ": start the node (roslaunch desert_sim desert_sim.launch), or choose another Elevation "
                "Topic."};
  if (!client.connected("elevation"))
    return {StatusProperty::Warn, "Topic",
            "Nobody publishes " + topic +
                " any more: the node has ended. What is shown is its last terrain, of step " +
                std::to_string(elevation->second->info().step) + "; start the node again to go on."};
  if (!shown) return {StatusProperty::Warn, "Topic", "Waiting for the first keyframe of " + topic + "."};
  const bool up_to_date = client.up_to_date("elevation");
  const TerrainClient::Statistics statistics = client.statistics();
  if (!up_to_date)
    return {StatusProperty::Warn, "Topic",
            "Messages were lost (" + statistics.last_gap + "); waiting for a keyframe of " + topic + "."};
  return {StatusProperty::Ok, "Topic",
          std::to_string(statistics.keyframes) + " keyframes, " + std::to_string(statistics.updates) +
              " updates"};
}

DisplayStatus status_of_overlay(const char* status, const std::string& layer, const std::string& title,
                                const LayerMaps& maps) {
  if (layer.empty()) return {StatusProperty::Ok, status, "none"};
  const std::string needed = source_of_layer(layer);
  const bool computed = layer == render::slope_layer || layer == render::change_layer;
  if (!computed && !TerrainSource::is_known(needed))
    return {StatusProperty::Error, status,
            "There is no layer '" + layer + "': choose change, cost, or one of " +
                joined(TerrainClient::known_layers()) + "."};
  if (!computed && !maps.count(needed))
    return {StatusProperty::Warn, status,
            "Waiting for the layer '" + needed + "': the node sends it when it has computed it."};
  return {StatusProperty::Ok, status, title};
}

DisplayStatus status_of_terrain(const LayerMap::Info& elevation, const TerrainScene::Counts& counts) {
  const std::string size =
      std::to_string(elevation.width) + " x " + std::to_string(elevation.height) + " cells";
  if (counts.blocks == 0)
    return {StatusProperty::Error, "Terrain",
            "A terrain of " + size + " has no surface to draw: at least 2 x 2 cells are needed."};
  return {StatusProperty::Ok, "Terrain", size + ", step " + std::to_string(elevation.step)};
}

DisplayStatus status_of_blocks(const TerrainScene::Counts& counts) {
  return {StatusProperty::Ok, "Blocks",
          std::to_string(counts.waiting) + " of " + std::to_string(counts.blocks) + " wait, " +
              std::to_string(counts.triangles) + " triangles"};
}

}  // namespace desert_sim

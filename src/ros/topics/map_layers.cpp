#include "src/ros/topics/map_layers.hpp"

#include <algorithm>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

std::string map_layer_names() {
  std::string names;
  for (const MapLayer& layer : map_layers) names += (names.empty() ? "" : ", ") + std::string(layer.name);
  return names;
}

std::vector<MapLayer> choose_map_layers(const std::vector<std::string>& names, const std::string& key) {
  if (names.size() > map_layers.size())
    throw ConfigError(key + ": " + std::to_string(names.size()) + " names are more than there are layers (" +
                      std::to_string(map_layers.size()) + ")");
  std::vector<MapLayer> chosen;
  for (const std::string& name : names) {
    const auto same = [&](const MapLayer& layer) { return name == layer.name; };
    const auto found = std::find_if(map_layers.begin(), map_layers.end(), same);
    if (found == map_layers.end())
      throw ConfigError(key + ": " + quoted(name) + " is not one of: " + map_layer_names());
    if (std::any_of(chosen.begin(), chosen.end(), same))
      throw ConfigError(key + ": " + quoted(name) + " stands there twice");
    chosen.push_back(*found);
  }
  return chosen;
}

std::string listed(const std::vector<MapLayer>& layers) {
  std::string names;
  for (const MapLayer& layer : layers) names += (names.empty() ? "" : ", ") + std::string(layer.name);
  return "[" + names + "]";
}

std::vector<Layer> terrain_layers(const std::vector<MapLayer>& layers) {
  std::vector<Layer> all;
  for (const MapLayer& layer : layers) all.push_back(layer.layer);
  return all;
}

}  // namespace desert_sim

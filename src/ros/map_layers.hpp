#pragma once
/// The layers that maps and submaps offer, by the names that their users know.

#include <array>
#include <string>
#include <vector>

#include "desert_sim/kernels/layers.hpp"

namespace desert_sim {

struct MapLayer {
  const char* name;
  Layer layer;
  bool worst;  ///< cells that are merged take the lowest value, not the mean
};

constexpr std::array<MapLayer, 18> map_layers{{
    {"elevation", Layer::elevation, false},
    {"bedrock", Layer::bedrock, false},
    {"sand_depth", Layer::sand, false},
    {"water_depth", Layer::water, false},
    {"soil_depth", Layer::soil, false},
    {"vegetation", Layer::vegetation, false},
    {"moisture", Layer::moisture, false},
    {"obstacle", Layer::obstacle, false},
    {"wind_x", Layer::wind_x, false},
    {"wind_y", Layer::wind_y, false},
    {"wind_shadow", Layer::wind_shadow, false},
    {"slope", Layer::slope, false},
    {"roughness", Layer::roughness, false},
    {"step_height", Layer::step_height, false},
    {"traversability", Layer::traversability, true},
    {"normal_x", Layer::normal_x, false},
    {"normal_y", Layer::normal_y, false},
    {"normal_z", Layer::normal_z, false},
}};

/// The names of all, with ", " between them.
std::string map_layer_names();

/// In the order of `names`. Throws ConfigError, naming `key`, for one that is unknown (with the known ones)
/// or stands there twice.
std::vector<MapLayer> choose_map_layers(const std::vector<std::string>& names, const std::string& key);

/// As a list in YAML: [elevation, slope].
std::string listed(const std::vector<MapLayer>& layers);

std::vector<Layer> terrain_layers(const std::vector<MapLayer>& layers);

}  // namespace desert_sim

#pragma once
/// The layers that maps and submaps offer, by the names that their users know.

#include <array>
#include <string>
#include <vector>

#include "kernels/field/layers.hpp"

namespace desert_sim {

/// What cells that are merged into one take: the mean, the lowest value, or that of the one in the middle.
enum class Merged { mean, lowest, middle };

struct MapLayer {
  const char* name;
  Layer layer;
  Merged merged = Merged::mean;
};

constexpr std::array<MapLayer, 26> map_layers{{
    {"elevation", Layer::elevation},
    {"bedrock", Layer::bedrock},
    {"water_surface", Layer::water_surface},
    {"sand_depth", Layer::sand},
    {"water_depth", Layer::water},
    {"soil_depth", Layer::soil},
    {"vegetation", Layer::vegetation},
    {"plants", Layer::plants, Merged::middle},
    {"canopy_height", Layer::canopy_height},
    {"illumination", Layer::illumination},
    {"humus", Layer::humus},
    {"moisture", Layer::moisture},
    {"suspended_sediment", Layer::suspended_sediment},
    {"water_velocity_x", Layer::water_velocity_x},
    {"water_velocity_y", Layer::water_velocity_y},
    {"obstacle", Layer::obstacle},
    {"wind_x", Layer::wind_x},
    {"wind_y", Layer::wind_y},
    {"wind_shadow", Layer::wind_shadow},
    {"slope", Layer::slope},
    {"roughness", Layer::roughness},
    {"step_height", Layer::step_height},
    {"traversability", Layer::traversability, Merged::lowest},
    {"normal_x", Layer::normal_x},
    {"normal_y", Layer::normal_y},
    {"normal_z", Layer::normal_z},
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

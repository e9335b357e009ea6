#pragma once
/// The layers that others can see, by the names that users know: in maps, in the answers of services, as
/// topics, and in clients.

#include <algorithm>
#include <array>
#include <string>

#include "kernels/field/layers.hpp"
#include "src/core/joined.hpp"

namespace desert_sim {

/// The value of a block of cells that are merged into one: the mean, the lowest, or that of the cell in the
/// middle.
enum class Aggregation { mean, min, center };

struct MapLayer {
  const char* name;
  Layer layer;
  /// Change of a value, in the layer's unit, that is worth sending to subscribers of updates.
  double threshold = 0;
  Aggregation aggregation = Aggregation::mean;
  /// Whether a change from or to 0 is always worth it, and 0 is sent exactly.
  bool zero_is_special = false;
};

constexpr std::array<MapLayer, 41> map_layers{{
    {"elevation", Layer::elevation, 0.005},
    {"bedrock", Layer::bedrock, 0.005},
    {"water_surface", Layer::water_surface, 0.005},
    {"sand_depth", Layer::sand, 0.005},
    {"water_depth", Layer::water, 0.005},
    {"soil_depth", Layer::soil, 0.005},
    {"vegetation", Layer::vegetation, 0.01},
    {"plants", Layer::plants, 0, Aggregation::center},
    {"canopy_height", Layer::canopy_height, 0.02},
    {"illumination", Layer::illumination, 0.01},
    {"humus", Layer::humus, 0.001},
    {"moisture", Layer::moisture, 0.001},
    {"suspended_sediment", Layer::suspended_sediment, 0.0005},
    {"airborne_sand", Layer::airborne_sand, 0.01},
    {"water_velocity_x", Layer::water_velocity_x, 0.02},
    {"water_velocity_y", Layer::water_velocity_y, 0.02},
    {"erosion_resistance", Layer::erosion_resistance, 0.01},
    {"obstacle", Layer::obstacle, 0},
    {"looseness", Layer::looseness, 0.01},
    {"grass", Layer::grass, 0.01},
    {"mesquite", Layer::mesquite, 0.01},
    {"shrub", Layer::shrub, 0.01},
    {"burial", Layer::burial, 0.005},
    {"snow_density", Layer::snow_density, 1},
    {"wind_x", Layer::wind_x, 0.05},
    {"wind_y", Layer::wind_y, 0.05},
    {"wind_shadow", Layer::wind_shadow, 0.01},
    {"echo", Layer::echo, 0.01},
    {"flux_x", Layer::flux_x, 0.01},
    {"flux_y", Layer::flux_y, 0.01},
    {"slope", Layer::slope, 0.01},
    {"roughness", Layer::roughness, 0.005},
    {"step_height", Layer::step_height, 0.005},
    {"slip", Layer::slip, 0.01},
    {"slip_downhill", Layer::slip_downhill, 0.01},
    {"slip_across", Layer::slip_across, 0.01},
    {"sinkage", Layer::sinkage, 0.002},
    {"traversability", Layer::traversability, 0.01, Aggregation::min, true},
    {"normal_x", Layer::normal_x, 0.01},
    {"normal_y", Layer::normal_y, 0.01},
    {"normal_z", Layer::normal_z, 0.01},
}};

/// The names of all map layers, with ", " between them.
inline std::string map_layer_names() {
  return joined(map_layers, [](const MapLayer& layer) { return layer.name; });
}

/// The layer of this name; null if there is none.
inline const MapLayer* find_map_layer(const std::string& name) {
  const auto found = std::find_if(map_layers.begin(), map_layers.end(),
                                  [&](const MapLayer& layer) { return name == layer.name; });
  return found == map_layers.end() ? nullptr : &*found;
}

}  // namespace desert_sim

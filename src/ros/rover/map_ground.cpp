#include "src/ros/rover/map_ground.hpp"

#include <algorithm>

#include "src/terrain/map_layers.hpp"

namespace desert_sim {

std::vector<std::string> TerrainMaps::known_names() {
  std::vector<std::string> known;
  for (const char* name : names)
    if (find_map_layer(name)) known.emplace_back(name);
  return known;
}

std::size_t TerrainMaps::index(const std::string& name) {
  return static_cast<std::size_t>(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}

bool TerrainMaps::complete() const {
  for (std::size_t n = 0; n < count; ++n)
    if (!maps[n] && find_map_layer(names[n])) return false;
  return true;
}

bool MapGround::contains(double x, double y) const {
  const MapInfo& info = maps_.info();
  const double east = (x - info.origin_x) / info.cell_size, north = (y - info.origin_y) / info.cell_size;
  return east >= 0 && east <= info.width && north >= 0 && north <= info.height;
}

std::optional<double> MapGround::elevation(double x, double y) const {
  return maps_.maps[TerrainMaps::elevation]->value(x, y);
}

double MapGround::value(TerrainMaps::Which which, double x, double y) const {
  const std::shared_ptr<const LayerMap>& map = maps_.maps[which];
  return map ? map->value(x, y).value_or(0) : 0;
}

GroundPoint MapGround::at(double x, double y) const {
  GroundPoint point;
  point.sand_depth = value(TerrainMaps::sand_depth, x, y);
  if (use_looseness_ && maps_.maps[TerrainMaps::looseness])
    point.looseness = value(TerrainMaps::looseness, x, y);
  point.moisture =
      relative_moisture(value(TerrainMaps::moisture, x, y),
                        point.sand_depth + value(TerrainMaps::soil_depth, x, y), moisture_capacity_);
  if (const std::shared_ptr<const LayerMap>& map = maps_.maps[TerrainMaps::obstacle])
    point.obstacle = map->cell_value(x, y).value_or(0);
  point.water = value(TerrainMaps::water_depth, x, y);
  return point;
}

}  // namespace desert_sim

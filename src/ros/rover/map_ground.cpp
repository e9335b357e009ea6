#include "src/ros/rover/map_ground.hpp"

#include <algorithm>

namespace desert_sim {

namespace {

/// Looks at row after row, because a loose cell is mostly found in the first ones.
bool any_above_0(const LayerMap& map, const LayerMap::Rectangle& cells) {
  for (std::uint32_t y = cells.y; y < cells.y + cells.height; ++y) {
    const std::vector<float> row = map.values({cells.x, y, cells.width, 1});
    if (std::any_of(row.begin(), row.end(), [](float v) { return v > 0; })) return true;
  }
  return false;
}

}  // namespace

std::size_t TerrainMaps::index(const std::string& name) {
  return static_cast<std::size_t>(std::find(std::begin(names), std::end(names), name) - std::begin(names));
}

bool TerrainMaps::complete(bool with_sensors) const {
  return std::all_of(maps.begin(), maps.begin() + (with_sensors ? count : ground_count),
                     [](const auto& map) { return map != nullptr; });
}

void TerrainMaps::set(std::size_t which, const MapChange& change) {
  const MapInfo& info = change.map->info();
  if (which == looseness && !change.cells.empty())
    loose = loose ? any_above_0(*change.map, {0, 0, info.width, info.height})
                  : any_above_0(*change.map, change.cells);
  maps[which] = change.map;
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

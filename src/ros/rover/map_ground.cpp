#include "src/ros/rover/map_ground.hpp"

#include <algorithm>

#include "src/terrain/map_layers.hpp"

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
  const auto* const found =
      std::find_if(std::begin(rows), std::end(rows), [&name](const Row& row) { return name == row.name; });
  return static_cast<std::size_t>(found - std::begin(rows));
}

std::vector<std::string> TerrainMaps::names(unsigned uses, unsigned without) {
  std::vector<std::string> chosen;
  for (const Row& row : rows)
    if ((row.uses & uses) && !(row.uses & without)) chosen.emplace_back(row.name);
  return chosen;
}

bool TerrainMaps::complete(unsigned uses) const {
  for (std::size_t n = 0; n < count; ++n)
    if ((rows[n].uses & uses) && !maps[n]) return false;
  if (!(uses & MapUse::micro_relief)) return true;
  return micro_relief_settings && (plants || !micro_relief_settings->micro_relief.needs_feet());
}

void TerrainMaps::forget(unsigned uses, unsigned without) {
  for (const std::string& name : names(uses, without)) maps[index(name)] = nullptr;
}

std::shared_ptr<const MapMicroRelief> TerrainMaps::micro_relief() const {
  if (!complete(MapUse::micro_relief)) return nullptr;
  MapMicroRelief::Maps layers;
  for (std::size_t n = 0; n < count; ++n) {
    if (!(rows[n].uses & MapUse::micro_relief)) continue;
    if (!maps[n]->same_geometry(*maps[elevation])) return nullptr;
    layers[find_map_layer(rows[n].name)->layer] = maps[n];
  }
  if (plants && !plants->on_terrain_at(info().origin_x, info().origin_y)) return nullptr;
  return std::make_shared<const MapMicroRelief>(std::move(layers), *micro_relief_settings, plants);
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
  const std::optional<double> z = maps_.maps[TerrainMaps::elevation]->value(x, y);
  return z && micro_relief_ ? *z + micro_relief_->offset(x, y) : z;
}

double MapGround::finest_feature() const {
  return micro_relief_ ? MicroRelief::crest_width : GroundSource::finest_feature();
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
  point.moisture = relative_moisture(value(TerrainMaps::moisture, x, y),
                                     point.sand_depth + value(TerrainMaps::soil_depth, x, y),
                                     moisture_capacity_, moisture_depth_);
  if (const std::shared_ptr<const LayerMap>& map = maps_.maps[TerrainMaps::obstacle])
    point.obstacle = map->cell_value(x, y).value_or(0);
  point.water = value(TerrainMaps::water_depth, x, y);
  if (point.water > 0) {
    point.water_x = value(TerrainMaps::water_velocity_x, x, y);
    point.water_y = value(TerrainMaps::water_velocity_y, x, y);
  }
  return point;
}

}  // namespace desert_sim

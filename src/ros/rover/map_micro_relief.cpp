#include "src/ros/rover/map_micro_relief.hpp"

#include <cmath>

namespace desert_sim {

namespace {

/// How far around a point others are expected [m]: some rovers' lengths.
constexpr double reach = 4;

}  // namespace

MapMicroRelief::MapMicroRelief(Maps maps, Snapshot settings, std::shared_ptr<const MapPlants> plants)
    : maps_(std::move(maps)), plants_(std::move(plants)), settings_(std::move(settings)) {
  const MapInfo& info = maps_.at(Layer::elevation)->info();
  settings_.width = static_cast<int>(info.width);
  settings_.height = settings_.micro_relief.grid_height = static_cast<int>(info.height);
  settings_.cell_size = info.cell_size;
  settings_.origin_x = info.origin_x;
  settings_.origin_y = settings_.micro_relief.origin_y = info.origin_y;
}

Snapshot MapMicroRelief::snapshot(const RowBand& band) const {
  const RowBand rows = clamp_band(band, settings_.height, settings_.periodic_y);
  Snapshot s = settings_;
  s.height = rows.count;
  s.origin_y += rows.first * s.cell_size;
  s.periodic_y = settings_.periodic_y && rows.count == settings_.height;
  s.micro_relief.first_row = rows.first;
  s.feet = feet();
  for (const auto& [layer, map] : maps_) {
    std::vector<float>& values = s.layers[layer];
    values.reserve(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height));
    for (int n = 0; n < rows.count; ++n) {
      const auto row = static_cast<std::uint32_t>(wrap(rows.first + n, settings_.height));
      const std::vector<float> cells = map->values({0, row, map->info().width, 1});
      values.insert(values.end(), cells.begin(), cells.end());
    }
  }
  return s;
}

std::shared_ptr<const PlantFeet> MapMicroRelief::feet() const {
  const MicroReliefSettings& s = settings_.micro_relief;
  if (!s.needs_feet()) return nullptr;
  return plants_->feet(s.bump_squares(settings_.width, settings_.cell_size, settings_.periodic_x));
}

std::vector<float> MapMicroRelief::values(Layer layer, const Rectangle& r) const {
  return maps_.at(layer)->values({static_cast<std::uint32_t>(r.x), static_cast<std::uint32_t>(r.y),
                                  static_cast<std::uint32_t>(r.width), static_cast<std::uint32_t>(r.height)});
}

double MapMicroRelief::offset(double x, double y) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!near_ || std::abs(y - near_y_) > reach) {
    near_y_ = y;
    near_ = std::make_unique<const MicroRelief>(
        snapshot(MicroRelief::band({x, y - reach, 1, 1, 2 * reach}, settings_)));
  }
  return near_->offset(x, y);
}

}  // namespace desert_sim

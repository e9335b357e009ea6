#include "src/rover/grid_ground.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "src/core/error.hpp"
#include "src/terrain/bilinear.hpp"

namespace desert_sim {

namespace {

std::vector<float> layer_of(const Snapshot& snapshot, Layer layer) {
  const std::vector<float>* const values = snapshot.find(layer);
  return values ? *values : std::vector<float>();
}

/// Empty, as what is not known, where no cell is loose.
std::vector<float> looseness_of(const Snapshot& snapshot) {
  const std::vector<float> values = layer_of(snapshot, Layer::looseness);
  return std::any_of(values.begin(), values.end(), [](float v) { return v > 0; }) ? values
                                                                                  : std::vector<float>();
}

GridGround::Layers layers_of(const Snapshot& s, double moisture_capacity, double moisture_depth) {
  return {layer_of(s, Layer::elevation),
          layer_of(s, Layer::sand),
          layer_of(s, Layer::soil),
          looseness_of(s),
          layer_of(s, Layer::moisture),
          layer_of(s, Layer::obstacle),
          layer_of(s, Layer::water),
          layer_of(s, Layer::water_velocity_x),
          layer_of(s, Layer::water_velocity_y),
          moisture_capacity,
          moisture_depth};
}

}  // namespace

GridGround::GridGround(const Geometry& geometry, Layers layers) : g_(geometry), layers_(std::move(layers)) {
  const std::size_t cells = static_cast<std::size_t>(g_.width) * static_cast<std::size_t>(g_.height);
  const auto check = [cells](const std::vector<float>& layer, const char* name, bool may_be_empty) {
    if (layer.size() != cells && !(may_be_empty && layer.empty()))
      throw ConfigError("GridGround: " + std::string(name) + " has " + std::to_string(layer.size()) +
                        " values (allowed: one for each of " + std::to_string(cells) + " cells)");
  };
  check(layers_.elevation, "elevation", false);
  check(layers_.sand_depth, "sand_depth", true);
  check(layers_.soil_depth, "soil_depth", true);
  check(layers_.looseness, "looseness", true);
  check(layers_.moisture, "moisture", true);
  check(layers_.obstacle, "obstacle", true);
  check(layers_.water, "water", true);
  check(layers_.water_x, "water_x", true);
  check(layers_.water_y, "water_y", true);
}

GridGround::GridGround(const Snapshot& s, double moisture_capacity, double moisture_depth)
    : GridGround({s.width, s.height, s.cell_size, s.origin_x, s.origin_y, s.periodic_x, s.periodic_y},
                 layers_of(s, moisture_capacity, moisture_depth)) {}

std::unique_ptr<GridGround> GridGround::with_micro_relief(const Snapshot& s, double moisture_capacity,
                                                          double moisture_depth) {
  auto ground = std::make_unique<GridGround>(s, moisture_capacity, moisture_depth);
  ground->micro_relief_ = std::make_unique<MicroRelief>(s);
  return ground;
}

std::vector<Layer> GridGround::layers_of_snapshot(bool micro_relief) {
  std::vector<Layer> layers{Layer::elevation,       Layer::sand,     Layer::soil,  Layer::looseness,
                            Layer::moisture,        Layer::obstacle, Layer::water, Layer::water_velocity_x,
                            Layer::water_velocity_y};
  if (micro_relief) layers.insert(layers.end(), MicroRelief::layers().begin(), MicroRelief::layers().end());
  return layers;
}

bool GridGround::contains(double x, double y) const {
  const double east = (x - g_.origin_x) / g_.cell_size, north = (y - g_.origin_y) / g_.cell_size;
  return (g_.periodic_x ? std::isfinite(east) : east >= 0 && east <= g_.width) &&
         (g_.periodic_y ? std::isfinite(north) : north >= 0 && north <= g_.height);
}

double GridGround::value(const std::vector<float>& layer, double x, double y) const {
  return bilinear(bilinear_axis((x - g_.origin_x) / g_.cell_size, g_.width, g_.periodic_x),
                  bilinear_axis((y - g_.origin_y) / g_.cell_size, g_.height, g_.periodic_y),
                  [&](int i, int j) {
                    return layer[static_cast<std::size_t>(j) * static_cast<std::size_t>(g_.width) +
                                 static_cast<std::size_t>(i)];
                  });
}

double GridGround::cell_value(const std::vector<float>& layer, double x, double y) const {
  if (layer.empty()) return 0;
  const auto cell = [](double cells, int count, bool periodic) {
    const double whole = std::floor(cells);
    return static_cast<std::size_t>(
        std::clamp(periodic ? whole - count * std::floor(whole / count) : whole, 0.0, count - 1.0));
  };
  return layer[cell((y - g_.origin_y) / g_.cell_size, g_.height, g_.periodic_y) *
                   static_cast<std::size_t>(g_.width) +
               cell((x - g_.origin_x) / g_.cell_size, g_.width, g_.periodic_x)];
}

std::optional<double> GridGround::elevation(double x, double y) const {
  if (!contains(x, y)) return std::nullopt;
  const double z = value(layers_.elevation, x, y);
  if (std::isnan(z)) return std::nullopt;
  return micro_relief_ ? z + micro_relief_->offset(x, y) : z;
}

double GridGround::finest_feature() const {
  return micro_relief_ ? MicroRelief::crest_width : GroundSource::finest_feature();
}

GroundPoint GridGround::at(double x, double y) const {
  GroundPoint point;
  if (!contains(x, y)) return point;
  const auto known = [&](const std::vector<float>& layer) {
    const double v = layer.empty() ? 0 : value(layer, x, y);
    return std::isnan(v) ? 0 : v;
  };
  point.sand_depth = known(layers_.sand_depth);
  if (!layers_.looseness.empty()) point.looseness = known(layers_.looseness);
  point.moisture = relative_moisture(known(layers_.moisture), point.sand_depth + known(layers_.soil_depth),
                                     layers_.moisture_capacity, layers_.moisture_depth);
  point.obstacle = cell_value(layers_.obstacle, x, y);
  point.water = known(layers_.water);
  if (point.water > 0) {
    point.water_x = known(layers_.water_x);
    point.water_y = known(layers_.water_y);
  }
  return point;
}

}  // namespace desert_sim

#include "src/planner/heading_costs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"

namespace desert_sim {

HeadingCosts::HeadingCosts(std::shared_ptr<const CostGrid> grid, HeadingLayers layers,
                           const HeadingWeights& weights)
    : grid_(std::move(grid)), layers_(std::move(layers)), weights_(weights) {
  const GridFrame& f = grid_->frame();
  const std::size_t cells = static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height);
  for (const auto* layer : {&layers_.elevation, &layers_.slip, &layers_.slip_downhill, &layers_.slip_across,
                            &layers_.sinkage, &layers_.water_depth, &layers_.water_velocity_x,
                            &layers_.water_velocity_y, &layers_.wind_x, &layers_.wind_y})
    if (!layer->empty() && layer->size() != cells)
      throw ConfigError("a layer of heading costs has another size than the grid");
}

std::optional<double> HeadingCosts::metre(const GridPoint& at, double east, double north) const {
  const auto cell = grid_->cell_at(at);
  if (!cell || grid_->cost(*cell) == CostGrid::lethal) return std::nullopt;
  const GridFrame& f = grid_->frame();
  const int x = grid_->x_of(*cell), y = grid_->y_of(*cell);
  const auto index = [&](int cx, int cy) {
    return static_cast<std::size_t>(std::clamp(cy, 0, f.height - 1)) * static_cast<std::size_t>(f.width) +
           static_cast<std::size_t>(std::clamp(cx, 0, f.width - 1));
  };
  const std::size_t i = index(x, y);
  const double rise_x = value(layers_.elevation, index(x + 1, y)) - value(layers_.elevation, index(x - 1, y)),
               rise_y = value(layers_.elevation, index(x, y + 1)) - value(layers_.elevation, index(x, y - 1)),
               steepness = elementary::hypot(rise_x, rise_y);
  const double uphill = steepness > 0 ? (rise_x * east + rise_y * north) / steepness : 0;
  const double up = value(layers_.slip, i), down = value(layers_.slip_downhill, i);
  const double slip = (up + down) / 2 + uphill * std::abs(uphill) * (up - down) / 2;
  const double headwind = -(value(layers_.wind_x, i) * east + value(layers_.wind_y, i) * north);
  const double depth = std::max(value(layers_.water_depth, i), 0.0),
               speed =
                   elementary::hypot(value(layers_.water_velocity_x, i), value(layers_.water_velocity_y, i));
  return 1 + weights_.slip * std::max(slip, 0.0) +
         weights_.drift * (1 - uphill * uphill) * std::abs(value(layers_.slip_across, i)) +
         weights_.sinkage * std::max(value(layers_.sinkage, i), 0.0) +
         depth * (weights_.water + weights_.flow * speed) + weights_.wind * std::max(headwind, 0.0);
}

std::optional<double> HeadingCosts::line(const GridPoint& from, const GridPoint& to) const {
  const double length = elementary::hypot(to.x - from.x, to.y - from.y);
  if (!line_cost(*grid_, from, to)) return std::nullopt;
  if (!(length > 0)) return 0;
  const int samples = std::max(1, static_cast<int>(std::ceil(length / grid_->frame().cell_size)));
  double sum = 0, last = 1;
  for (int n = 0; n < samples; ++n) {
    const double share = (n + 0.5) / samples;
    // A sample on the corner of a lethal cell, which the line only touches, costs as much as the one before.
    last = metre({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share},
                 (to.x - from.x) / length, (to.y - from.y) / length)
               .value_or(last);
    sum += last;
  }
  return sum * length / samples;
}

std::optional<double> HeadingCosts::path(const GridPath& path) const {
  double sum = 0;
  for (std::size_t n = 1; n < path.size(); ++n) {
    const auto cost = line(path[n - 1], path[n]);
    if (!cost) return std::nullopt;
    sum += *cost;
  }
  return sum;
}

}  // namespace desert_sim

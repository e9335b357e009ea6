#include <algorithm>
#include <cmath>

#include "kernels/wind/wind_features.hpp"
#include "src/core/constants.hpp"

namespace desert_sim::wind_features {

namespace {

/// The coordinate of a cell as near as possible to the grid: a periodic axis is reduced before double
/// becomes float.
float from_corner(double position, double origin, double extent, bool periodic) {
  const double d = position - origin;
  return static_cast<float>(periodic ? d - extent * std::floor(d / extent) : d);
}

/// β is the largest with which a jet is no faster at the seam, (1 + 1.2 β) exp(−(E/π)²/2R²), than in its
/// middle.
FeatureAxis feature_axis(const WindFeature& f, double extent, bool periodic) {
  if (!periodic) return {1 / f.scale, 0, 0};
  const double cells = std::max(2.0, std::round(extent / static_cast<double>(f.scale)));
  const double reach = f.kind == WindFeatureKind::jet ? std::max(f.radius, f.length) : f.radius;
  const double at_seam = std::min(0.5 * extent * extent / (pi * pi * reach * reach), 1.0);
  return {static_cast<float>(cells / extent), static_cast<int>(std::min(cells, 1e9)),
          static_cast<float>(std::min(std::expm1(at_seam) / 1.2, 1.0))};
}

}  // namespace

Prepared prepare(const WindFeature& feature, wind::Vector direction, const Grid& grid, double origin_x,
                 double origin_y, double time) {
  const double cell = static_cast<double>(grid.cell_size), width = grid.width * cell,
               height = grid.height * cell, e = std::exp(1.0);
  Prepared p;
  p.feature = feature;
  p.x = from_corner(feature.x, origin_x, width, grid.periodic_x);
  p.y = from_corner(feature.y, origin_y, height, grid.periodic_y);
  p.direction = direction;
  const double speed = feature.speed, radius = feature.radius, length = feature.length;
  if (feature.kind == WindFeatureKind::vortex)
    p.amplitude = static_cast<float>(speed * std::sqrt(e));
  else if (feature.kind == WindFeatureKind::jet)
    p.amplitude = static_cast<float>(speed / std::max(1.0, radius / (e * length)));
  else
    p.amplitude = static_cast<float>(0.925 * speed);
  p.axis_x = feature_axis(feature, width, grid.periodic_x);
  p.axis_y = feature_axis(feature, height, grid.periodic_y);
  set_time(p, time);
  return p;
}

void set_time(Prepared& p, double time) {
  const double lives = time / static_cast<double>(p.feature.life_time), whole = std::floor(lives);
  p.life = static_cast<std::uint32_t>(std::fmod(whole, 0x1p32));
  p.share_of_life = static_cast<float>(lives - whole);
}

}  // namespace desert_sim::wind_features

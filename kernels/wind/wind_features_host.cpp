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

/// Of ψ or χ without its lengths [m/s].
double amplitude(const WindFeature& f) {
  const double speed = f.speed, radius = f.radius, length = f.length, e = std::exp(1.0);
  switch (f.kind) {
    case WindFeatureKind::vortex:
    case WindFeatureKind::sink:
      return speed * std::sqrt(e);
    case WindFeatureKind::jet:
      return speed / std::max(1.0, radius / (e * length));
    case WindFeatureKind::turbulence:
      return 0.925 * speed;
  }
  return 0;
}

}  // namespace

Prepared prepare(const WindFeature& feature, wind::Vector direction, const Grid& grid, double origin_x,
                 double origin_y, double time) {
  const double cell = static_cast<double>(grid.cell_size);
  Prepared p;
  p.feature = feature;
  p.direction = direction;
  p.axis_x = feature_axis(feature, grid.width * cell, grid.periodic_x);
  p.axis_y = feature_axis(feature, grid.height * cell, grid.periodic_y);
  set_time(p, grid, origin_x, origin_y, time);
  return p;
}

void set_time(Prepared& p, const Grid& grid, double origin_x, double origin_y, double time) {
  const WindFeature& f = p.feature;
  const double cell = static_cast<double>(grid.cell_size), since = time - f.begin;
  const bool there = since >= 0 && (f.end == 0 || time < f.end);
  p.amplitude = there ? static_cast<float>(amplitude(f)) : 0;
  p.x = from_corner(f.x + static_cast<double>(f.velocity_x) * since, origin_x, grid.width * cell,
                    grid.periodic_x);
  p.y = from_corner(f.y + static_cast<double>(f.velocity_y) * since, origin_y, grid.height * cell,
                    grid.periodic_y);
  const double lives = time / static_cast<double>(p.feature.life_time), whole = std::floor(lives);
  p.life = static_cast<std::uint32_t>(std::fmod(whole, 0x1p32));
  p.share_of_life = static_cast<float>(lives - whole);
}

}  // namespace desert_sim::wind_features

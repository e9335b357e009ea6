#include <algorithm>
#include <cmath>

#include "kernels/wind/wind_features.hpp"
#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"

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
FeatureAxis feature_axis(const WindFeatureParameters& f, double extent, bool periodic) {
  if (!periodic) return {1 / f.scale, 0, 0};
  const double cells = std::max(2.0, std::round(extent / static_cast<double>(f.scale)));
  const double reach = f.kind == WindFeatureKind::jet ? std::max(f.radius, f.length) : f.radius;
  const double at_seam = std::min(0.5 * extent * extent / (pi * pi * reach * reach), 1.0);
  return {static_cast<float>(cells / extent), static_cast<int>(std::min(cells, 1e9)),
          static_cast<float>(std::min(elementary::expm1(at_seam) / 1.2, 1.0))};
}

/// Of ψ or χ without its lengths [m/s].
double amplitude(const WindFeatureParameters& f) {
  const double speed = f.speed, radius = f.radius, length = f.length, e = elementary::exp(1);
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

/// In the terrain's frame [m].
struct Centre {
  double x, y;
};

Centre centre_at(const WindFeature& f, double time) {
  if (f.path.empty()) {
    const double since = time - f.begin;
    return {f.x + static_cast<double>(f.velocity_x) * since, f.y + static_cast<double>(f.velocity_y) * since};
  }
  const auto next = std::upper_bound(f.path.begin(), f.path.end(), time,
                                     [](double t, const WindPathPoint& point) { return t < point.time; });
  if (next == f.path.begin()) return {next->x, next->y};
  const WindPathPoint& from = *(next - 1);
  if (next == f.path.end()) return {from.x, from.y};
  const double span = next->time - from.time, since = time - from.time;
  return {from.x + (next->x - from.x) / span * since, from.y + (next->y - from.y) / span * since};
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
  set_time(p, feature, grid, origin_x, origin_y, time);
  return p;
}

void set_time(Prepared& p, const WindFeature& f, const Grid& grid, double origin_x, double origin_y,
              double time) {
  const double cell = static_cast<double>(grid.cell_size);
  const bool there = time >= f.begin && (f.end == 0 || time < f.end);
  const Centre centre = centre_at(f, time);
  p.amplitude = there ? static_cast<float>(amplitude(f)) : 0;
  p.x = from_corner(centre.x, origin_x, grid.width * cell, grid.periodic_x);
  p.y = from_corner(centre.y, origin_y, grid.height * cell, grid.periodic_y);
  const double lives = time / static_cast<double>(p.feature.life_time), whole = std::floor(lives);
  p.life = static_cast<std::uint32_t>(std::fmod(whole, 0x1p32));
  p.share_of_life = static_cast<float>(lives - whole);
}

}  // namespace desert_sim::wind_features

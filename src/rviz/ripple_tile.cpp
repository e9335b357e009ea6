#include "src/rviz/ripple_tile.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/micro_relief/ripples.hpp"
#include "src/render/sunlight.hpp"

namespace desert_sim {

namespace {

constexpr std::uint8_t level_light = 128;
constexpr int ripples_in_tile = 32;

bool has_ripples(const MicroReliefState& s) { return s.ripple_wavelength > 0 && s.ripple_height > 0; }

/// Ripples of one size everywhere, on a lattice of patches of this side [m] that repeats.
micro_relief::Ripples ripples_of(const MicroReliefState& s, double side) {
  MicroReliefParameters p;
  p.shortest = p.longest = s.ripple_wavelength;
  p.growth = 0;
  p.steepness = s.ripple_height / s.ripple_wavelength;
  p.threshold_speed = static_cast<float>(s.mean_speed) - 1;  // fully developed
  const double patches =
      std::max(3.0, side / std::max(double{p.crest_length}, 3 * double{s.ripple_wavelength}));
  return {p,
          {s.mean_wind_x, s.mean_wind_y, s.mean_speed, 0},
          s.seed,
          micro_relief::Lattice(side, side, side / std::floor(patches), true, true)};
}

/// Heights [m] of the pixels of a tile.
std::vector<float> heights_of(const micro_relief::Ripples& ripples, double side) {
  using micro_relief::RipplePatch;
  constexpr float full = 1, nothing = 0;
  micro_relief::Cells cells;  // a single one, in which the wind is that high above, and nothing grows
  cells.x.periodic = cells.y.periodic = true;
  cells.rows = 1;
  cells.turn_x = &full;
  cells.turn_y = cells.growth = &nothing;
  const micro_relief::Lattice& lattice = ripples.lattice;
  std::vector<RipplePatch> patches;
  for (int j = 0; j < lattice.y.count; ++j)
    for (int i = 0; i < lattice.x.count; ++i) patches.push_back(ripples.patch(cells, i, j));
  const auto patch_of = [&](int i, int j) -> const RipplePatch& {
    return patches[static_cast<std::size_t>(lattice.row(j) * lattice.x.count + lattice.column(i))];
  };
  std::vector<float> heights;
  heights.reserve(static_cast<std::size_t>(RippleTile::pixels) * RippleTile::pixels);
  for (int row = 0; row < RippleTile::pixels; ++row)
    for (int column = 0; column < RippleTile::pixels; ++column) {
      const auto place = [&](int n) { return (n + 0.5) * side / RippleTile::pixels; };
      const micro_relief::Ripples::Wave wave =
          ripples.wave(lattice.square(place(column), place(row)), patch_of);
      heights.push_back(wave.height * wave.shape);
    }
  return heights;
}

}  // namespace

bool ripples_differ(const MicroReliefState& a, const MicroReliefState& b) {
  if (has_ripples(a) != has_ripples(b)) return true;
  const auto other = [](double x, double y) {
    return std::abs(x - y) > 0.05 * std::max(std::abs(x), std::abs(y));
  };
  if (other(double{a.ripple_wavelength}, double{b.ripple_wavelength}) ||
      other(double{a.ripple_height}, double{b.ripple_height}))
    return true;
  const double sine = a.mean_wind_x * b.mean_wind_y - a.mean_wind_y * b.mean_wind_x,
               cosine = a.mean_wind_x * b.mean_wind_x + a.mean_wind_y * b.mean_wind_y;
  return std::abs(std::atan2(sine, cosine)) > 0.0524;
}

RippleTile ripple_tile(const MicroReliefState& state) {
  constexpr int n = RippleTile::pixels;
  RippleTile tile;
  tile.brightness.assign(static_cast<std::size_t>(n) * n, level_light);
  if (!has_ripples(state)) return tile;
  tile.side = ripples_in_tile * state.ripple_wavelength;
  const std::vector<float> heights = heights_of(ripples_of(state, double{tile.side}), double{tile.side});
  const auto height = [&](int column, int row) {
    return heights[static_cast<std::size_t>((row + n) % n) * n + static_cast<std::size_t>((column + n) % n)];
  };
  const float run = 2 * tile.side / n;
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) {
      const float x = (height(column + 1, row) - height(column - 1, row)) / run,
                  y = (height(column, row + 1) - height(column, row - 1)) / run,
                  up = 1 / std::sqrt(1 + x * x + y * y);
      const float light = render::illumination(-x * up, -y * up, up).g * level_light;
      tile.brightness[static_cast<std::size_t>(row) * n + static_cast<std::size_t>(column)] =
          static_cast<std::uint8_t>(std::min(255.0f, light + 0.5f));
    }
  return tile;
}

}  // namespace desert_sim

#include "src/ros/conversion/surface_colour.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim {

namespace {

constexpr Colour sand_colour{0.93f, 0.76f, 0.50f}, rock_colour{0.45f, 0.40f, 0.36f},
    soil_colour{0.42f, 0.32f, 0.23f}, plant_colour{0.27f, 0.46f, 0.16f}, shallow_colour{0.37f, 0.65f, 0.80f},
    deep_colour{0.08f, 0.22f, 0.47f}, obstacle_colour{0.56f, 0.36f, 0.78f};
constexpr float covering_depth = 0.1f;              // of sand or soil, which hides what is below [m]
constexpr float puddle = 0.02f, deep_water = 3.0f;  // [m]

// The direction of the sun, low in the west-north-west, so that slip faces under a west wind are in shade.
constexpr float sun_x = -0.760f, sun_y = 0.276f, sun_z = 0.588f;
constexpr float ambient = 0.30f, brightest = 1.30f;

Colour mix(const Colour& a, const Colour& b, float share) {
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

float value(const std::vector<float>* layer, std::size_t i) { return layer ? (*layer)[i] : 0.0f; }

}  // namespace

Colour water_colour(float depth) {
  return mix(shallow_colour, deep_colour, std::min(1.0f, depth / deep_water));
}

SurfaceColour::SurfaceColour(const Snapshot& snapshot, int reach)
    : s_(snapshot),
      reach_(std::max(1, reach)),
      elevation_(s_.find(Layer::elevation)),
      sand_(s_.find(Layer::sand)),
      soil_(s_.find(Layer::soil)),
      water_(s_.find(Layer::water)),
      vegetation_(s_.find(Layer::vegetation)),
      plants_(s_.find(Layer::plants)),
      obstacle_(s_.find(Layer::obstacle)) {}

Colour SurfaceColour::plants(std::size_t i) const {
  const auto species = static_cast<std::size_t>(value(plants_, i));
  if (species == 0 || species > s_.crown_colours.size()) return plant_colour;
  const auto& [r, g, b] = s_.crown_colours[species - 1];
  return {r, g, b};
}

Colour SurfaceColour::material(std::size_t i) const {
  if (value(obstacle_, i) > 0) return obstacle_colour;
  const auto share = [i](const std::vector<float>* layer, float all) {
    return std::min(1.0f, value(layer, i) / all);
  };
  Colour colour = mix(rock_colour, soil_colour, share(soil_, covering_depth));
  colour = mix(colour, sand_colour, share(sand_, covering_depth));
  colour = mix(colour, plants(i), share(vegetation_, 1.0f));
  return mix(colour, water_colour(value(water_, i)), 0.85f * share(water_, puddle));
}

/// The factor by which light brightens or darkens the colour; 1 on level ground.
float SurfaceColour::light(int x, int y) const {
  const int x0 = std::max(0, x - reach_), x1 = std::min(s_.width - 1, x + reach_);
  const int y0 = std::max(0, y - reach_), y1 = std::min(s_.height - 1, y + reach_);
  const auto z = [this](int ix, int iy) {
    return (*elevation_)[static_cast<std::size_t>(iy) * s_.width + ix];
  };
  const float l = static_cast<float>(s_.cell_size);
  const float dz_dx = x1 > x0 ? (z(x1, y) - z(x0, y)) / (static_cast<float>(x1 - x0) * l) : 0.0f;
  const float dz_dy = y1 > y0 ? (z(x, y1) - z(x, y0)) / (static_cast<float>(y1 - y0) * l) : 0.0f;
  const float towards_sun =
      (sun_z - dz_dx * sun_x - dz_dy * sun_y) / std::sqrt(1 + dz_dx * dz_dx + dz_dy * dz_dy);
  return std::min(brightest, ambient + (1 - ambient) * std::max(0.0f, towards_sun) / sun_z);
}

Colour SurfaceColour::at(int x, int y) const {
  const Colour c = material(static_cast<std::size_t>(y) * s_.width + x);
  const float l = light(x, y);
  return {std::min(1.0f, c.r * l), std::min(1.0f, c.g * l), std::min(1.0f, c.b * l)};
}

}  // namespace desert_sim

#include "src/ros/conversion/surface_colour.hpp"

#include <algorithm>
#include <cmath>

#include "src/render/sunlight.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim {

using render::Colour;

namespace {

float value(const std::vector<float>* layer, std::size_t i) { return layer ? (*layer)[i] : 0.0f; }

}  // namespace

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

Colour SurfaceColour::material(std::size_t i) const {
  render::SurfaceMaterials m;
  m.sand = render::cover_of_depth(value(sand_, i));
  m.soil = render::cover_of_depth(value(soil_, i));
  m.vegetation = value(vegetation_, i);
  m.obstacle = value(obstacle_, i);
  const auto species = static_cast<std::size_t>(value(plants_, i));
  if (species > 0 && species <= s_.crown_colours.size()) {
    const auto& [r, g, b] = s_.crown_colours[species - 1];
    m.plants = Colour{r, g, b};
  }
  const float depth = value(water_, i);
  return mix(ground_colour(m, s_.palette), render::water_colour(depth, s_.palette),
             render::water_opacity(depth));
}

Colour SurfaceColour::light(int x, int y) const {
  const int x0 = std::max(0, x - reach_), x1 = std::min(s_.width - 1, x + reach_);
  const int y0 = std::max(0, y - reach_), y1 = std::min(s_.height - 1, y + reach_);
  const auto z = [this](int ix, int iy) {
    return (*elevation_)[static_cast<std::size_t>(iy) * s_.width + ix];
  };
  const float l = static_cast<float>(s_.cell_size);
  const float dz_dx = x1 > x0 ? (z(x1, y) - z(x0, y)) / (static_cast<float>(x1 - x0) * l) : 0.0f;
  const float dz_dy = y1 > y0 ? (z(x, y1) - z(x, y0)) / (static_cast<float>(y1 - y0) * l) : 0.0f;
  const float up = 1 / std::sqrt(1 + dz_dx * dz_dx + dz_dy * dz_dy);
  return render::illumination(-dz_dx * up, -dz_dy * up, up);
}

Colour SurfaceColour::at(int x, int y) const {
  return lit(material(static_cast<std::size_t>(y) * s_.width + x), light(x, y));
}

}  // namespace desert_sim

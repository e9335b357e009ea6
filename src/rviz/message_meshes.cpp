#include "src/rviz/message_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/render/drawable.hpp"
#include "src/render/plant_shapes.hpp"
#include "src/render/wind_arrows.hpp"

namespace desert_sim {

using render::is_drawable;

std::optional<render::Mesh> wind_mesh(const WindField& m, const LayerMap& ground, int most) {
  const std::size_t cells = static_cast<std::size_t>(m.width) * m.height;
  constexpr std::uint32_t widest = std::numeric_limits<int>::max();
  if (m.width > widest || m.height > widest || m.u.size() != cells || m.v.size() != cells)
    return std::nullopt;
  const LayerMap::Info& info = ground.info();
  const double x = m.origin.position.x - info.origin_x, y = m.origin.position.y - info.origin_y;
  if (!is_drawable(m.cell_size) || !is_drawable(x) || !is_drawable(y)) return std::nullopt;
  const render::WindGrid wind{
      static_cast<int>(m.width),       static_cast<int>(m.height), m.cell_size, x, y, m.u, m.v,
      std::hypot(m.above.x, m.above.y)};
  const auto height = [&](double east, double north) {
    return ground.value(info.origin_x + east, info.origin_y + north)
        .value_or(std::numeric_limits<double>::quiet_NaN());
  };
  return render::wind_arrows(wind, most, height);
}

namespace {

bool is_drawable_plant(const Plants& m, std::size_t n) {
  return m.species_index[n] < m.species.size() && is_drawable(m.x[n]) && is_drawable(m.y[n]) &&
         is_drawable(m.z[n]) && is_drawable(m.radius[n]) && is_drawable(m.species[m.species_index[n]].stem);
}

}  // namespace

PlantsMesh plants_mesh(const Plants& m, double corner_x, double corner_y, double vertical_exaggeration,
                       int most) {
  const double x = m.origin.position.x - corner_x, y = m.origin.position.y - corner_y;
  if (!is_drawable(x) || !is_drawable(y)) return {};
  const std::size_t count = std::min(
      {m.x.size(), m.y.size(), m.z.size(), m.radius.size(), m.species_index.size(), m.health.size()});
  std::vector<std::size_t> drawn;
  std::vector<float> radii;
  for (std::size_t n = 0; n < count; ++n) {
    if (!is_drawable_plant(m, n)) continue;
    drawn.push_back(n);
    radii.push_back(m.radius[n]);
  }
  std::vector<render::Plant> plants;
  std::vector<std::uint8_t> species;
  for (const std::size_t chosen : render::widest_plants(radii, static_cast<std::size_t>(most))) {
    const std::size_t n = drawn[chosen];
    const std::uint8_t kind = m.species_index[n];
    plants.push_back({x + static_cast<double>(m.x[n]), y + static_cast<double>(m.y[n]),
                      static_cast<double>(m.z[n]), static_cast<double>(m.radius[n]),
                      static_cast<double>(m.species[kind].stem), m.health[n] / 255.0});
    species.push_back(kind);
  }
  render::PlantLook look;
  look.vertical_exaggeration = vertical_exaggeration;
  for (const PlantSpecies& one : m.species) look.colours.push_back(render::crown_colour(one.hue));
  return {render::plants_mesh(plants, species, look), plants.size()};
}

}  // namespace desert_sim

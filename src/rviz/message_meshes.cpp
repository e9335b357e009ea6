#include "src/rviz/message_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "src/render/drawable.hpp"
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

render::PlantTiles plant_tiles(const Plants& m) {
  render::PlantColumns columns;
  columns.count = std::min(
      {m.x.size(), m.y.size(), m.z.size(), m.radius.size(), m.species_index.size(), m.health.size()});
  columns.x = m.x.data();
  columns.y = m.y.data();
  columns.foot = m.z.data();
  columns.radius = m.radius.data();
  columns.kind = m.species_index.data();
  columns.health = m.health.data();
  std::vector<render::PlantKind> kinds;
  for (const PlantSpecies& one : m.species)
    kinds.push_back({static_cast<double>(one.stem), render::crown_colour(one.hue)});
  return {columns, std::move(kinds)};
}

}  // namespace desert_sim

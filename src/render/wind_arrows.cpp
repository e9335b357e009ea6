#include "src/render/wind_arrows.hpp"

#include <cmath>

#include "src/render/drawable.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim::render {

namespace {

constexpr double slowest = 0.02;  // of the speed high above: calm air has no arrow
constexpr double longest = 1.5;   // spacings

struct Arrow {
  double x, y, along_x, along_y, length, spacing;
  PackedColour colour;
};

/// A shaft of two quads, which follows the surface, and a head.
void add_arrow(const Arrow& a, const std::function<double(double, double)>& ground, Mesh& mesh) {
  const double half = 0.035 * a.spacing, lift = 0.04 * a.spacing,
               head = std::min(0.3 * a.spacing, 0.5 * a.length);
  const std::size_t first_vertex = mesh.vertices.size(), first_index = mesh.indices.size();
  bool over_a_hole = false;
  const auto add = [&](double along, double across) {
    const double x = a.x + along * a.along_x - across * a.along_y,
                 y = a.y + along * a.along_y + across * a.along_x;
    const double z = ground(a.x + along * a.along_x, a.y + along * a.along_y) + lift;
    over_a_hole = over_a_hole || std::isnan(z);
    mesh.vertices.push_back(
        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0, 0, 1, a.colour});
  };
  const double shaft = a.length - head;
  for (const double along : {0.0, 0.5 * shaft, shaft}) {
    add(along, -half);
    add(along, half);
  }
  add(shaft, -3 * half);
  add(shaft, 3 * half);
  add(a.length, 0);
  if (over_a_hole) {
    mesh.vertices.resize(first_vertex);
    mesh.indices.resize(first_index);
    return;
  }
  for (const std::uint32_t corner : {0, 2, 3, 0, 3, 1, 2, 4, 5, 2, 5, 3, 6, 8, 7})
    mesh.indices.push_back(static_cast<std::uint32_t>(first_vertex) + corner);
}

}  // namespace

Mesh wind_arrows(const WindGrid& wind, int most, const std::function<double(double, double)>& ground) {
  Mesh mesh;
  if (most < 1 || wind.width < 1 || wind.height < 1) return mesh;
  int step = 1;  // cells between arrows
  const auto along = [&step](int cells) { return (cells + step - 1) / step; };
  while (static_cast<std::int64_t>(along(wind.width)) * along(wind.height) > most) ++step;
  const double spacing = step * wind.cell_size,
               reference = wind.speed_above > 0.1 && is_drawable(wind.speed_above) ? wind.speed_above : 1;
  for (int row = step / 2; row < wind.height; row += step)
    for (int column = step / 2; column < wind.width; column += step) {
      const std::size_t n = static_cast<std::size_t>(row) * static_cast<std::size_t>(wind.width) +
                            static_cast<std::size_t>(column);
      const double u = wind.u[n], v = wind.v[n], speed = std::hypot(u, v);
      if (!(speed > slowest * reference) || !is_drawable(speed)) continue;  // also NaN
      const double x = wind.x + (column + 0.5) * wind.cell_size, y = wind.y + (row + 0.5) * wind.cell_size;
      add_arrow({x, y, u / speed, v / speed, spacing * std::min(0.75 * speed / reference, longest), spacing,
                 pack(wind_colour(static_cast<float>(speed / reference)))},
                ground, mesh);
    }
  mesh.surface_indices = mesh.indices.size();
  return mesh;
}

}  // namespace desert_sim::render

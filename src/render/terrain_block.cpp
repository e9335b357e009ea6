#include "src/render/terrain_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "src/render/contour_lines.hpp"
#include "src/render/sunlight.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim::render {

namespace {

/// The layers that make the colour of the ground. A terrain of which only the elevation is known is drawn as
/// sand.
struct MaterialWindows {
  CellWindow sand, soil;  ///< cover
  CellWindow moisture, vegetation, obstacle, resistance;

  MaterialWindows(const LayerWindow& window, const CellRectangle& cells)
      : sand(cover_of(window("sand_depth", cells))),
        soil(cover_of(window("soil_depth", cells))),
        moisture(window("moisture", cells)),
        vegetation(window("vegetation", cells)),
        obstacle(window("obstacle", cells)),
        resistance(window("erosion_resistance", cells)) {}
  MaterialWindows() = default;

  float sand_cover(int x, int y) const { return sand.empty() ? 1.0f : smoothed(sand, x, y); }
  /// `cover`: that of sand there.
  Colour at(int x, int y, float cover) const {
    SurfaceMaterials m;
    m.sand = cover;
    if (!soil.empty()) m.soil = smoothed(soil, x, y);
    const auto set = [&](const CellWindow& layer, float& value) {
      if (!layer.empty()) value = layer.at(x, y);
    };
    set(moisture, m.moisture);
    set(vegetation, m.vegetation);
    set(obstacle, m.obstacle);
    set(resistance, m.resistance);
    if (!(m.resistance > 0))
      m.resistance = SurfaceMaterials().resistance;  // the terrain does not have the layer
    return ground_colour(m);
  }

 private:
  static CellWindow cover_of(const CellWindow& depth) {
    std::vector<float> values = depth.values();
    std::transform(values.begin(), values.end(), values.begin(), cover_of_depth);
    return {depth.cells(), std::move(values)};
  }
  /// The cover around a cell, by binomial weights. The edge of sand is sharper than a cell; drawn as it is,
  /// it follows the grid in teeth.
  static float smoothed(const CellWindow& cover, int x, int y) {
    float sum = 0, weights = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        if (!cover.cells().contains(x + dx, y + dy)) continue;
        const auto weight = static_cast<float>((2 - std::abs(dx)) * (2 - std::abs(dy)));
        sum += weight * cover.at(x + dx, y + dy);
        weights += weight;
      }
    return sum / weights;
  }
};

constexpr float degrees = 180 / 3.14159265f;

/// How much of ripples is seen: on sand that the sun reaches, and not on slip faces, where sand slides.
float ripples_on(float sand_cover, float normal_z, float sun) {
  constexpr float gentle = 0.94f, steep = 0.88f;  // 20 and 28 degrees
  return sand_cover * smooth_step(steep, gentle, normal_z) * sun;
}

/// The light on a surface of true heights that is seen with exaggerated ones; `sun`: the share that reaches
/// it.
Colour light_on(float normal_x, float normal_y, float normal_z, float exaggeration, float sun) {
  const float x = normal_x * exaggeration, y = normal_y * exaggeration,
              length = std::sqrt(x * x + y * y + normal_z * normal_z);
  return illumination(x / length, y / length, normal_z / length, sun);
}

}  // namespace

float base_of_walls(const BlockLayout& layout, double cell_size, const LayerWindow& window) {
  const int width = layout.width(), height = layout.height();
  if (width == 0 || height == 0) return std::numeric_limits<float>::quiet_NaN();
  float lowest = std::numeric_limits<float>::infinity();
  for (const CellRectangle& edge : {CellRectangle{0, 0, width, 1}, CellRectangle{0, height - 1, width, 1},
                                    CellRectangle{0, 0, 1, height}, CellRectangle{width - 1, 0, 1, height}}) {
    const CellWindow cells = window("elevation", edge);
    for (int y = edge.y; y < edge.top(); ++y)
      for (int x = edge.x; x < edge.right(); ++x) lowest = std::fmin(lowest, cells.at(x, y));
  }
  return std::isinf(lowest) ? std::numeric_limits<float>::quiet_NaN()
                            : lowest - static_cast<float>(wall_share * cell_size * std::max(width, height));
}

std::vector<std::string> layers_for(const TerrainLook& look) {
  std::vector<std::string> layers{"elevation"};
  if (look.materials)
    layers.insert(layers.end(),
                  {"sand_depth", "soil_depth", "moisture", "vegetation", "obstacle", "erosion_resistance"});
  if (look.water) layers.emplace_back("water_depth");
  const std::string& shown = look.overlay.layer;
  const bool computed = shown == slope_layer || shown == change_layer;
  if (look.overlay.active() && !computed && std::find(layers.begin(), layers.end(), shown) == layers.end())
    layers.push_back(shown);
  return layers;
}

TerrainBlock build_terrain_block(const TerrainGrid& grid, int block, int level, const LayerWindow& window,
                                 const TerrainLook& look) {
  TerrainBlock result;
  const BlockLayout& layout = grid.layout;
  const CellRectangle whole{0, 0, layout.width(), layout.height()}, vertices = layout.vertices(block);
  const CellRectangle cells = layout.needed_cells(block, level);
  CellRectangle seen = cells_that_shade(vertices, grid.shadow_reach).clipped(whole);
  seen.include(cells);
  const CellWindow elevation = window("elevation", seen);
  const MaterialWindows materials =
      look.materials ? MaterialWindows(window, vertices.grown(1).clipped(whole)) : MaterialWindows();
  const bool slope = look.overlay.layer == slope_layer;
  const CellWindow overlay =
      look.overlay.active() && !slope ? window(look.overlay.layer, vertices) : CellWindow();
  const auto exaggeration = static_cast<float>(look.vertical_exaggeration);
  const CellWindow sun = grid.shadow_reach > 0
                             ? sun_visibility(vertices, elevation, grid.cell_size, exaggeration)
                             : CellWindow();
  const auto sun_at = [&](int x, int y) { return sun.empty() ? 1.0f : sun.at(x, y); };
  const auto light_at = [&](int x, int y, float nx, float ny, float nz) {
    return !look.light ? Colour{1, 1, 1} : light_on(nx, ny, nz, exaggeration, sun_at(x, y));
  };
  result.ground = build_block(
      layout, block, level, grid.cell_size, elevation,
      [&](int x, int y, float nx, float ny, float nz) {
        const float sand = materials.sand_cover(x, y);
        Colour colour = materials.at(x, y, sand);
        if (slope) colour = look.overlay.on(colour, degrees * std::acos(std::min(1.0f, nz)));
        if (!overlay.empty()) colour = look.overlay.on(colour, overlay.at(x, y));
        const float alpha = look.ripples ? ripples_on(sand, nz, sun_at(x, y)) : 1.0f;
        return pack(lit(colour, light_at(x, y, nx, ny, nz)), alpha);
      },
      grid.base);
  result.contours = contour_lines(result.ground, look.contour_interval);
  if (!look.water) return result;
  const CellWindow depth = window("water_depth", cells);
  if (depth.empty()) return result;
  result.water = build_block(layout, block, level, grid.cell_size, water_surface(elevation, depth, level),
                             [&](int x, int y, float nx, float ny, float nz) {
                               const float d = depth.at(x, y);
                               const Colour light = mix({1, 1, 1}, light_at(x, y, nx, ny, nz), 0.25f);
                               return pack(lit(water_colour(d), light), water_opacity(d));
                             });
  return result;
}

}  // namespace desert_sim::render

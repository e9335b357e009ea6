#include "src/render/terrain_block.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "src/render/contour_lines.hpp"
#include "src/render/ground_painter.hpp"
#include "src/render/sunlight.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim::render {

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

TerrainBlock build_terrain_block(const TerrainGrid& grid, int block, int level, const LayerWindow& window,
                                 const TerrainLook& look) {
  TerrainBlock result;
  const BlockLayout& layout = grid.layout;
  const CellRectangle whole{0, 0, layout.width(), layout.height()}, vertices = layout.vertices(block);
  const CellRectangle cells = layout.needed_cells(block, level);
  CellRectangle seen = cells_that_shade(vertices, grid.shadow_reach).clipped(whole);
  seen.include(cells);
  const CellWindow elevation = window("elevation", seen);
  const GroundPainter painter(grid, vertices, elevation, window, look);
  result.ground = build_block(
      layout, block, level, grid.cell_size, elevation,
      [&](int x, int y, float nx, float ny, float nz) {
        const float sand = painter.sand_cover(x, y), sun = painter.sun(x, y);
        const float alpha = look.ripples ? ripples_on(sand, nz, sun) : 1.0f;
        return pack(lit(painter.colour(x, y, nz, sand), painter.light(nx, ny, nz, sun, painter.day(x, y))),
                    alpha);
      },
      grid.base, grid.hole);
  result.contours = contour_lines(result.ground, look.contour_interval);
  if (!look.water) return result;
  const CellWindow depth = window("water_depth", cells);
  if (depth.empty()) return result;
  result.water =
      build_block(layout, block, level, grid.cell_size, water_surface(elevation, depth, level),
                  [&](int x, int y, float nx, float ny, float nz) {
                    const float d = depth.at(x, y);
                    const Colour glow = mix(
                        {1, 1, 1}, painter.light(nx, ny, nz, painter.sun(x, y), painter.day(x, y)), 0.25f);
                    return pack(lit(water_colour(d, look.palette), glow), water_opacity(d));
                  });
  return result;
}

}  // namespace desert_sim::render

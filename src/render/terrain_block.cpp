#include "src/render/terrain_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/render/contour_lines.hpp"
#include "src/render/terrain_colours.hpp"

namespace desert_sim::render {

namespace {

/// The layers that make the colour of the ground. A terrain of which only the elevation is known is drawn as
/// sand.
struct MaterialWindows {
  CellWindow sand, soil, moisture, vegetation, obstacle, resistance;

  MaterialWindows(const LayerWindow& window, const CellRectangle& cells)
      : sand(window("sand_depth", cells)),
        soil(window("soil_depth", cells)),
        moisture(window("moisture", cells)),
        vegetation(window("vegetation", cells)),
        obstacle(window("obstacle", cells)),
        resistance(window("erosion_resistance", cells)) {}
  MaterialWindows() = default;

  Colour at(int x, int y) const {
    SurfaceMaterials m;
    m.sand = sand.empty() ? 1.0f : sand.at(x, y);
    const auto set = [&](const CellWindow& layer, float& value) {
      if (!layer.empty()) value = layer.at(x, y);
    };
    set(soil, m.soil);
    set(moisture, m.moisture);
    set(vegetation, m.vegetation);
    set(obstacle, m.obstacle);
    set(resistance, m.resistance);
    if (!(m.resistance > 0))
      m.resistance = SurfaceMaterials().resistance;  // the terrain does not have the layer
    return ground_colour(m);
  }
};

/// The light on a surface of true heights that is seen with exaggerated ones.
float light_on(float normal_x, float normal_y, float normal_z, float exaggeration) {
  const float x = normal_x * exaggeration, y = normal_y * exaggeration,
              length = std::sqrt(x * x + y * y + normal_z * normal_z);
  return sun_light(x / length, y / length, normal_z / length);
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

TerrainBlock build_terrain_block(const BlockLayout& layout, int block, int level, double cell_size,
                                 const LayerWindow& window, const TerrainLook& look, float base) {
  TerrainBlock result;
  const CellRectangle cells = layout.needed_cells(block, level), vertices = layout.vertices(block);
  const CellWindow elevation = window("elevation", cells);
  const MaterialWindows materials = look.materials ? MaterialWindows(window, vertices) : MaterialWindows();
  const bool slope = look.overlay.layer == slope_layer;
  const CellWindow overlay =
      look.overlay.active() && !slope ? window(look.overlay.layer, vertices) : CellWindow();
  const auto exaggeration = static_cast<float>(look.vertical_exaggeration);
  result.ground = build_block(
      layout, block, level, cell_size, elevation,
      [&](int x, int y, float nx, float ny, float nz) {
        Colour colour = materials.at(x, y);
        if (slope) colour = look.overlay.on(colour, std::acos(std::min(1.0f, nz)));
        if (!overlay.empty()) colour = look.overlay.on(colour, overlay.at(x, y));
        return pack(lit(colour, light_on(nx, ny, nz, exaggeration)));
      },
      base);
  result.contours = contour_lines(result.ground, look.contour_interval);
  if (!look.water) return result;
  const CellWindow depth = window("water_depth", cells);
  if (depth.empty()) return result;
  result.water = build_block(layout, block, level, cell_size, water_surface(elevation, depth, level),
                             [&](int x, int y, float nx, float ny, float nz) {
                               const float d = depth.at(x, y), light = light_on(nx, ny, nz, exaggeration);
                               return pack(lit(water_colour(d), 0.75f + 0.25f * light), water_opacity(d));
                             });
  return result;
}

}  // namespace desert_sim::render

#include "src/render/ground_painter.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

#include "src/render/sunlight.hpp"

namespace desert_sim::render {

namespace {

constexpr float degrees = 180 / 3.14159265f;

CellWindow cover_of(const CellWindow& depth) {
  std::vector<float> values = depth.values();
  std::transform(values.begin(), values.end(), values.begin(), cover_of_depth);
  return {depth.cells(), std::move(values)};
}

/// The cover around a cell, by binomial weights. The edge of sand is sharper than a cell; drawn as it is, it
/// follows the grid in teeth.
float smoothed(const CellWindow& cover, int x, int y) {
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

CellRectangle clipped(const CellRectangle& cells, const BlockLayout& layout) {
  return cells.clipped({0, 0, layout.width(), layout.height()});
}

}  // namespace

std::vector<std::string> layers_for(const TerrainLook& look) {
  std::vector<std::string> layers{"elevation"};
  if (look.materials)
    layers.insert(layers.end(),
                  {"sand_depth", "soil_depth", "moisture", "vegetation", "obstacle", "erosion_resistance"});
  if (look.water) layers.emplace_back("water_depth");
  if (look.shading != Shading::sun) layers.emplace_back(illumination_layer);
  for (const Overlay* overlay : {&look.overlay, &look.second}) {
    const std::string& shown = overlay->layer;
    const bool computed = shown == slope_layer || shown == change_layer;
    if (overlay->active() && !computed && std::find(layers.begin(), layers.end(), shown) == layers.end())
      layers.push_back(shown);
  }
  return layers;
}

float ripples_on(float sand_cover, float normal_z, float sun) {
  constexpr float gentle = 0.94f, steep = 0.88f;  // 20 and 28 degrees
  return sand_cover * smooth_step(steep, gentle, normal_z) * sun;
}

// ---- Materials ----

MaterialWindows::MaterialWindows(const LayerWindow& window, const CellRectangle& cells)
    : sand_(cover_of(window("sand_depth", cells))),
      soil_(cover_of(window("soil_depth", cells))),
      moisture_(window("moisture", cells)),
      vegetation_(window("vegetation", cells)),
      obstacle_(window("obstacle", cells)),
      resistance_(window("erosion_resistance", cells)) {}

float MaterialWindows::sand_cover(int x, int y) const { return sand_.empty() ? 1.0f : smoothed(sand_, x, y); }

Colour MaterialWindows::at(int x, int y, float cover, const Palette& palette) const {
  SurfaceMaterials m;
  m.sand = cover;
  if (!soil_.empty()) m.soil = smoothed(soil_, x, y);
  const auto set = [&](const CellWindow& layer, float& value) {
    if (!layer.empty()) value = layer.at(x, y);
  };
  set(moisture_, m.moisture);
  set(vegetation_, m.vegetation);
  set(obstacle_, m.obstacle);
  set(resistance_, m.resistance);
  if (!(m.resistance > 0))
    m.resistance = SurfaceMaterials().resistance;  // the terrain does not have the layer
  return ground_colour(m, palette);
}

// ---- Overlays ----

OverlayOnCells::OverlayOnCells(const Overlay& overlay, const LayerWindow& window, const CellRectangle& cells)
    : overlay_(overlay), slope_(overlay.layer == slope_layer) {
  if (overlay.active() && !slope_) values_ = window(overlay.layer, cells);
}

Colour OverlayOnCells::on(const Colour& ground, int x, int y, float normal_z) const {
  if (slope_) return overlay_.on(ground, degrees * std::acos(std::min(1.0f, normal_z)));
  return values_.empty() ? ground : overlay_.on(ground, values_.at(x, y));
}

// ---- Both, and light ----

GroundPainter::GroundPainter(const TerrainGrid& grid, const CellRectangle& vertices,
                             const CellWindow& elevation, const LayerWindow& window, const TerrainLook& look)
    : look_(look),
      materials_(look.materials ? MaterialWindows(window, clipped(vertices.grown(1), grid.layout))
                                : MaterialWindows()),
      first_(look.overlay, window, vertices),
      second_(look.second, window, vertices),
      divide_(look.divide ? static_cast<float>(*look.divide) * static_cast<float>(grid.layout.width())
                          : std::numeric_limits<float>::quiet_NaN()) {
  if (grid.shadow_reach > 0)
    sun_ =
        sun_visibility(vertices, elevation, grid.cell_size, static_cast<float>(look.vertical_exaggeration));
  if (look.shading != Shading::sun) day_ = window(illumination_layer, vertices);
}

Colour GroundPainter::colour(int x, int y, float normal_z, float cover) const {
  const Colour ground = materials_.at(x, y, cover, look_.palette);
  const float middle = static_cast<float>(x) + 0.5f;
  const Colour below = middle >= divide_ ? ground : first_.on(ground, x, y, normal_z);
  return middle < divide_ ? below : second_.on(below, x, y, normal_z);
}

Colour GroundPainter::light(float normal_x, float normal_y, float normal_z, float sun, float day) const {
  Colour light{1, 1, 1};
  if (!look_.light) return light;
  if (look_.shading != Shading::illumination || day_.empty()) {
    const auto exaggeration = static_cast<float>(look_.vertical_exaggeration);
    const float x = normal_x * exaggeration, y = normal_y * exaggeration,
                length = std::sqrt(x * x + y * y + normal_z * normal_z);
    light = illumination(x / length, y / length, normal_z / length, sun);
  }
  return std::isnan(day) ? light : Colour{day * light.r, day * light.g, day * light.b};
}

}  // namespace desert_sim::render

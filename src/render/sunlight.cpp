#include "src/render/sunlight.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace desert_sim::render {

namespace {

constexpr float sun_x = -0.760f, sun_y = 0.276f, sun_z = 0.588f;  // a unit vector
constexpr Colour sky_light{0.30f, 0.31f, 0.35f};                  // on level ground; the rest is of the sun
constexpr float brightest = 1.30f;

// Shadows run along columns, from the west, each cell's from two of the column before: `aside` rows further
// north.
constexpr float aside = sun_y / -sun_x;
static_assert(sun_x < 0 && aside >= 0 && aside <= 1);
/// How much lower the sun's rays are a column further east, over the cell's size.
const float fall = sun_z / -sun_x;
constexpr float no_shadow = -1e30f;  // below everything; interpolating it stays finite

/// Rows by which a shadow that is `reach` columns long is shifted.
int shift(int reach) { return static_cast<int>(std::ceil(static_cast<float>(reach) * aside)); }

}  // namespace

const Point& towards_sun() {
  static const Point direction(static_cast<double>(sun_x), static_cast<double>(sun_y),
                               static_cast<double>(sun_z));
  return direction;
}

Colour illumination(float normal_x, float normal_y, float normal_z, float sun) {
  const float facing = std::max(0.0f, normal_x * sun_x + normal_y * sun_y + normal_z * sun_z) / sun_z;
  const auto channel = [&](float sky) { return std::min(brightest, sky + (1 - sky) * sun * facing); };
  return {channel(sky_light.r), channel(sky_light.g), channel(sky_light.b)};
}

Colour lit(const Colour& c, const Colour& light) {
  return {std::min(1.0f, c.r * light.r), std::min(1.0f, c.g * light.g), std::min(1.0f, c.b * light.b)};
}

int shadow_reach(double relief, double cell_size) {
  const double columns = std::ceil(relief / (static_cast<double>(fall) * cell_size)) + 1;
  return columns > 0 ? static_cast<int>(std::min(columns, static_cast<double>(longest_shadow))) : 0;
}

CellRectangle cells_that_shade(const CellRectangle& cells, int reach) {
  if (cells.empty()) return cells;
  return {cells.x - reach, cells.y, cells.width + reach, cells.height + shift(reach)};
}

CellRectangle cells_in_shade_of(const CellRectangle& cells, int reach) {
  if (cells.empty()) return cells;
  return {cells.x, cells.y - shift(reach), cells.width + reach, cells.height + shift(reach)};
}

CellWindow sun_visibility(const CellRectangle& cells, const CellWindow& surface, double cell_size,
                          float exaggeration) {
  const CellRectangle& all = surface.cells();
  const auto rows = static_cast<std::size_t>(std::max(0, all.height));
  const float drop = fall * static_cast<float>(cell_size) / exaggeration;
  std::vector<float> shares(static_cast<std::size_t>(cells.width) * static_cast<std::size_t>(cells.height),
                            1.0f);
  // The upper end of the shadow above each cell of a column, and what casts shadows there: shadow or ground.
  std::vector<float> shadow(rows, no_shadow), caster(rows + 1, no_shadow);
  for (int x = all.x; x < cells.right(); ++x) {
    for (std::size_t row = 0; row < rows; ++row)
      shadow[row] = caster[row] + aside * (caster[row + 1] - caster[row]) - drop;
    for (std::size_t row = 0; row < rows; ++row) {
      const float z = surface.at(x, all.y + static_cast<int>(row));
      caster[row] = std::isnan(z) ? shadow[row] : std::max(z, shadow[row]);
    }
    if (x < cells.x) continue;
    for (int y = cells.y; y < cells.top(); ++y) {
      // Above the shadow by `drop` in the sun, below it by as much a cell further into the shade.
      const float above = (surface.at(x, y) - shadow[static_cast<std::size_t>(y - all.y)]) / drop;
      const std::size_t n = static_cast<std::size_t>(y - cells.y) * static_cast<std::size_t>(cells.width) +
                            static_cast<std::size_t>(x - cells.x);
      if (above < 0.5f) shares[n] = std::max(0.0f, 0.5f + above);  // NaN: unknown ground, in the sun
    }
  }
  return {cells, std::move(shares)};
}

}  // namespace desert_sim::render

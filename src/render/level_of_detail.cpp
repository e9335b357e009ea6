#include "src/render/level_of_detail.hpp"

#include <cmath>
#include <cstdint>

namespace desert_sim::render {

namespace {

constexpr double reluctance = 0.25;  // a level is kept until another one is better by so much of a level

int level_for(double stride, int present) {
  if (!(stride > 1)) return 0;  // also NaN
  const double exact = std::log2(stride);
  if (present >= 0 && exact > present - reluctance && exact < present + 1 + reluctance) return present;
  return static_cast<int>(std::min(exact, static_cast<double>(BlockLayout::max_level)));
}

}  // namespace

int surface_triangles(const BlockLayout& layout, int block, int level) {
  const CellRectangle vertices = layout.vertices(block);
  const auto quads = [level](int cells) { return (cells - 2) / (1 << level) + 1; };
  return 2 * quads(vertices.width) * quads(vertices.height);
}

std::vector<int> choose_levels(const BlockLayout& layout, double cell_size, const View& view,
                               const std::vector<Box>& boxes, const std::vector<int>& present,
                               const DetailLimits& limits) {
  const std::size_t count = boxes.size();
  std::vector<int> levels(count);
  std::vector<double> cell_pixels(count);
  std::vector<char> seen(count);
  for (std::size_t n = 0; n < count; ++n) {
    cell_pixels[n] = cell_size * view.pixels_per_metre(boxes[n]);
    seen[n] = view.sees(boxes[n]) ? 1 : 0;
  }
  // Each round allows quads that are larger by a fifth, up to the coarsest level everywhere.
  for (double pixels = limits.pixels;; pixels *= 1.2) {
    std::int64_t triangles = 0;
    bool coarsest = true;
    for (std::size_t n = 0; n < count; ++n) {
      levels[n] = level_for(pixels / cell_pixels[n], present[n]);
      if (!seen[n]) continue;
      triangles += surface_triangles(layout, static_cast<int>(n), levels[n]);
      coarsest = coarsest && levels[n] == BlockLayout::max_level;
    }
    if (triangles <= limits.triangles || coarsest || pixels > 1e6) return levels;
  }
}

}  // namespace desert_sim::render

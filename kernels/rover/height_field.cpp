/// The laws of height_field.hpp; compiled once for each backend.
#include "kernels/rover/height_field.hpp"

#include <cmath>

#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"

namespace desert_sim::height_field {

namespace {

constexpr float nothing = -INFINITY;

struct WriteRectangle {
  const float* values;
  Rectangle cells;
  Sane sane;
  int width;
  float* layer;

  DESERT_HD float usable(float v) const {
    if (sane == Sane::as_they_are) return v;
    return sane == Sane::heights ? (fabsf(v) < 1e9f ? v : NAN) : (v > 0.0f ? v : 0.0f);
  }
  DESERT_HD void operator()(int x, int y) const {
    const float v = values[y * cells.width + x];
    layer[(cells.y + y) * width + cells.x + x] = usable(v);
  }
};

/// Blocks of 4 × 4 patches from their corners.
struct FirstTops {
  View view;
  int first_column, first_row;
  float* tops;

  DESERT_HD float top(int x, int y) const {
    const int i = clamp_index(y, view.height) * view.width + clamp_index(x, view.width);
    const float plants = view.canopy && view.density[i] > 0.0f ? view.canopy[i] : 0.0f;
    return view.elevation[i] + plants;
  }
  DESERT_HD void operator()(int x, int y) const {
    const int column = first_column + x, row = first_row + y;
    float highest = nothing;
    for (int dy = -1; dy < 4; ++dy)
      for (int dx = -1; dx < 4; ++dx) {
        const float here = top(4 * column + dx, 4 * row + dy);
        highest = here > highest ? here : highest;  // NaN is never greater
      }
    tops[view.levels[0].offset + row * view.levels[0].columns + column] = highest;
  }
};

/// Blocks of 4 × 4 blocks of the level below.
struct NextTops {
  Level below, level;
  int first_column, first_row;
  float* tops;

  DESERT_HD void operator()(int x, int y) const {
    const int column = first_column + x, row = first_row + y;
    float highest = nothing;
    for (int j = 4 * row; j < 4 * row + 4 && j < below.rows; ++j)
      for (int i = 4 * column; i < 4 * column + 4 && i < below.columns; ++i)
        highest = maximum(highest, tops[below.offset + j * below.columns + i]);
    tops[level.offset + row * level.columns + column] = highest;
  }
};

struct DustBlocks {
  View view;
  const float* airborne_sand;
  int first_column, first_row;
  float *dust, *ground;

  DESERT_HD void operator()(int x, int y) const {
    const int column = first_column + x, row = first_row + y;
    float amount = 0.0f, heights = 0.0f;
    int cells = 0, known = 0;
    for (int j = dust_side * row; j < dust_side * (row + 1) && j < view.height; ++j)
      for (int i = dust_side * column; i < dust_side * (column + 1) && i < view.width; ++i) {
        const float height = view.elevation[j * view.width + i];
        const bool is_known = height == height;
        amount += airborne_sand[j * view.width + i];
        heights += is_known ? height : 0.0f;
        known += is_known;
        ++cells;
      }
    const int block = row * blocks_along(view.width, dust_side) + column;
    dust[block] = amount / static_cast<float>(cells);
    ground[block] = known > 0 ? heights / static_cast<float>(known) : NAN;
  }
};

Grid grid_of(int width, int height) { return {width, height, 1.0f, false, false}; }

}  // namespace

template <class E>
void write_rectangle(E& exec, const float* values, const Rectangle& cells, Sane sane, int width,
                     float* layer) {
  for_each_cell(exec, grid_of(cells.width, cells.height), WriteRectangle{values, cells, sane, width, layer});
}

template <class E>
void refresh_tops(E& exec, const View& view, const Rectangle& cells, float* tops) {
  // Cell x is a corner of the patches x and x + 1; the blocks at the edge also have clamped corners.
  int west = cells.x, east = cells.x + cells.width, south = cells.y, north = cells.y + cells.height;
  for (int k = 0; k < view.level_count; ++k) {
    const Level& level = view.levels[k];
    west /= 4, east /= 4, south /= 4, north /= 4;
    const Grid blocks = grid_of(east - west + 1, north - south + 1);
    if (k == 0)
      for_each_cell(exec, blocks, FirstTops{view, west, south, tops});
    else
      for_each_cell(exec, blocks, NextTops{view.levels[k - 1], level, west, south, tops});
  }
}

template <class E>
void refresh_dust(E& exec, const View& view, const float* airborne_sand, const Rectangle& cells, float* dust,
                  float* ground) {
  const int west = cells.x / dust_side, south = cells.y / dust_side;
  const int east = (cells.x + cells.width - 1) / dust_side, north = (cells.y + cells.height - 1) / dust_side;
  for_each_cell(exec, grid_of(east - west + 1, north - south + 1),
                DustBlocks{view, airborne_sand, west, south, dust, ground});
}

template void write_rectangle(Backend&, const float*, const Rectangle&, Sane, int, float*);
template void refresh_tops(Backend&, const View&, const Rectangle&, float*);
template void refresh_dust(Backend&, const View&, const float*, const Rectangle&, float*, float*);

}  // namespace desert_sim::height_field

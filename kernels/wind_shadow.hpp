#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind one cell a step up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// Heights are sampled bilinearly, through periodic borders; beyond an open edge the edge goes on. `curved`
/// re-reads the wind at every step. Reads the heights, wind_x, wind_y; writes wind_shadow.
///
/// A long straight march is cut into pieces. A piece is left out if the highest ground around it is too low
/// to matter: neither steeper to look up to than what was found nearer, nor than where shadow begins. That
/// changes no bit of the result.

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/buffer.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/math.hpp"
#include "desert_sim/kernels/surface.hpp"

namespace desert_sim {

struct WindShadowParameters {
  bool enabled = true;
  float distance = 10.0f;
  float start_deg = 10.0f;
  float full_deg = 15.0f;
  bool curved = false;
};

constexpr auto parameter_table(const WindShadowParameters*) {
  using P = WindShadowParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether terrain shelters the ground behind it."),
      parameter("distance", &P::distance, 0, 1000, "m",
                "How far upwind shelter is looked for; at least one cell."),
      parameter("start_deg", &P::start_deg, 0, 89, "deg", "Angle to the shelter at which shadow begins."),
      parameter("full_deg", &P::full_deg, 0, 89, "deg", "Angle to the shelter from which shadow is full."),
      parameter("curved", &P::curved, "Whether the march follows the wind as it turns."));
}
static_assert(table_is_complete<WindShadowParameters>());

namespace wind_shadow {

/// `around` holds, for each block of the surface, the highest of it and of the eight next to it: all ground within
/// `side` cells of any cell of the block.
struct Blocks {
  static constexpr int side = surface::block_side;
  /// Steps of a march that stay within `side` cells of the cell under its middle, bilinear neighbours
  /// included.
  static constexpr int piece = 2 * (side - 1) + 1;
};

struct HighestAround {
  Grid blocks;
  const float* highest;
  float* around;

  DESERT_HD void operator()(int column, int row) const {
    float top = -static_cast<float>(wall_height);
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x)
        top = maximum(top, highest[sample_index(blocks, x, y)]);
    around[blocks.index(column, row)] = top;
  }
};

/// Cells around a sample and its place between them, 16.16 fixed point: (x, y) + (dx, dy)/65536 cells.
struct Place {
  int x, y;
  float fx, fy;
  DESERT_HD Place(int cell_x, int cell_y, int dx, int dy)
      : x(cell_x + (dx >> 16)), y(cell_y + (dy >> 16)), fx(fraction(dx)), fy(fraction(dy)) {}
};

/// Bilinear height between four cells. The four terms are formed so that mirrored or turned terrain gives the same bits.
DESERT_HD float height_between(float h00, float h10, float h01, float h11, float fx, float fy) {
  const float a = h00 * ((1.0f - fx) * (1.0f - fy)), b = h10 * (fx * (1.0f - fy));
  const float c = h01 * ((1.0f - fx) * fy), d = h11 * (fx * fy);
  return (a + d) + (b + c);
}
/// Where all four cells are on the grid.
DESERT_HD float height_inside(const Grid& g, const float* h, const Place& p) {
  const float *q = h + g.index(p.x, p.y), *north = q + g.width;
  return height_between(q[0], q[1], north[0], north[1], p.fx, p.fy);
}
DESERT_HD float height_anywhere(const Grid& g, const float* h, const Place& p) {
  return height_between(h[sample_index(g, p.x, p.y)], h[sample_index(g, p.x + 1, p.y)],
                        h[sample_index(g, p.x, p.y + 1)], h[sample_index(g, p.x + 1, p.y + 1)], p.fx, p.fy);
}

/// What both marches look at, and what they make of the steepest rise that they find.
struct March {
  Grid grid;
  float quantum;
  const float *heights, *wind_x, *wind_y;
  const float* reciprocals;  ///< 1/j for j = 0 … steps (but for 0)
  int steps;
  float start, full;  ///< tangents
  float* wind_shadow;

  /// `steepest` [quanta a step].
  DESERT_HD void shade(int i, float steepest) const {
    wind_shadow[i] = clamp((steepest * quantum / grid.cell_size - start) / (full - start), 0.0f, 1.0f);
  }
};

struct Shadow : March {
  Grid blocks;
  const float* around;  ///< null: no piece is left out

  DESERT_HD float quanta_a_step() const { return grid.cell_size / quantum; }  ///< of a slope of 1

  /// Whether steps first … first + piece − 1 may matter beside `steepest`. The slack is for rounding, in units of the
  /// heights' own too.
  DESERT_HD bool matters(int x, int y, int step_x, int step_y, int first, float base, float steepest) const {
    const int middle = first + Blocks::side - 1;
    const int mx = x + ((middle * step_x) >> 16), my = y + ((middle * step_y) >> 16);
    const int cx = grid.periodic_x ? wrap(mx, grid.width) : clamp_index(mx, grid.width);
    const int cy = grid.periodic_y ? wrap(my, grid.height) : clamp_index(my, grid.height);
    const float highest = around[blocks.index(cx / Blocks::side, cy / Blocks::side)];
    const float slack = 1.0f + 1e-6f * (fabsf(highest) + fabsf(base));
    const float needed = maximum(steepest, start * quanta_a_step() * 0.99999f) * static_cast<float>(first);
    return (highest - base) * 1.000001f + slack > needed;
  }

  template <class HeightAt>
  DESERT_HD float march(int x, int y, int step_x, int step_y, float base, const HeightAt& height) const {
    const float enough = full * quanta_a_step() * 1.00001f;
    float steepest = 0.0f;
    for (int first = 1; first <= steps && steepest < enough; first += Blocks::piece) {
      if (around && !matters(x, y, step_x, step_y, first, base, steepest)) continue;
      const int end = first + Blocks::piece <= steps ? first + Blocks::piece : steps + 1;
      for (int j = first; j < end; ++j)
        steepest = maximum(steepest, (height(Place(x, y, j * step_x, j * step_y)) - base) * reciprocals[j]);
    }
    return steepest;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float base = heights[i], *h = heights;
    const Grid g = grid;
    const float u = wind_x[i], v = wind_y[i], speed = hypotenuse(u, v);
    float steepest = 0.0f;
    if (speed > 1e-6f) {
      const int step_x = -subcells(u / speed), step_y = -subcells(v / speed);
      const Place last(x, y, steps * step_x, steps * step_y);
      if (x + 1 < g.width && y + 1 < g.height && g.inside(last.x, last.y) && g.inside(last.x + 1, last.y + 1))
        steepest = march(x, y, step_x, step_y, base,
                         [g, h](const Place& p) DESERT_INLINE { return height_inside(g, h, p); });
      else
        steepest = march(x, y, step_x, step_y, base,
                         [g, h](const Place& p) DESERT_INLINE { return height_anywhere(g, h, p); });
    }
    shade(i, steepest);
  }
};

/// The march that follows the wind as it turns.
struct CurvedShadow : March {
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    float u = wind_x[i], v = wind_y[i];
    float steepest = 0.0f;  // quanta a step
    int dx = 0, dy = 0;
    for (int j = 1; j <= steps; ++j) {
      const float speed = hypotenuse(u, v);
      if (!(speed > 1e-6f)) break;
      dx -= subcells(u / speed);
      dy -= subcells(v / speed);
      const float rise = height_anywhere(grid, heights, Place(x, y, dx, dy)) - heights[i];
      steepest = maximum(steepest, rise * reciprocals[j]);
      const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
      u = wind_x[there];
      v = wind_y[there];
    }
    shade(i, steepest);
  }
};

/// `around` is empty where marches are too short to be cut, follow the wind, or blocks do not fit a periodic axis.
struct Workspace {
  Buffer<float> reciprocals, around;
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}
Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work) {
  const float degree = 3.14159265358979f / 180.0f;
  const float start = tanf(p.start_deg * degree);
  const float full = maximum(tanf(p.full_deg * degree), start + 1e-6f);
  const March march{t.grid,
                    t.quantum,
                    heights.of_cells.data(),
                    t.real(Layer::wind_x),
                    t.real(Layer::wind_y),
                    work.reciprocals.data(),
                    march_steps(t.grid, p),
                    start,
                    full,
                    t.real(Layer::wind_shadow)};
  if (p.curved) {
    for_each_cell(exec, t.grid, CurvedShadow{march});
    return;
  }
  if (work.around)
    for_each_cell(exec, heights.blocks,
                  HighestAround{heights.blocks, heights.highest.data(), work.around.data()});
  for_each_cell(exec, t.grid, Shadow{march, heights.blocks, work.around.data()});
}

}  // namespace wind_shadow
}  // namespace desert_sim

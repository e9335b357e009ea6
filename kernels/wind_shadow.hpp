#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind one cell a step up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// Heights are sampled bilinearly, through periodic borders; beyond an open edge the edge goes on. `curved`
/// re-reads the wind at every step. Reads elevation, wind_x, wind_y; writes wind_shadow.
///
/// A long straight march is cut into pieces. A piece is left out if the highest ground around it is too low
/// to matter: neither steeper to look up to than what was found nearer, nor than where shadow begins. That
/// changes no bit of the result.

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/buffer.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/math.hpp"

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

/// Blocks of cells whose highest ground is known. `around` holds, for each block, the highest of it and of
/// the eight next to it: all ground within `side` cells of any cell of the block.
struct Blocks {
  static constexpr int side = 4;
  /// Steps of a march that stay within `side` cells of the cell under its middle, bilinear neighbours
  /// included.
  static constexpr int piece = 2 * (side - 1) + 1;
};

/// Highest ground of the 4 × 4 cells of a block (fewer at the far edges of an open grid).
struct HighestOfBlock {
  Grid grid;
  const Quanta* elevation;
  Grid blocks;
  Quanta* highest;

  DESERT_HD void operator()(int column, int row) const {
    const int x0 = Blocks::side * column, y0 = Blocks::side * row;
    Quanta top = elevation[grid.index(x0, y0)];
    for (int y = y0; y < y0 + Blocks::side && y < grid.height; ++y)
      for (int x = x0; x < x0 + Blocks::side && x < grid.width; ++x) {
        const Quanta h = elevation[grid.index(x, y)];
        top = h > top ? h : top;
      }
    highest[blocks.index(column, row)] = top;
  }
};

struct HighestAround {
  Grid blocks;
  const Quanta* highest;
  Quanta* around;

  DESERT_HD void operator()(int column, int row) const {
    Quanta top = -wall_height;
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x) {
        const Quanta h = highest[sample_index(blocks, x, y)];
        top = h > top ? h : top;
      }
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

/// Bilinear height above `base` [quanta] between four cells. The four terms are formed so that mirrored or
/// turned terrain gives the same bits.
DESERT_HD float height_above(Quanta base, Quanta h00, Quanta h10, Quanta h01, Quanta h11, float fx,
                             float fy) {
  const float a = static_cast<float>(h00 - base) * ((1.0f - fx) * (1.0f - fy));
  const float b = static_cast<float>(h10 - base) * (fx * (1.0f - fy));
  const float c = static_cast<float>(h01 - base) * ((1.0f - fx) * fy);
  const float d = static_cast<float>(h11 - base) * (fx * fy);
  return (a + d) + (b + c);
}
/// Where all four cells are on the grid.
DESERT_HD float height_inside(const Grid& g, const Quanta* h, Quanta base, const Place& p) {
  const Quanta* q = h + g.index(p.x, p.y);
  return height_above(base, q[0], q[1], q[g.width], q[g.width + 1], p.fx, p.fy);
}
DESERT_HD float height_anywhere(const Grid& g, const Quanta* h, Quanta base, const Place& p) {
  return height_above(base, h[sample_index(g, p.x, p.y)], h[sample_index(g, p.x + 1, p.y)],
                      h[sample_index(g, p.x, p.y + 1)], h[sample_index(g, p.x + 1, p.y + 1)], p.fx, p.fy);
}

/// What both marches look at, and what they make of the steepest rise that they find.
struct March {
  Grid grid;
  float quantum;
  const Quanta* elevation;
  const float *wind_x, *wind_y;
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
  const Quanta* around;  ///< null: no piece is left out

  DESERT_HD float quanta_a_step() const { return grid.cell_size / quantum; }  ///< of a slope of 1

  /// Whether steps first … first + piece − 1 may matter beside `steepest`. The slack is for rounding.
  DESERT_HD bool matters(int x, int y, int step_x, int step_y, int first, Quanta base, float steepest) const {
    const int middle = first + Blocks::side - 1;
    const int mx = x + ((middle * step_x) >> 16), my = y + ((middle * step_y) >> 16);
    const int cx = grid.periodic_x ? wrap(mx, grid.width) : clamp_index(mx, grid.width);
    const int cy = grid.periodic_y ? wrap(my, grid.height) : clamp_index(my, grid.height);
    const float rise = static_cast<float>(around[blocks.index(cx / Blocks::side, cy / Blocks::side)] - base);
    const float needed = maximum(steepest, start * quanta_a_step() * 0.99999f) * static_cast<float>(first);
    return rise * 1.000001f + 1.0f > needed;
  }

  template <class Height>
  DESERT_HD float march(int x, int y, int step_x, int step_y, Quanta base, const Height& height) const {
    const float enough = full * quanta_a_step() * 1.00001f;
    float steepest = 0.0f;
    for (int first = 1; first <= steps && steepest < enough; first += Blocks::piece) {
      if (around && !matters(x, y, step_x, step_y, first, base, steepest)) continue;
      const int end = first + Blocks::piece <= steps ? first + Blocks::piece : steps + 1;
      for (int j = first; j < end; ++j)
        steepest = maximum(steepest, height(Place(x, y, j * step_x, j * step_y)) / static_cast<float>(j));
    }
    return steepest;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta base = elevation[i], *h = elevation;
    const Grid g = grid;
    const float u = wind_x[i], v = wind_y[i], speed = hypotenuse(u, v);
    float steepest = 0.0f;
    if (speed > 1e-6f) {
      const int step_x = -subcells(u / speed), step_y = -subcells(v / speed);
      const Place last(x, y, steps * step_x, steps * step_y);
      if (x + 1 < g.width && y + 1 < g.height && g.inside(last.x, last.y) && g.inside(last.x + 1, last.y + 1))
        steepest = march(x, y, step_x, step_y, base,
                         [g, h, base](const Place& p) DESERT_INLINE { return height_inside(g, h, base, p); });
      else
        steepest = march(x, y, step_x, step_y, base, [g, h, base](const Place& p) DESERT_INLINE {
          return height_anywhere(g, h, base, p);
        });
    }
    shade(i, steepest);
  }
};

/// The march that follows the wind as it turns.
struct CurvedShadow : March {
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const Quanta base = elevation[i];
    float u = wind_x[i], v = wind_y[i];
    float steepest = 0.0f;  // quanta per step
    int dx = 0, dy = 0;
    for (int j = 1; j <= steps; ++j) {
      const float speed = hypotenuse(u, v);
      if (!(speed > 1e-6f)) break;
      dx -= subcells(u / speed);
      dy -= subcells(v / speed);
      const float height = height_anywhere(grid, elevation, base, Place(x, y, dx, dy));
      steepest = maximum(steepest, height / static_cast<float>(j));
      const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
      u = wind_x[there];
      v = wind_y[there];
    }
    shade(i, steepest);
  }
};

/// Memory for the blocks; none where marches are too short to be cut, or blocks do not fit a periodic axis.
struct Workspace {
  Grid blocks;
  Buffer<Quanta> highest, around;
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}
Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const Workspace& work) {
  const float degree = 3.14159265358979f / 180.0f;
  const float start = tanf(p.start_deg * degree);
  const float full = maximum(tanf(p.full_deg * degree), start + 1e-6f);
  const Quanta* elevation = t.quanta(Layer::elevation);
  const March march{t.grid,
                    t.quantum,
                    elevation,
                    t.real(Layer::wind_x),
                    t.real(Layer::wind_y),
                    march_steps(t.grid, p),
                    start,
                    full,
                    t.real(Layer::wind_shadow)};
  if (p.curved) {
    for_each_cell(exec, t.grid, CurvedShadow{march});
    return;
  }
  if (work.around) {
    for_each_cell(exec, work.blocks, HighestOfBlock{t.grid, elevation, work.blocks, work.highest.data()});
    for_each_cell(exec, work.blocks, HighestAround{work.blocks, work.highest.data(), work.around.data()});
  }
  for_each_cell(exec, t.grid, Shadow{march, work.blocks, work.around.data()});
}

}  // namespace wind_shadow
}  // namespace desert_sim

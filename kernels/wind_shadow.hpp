#pragma once
/// Wind shadow: how far a cell lies in the lee. Nilles 2024 eq. 4; physics.md A6.
///
///   t = max over steps of Δh / distance, marching upwind up to `distance`
///   r_s = clamp((t − tan start) / (tan full − tan start), 0, 1)
///
/// A step goes to the next column of cells, or the next row if the wind crosses rows faster, and looks
/// between two cells there. `curved` goes one cell width a step, between four cells, and re-reads the wind at
/// every step. Marches go through periodic borders; beyond an open edge the edge goes on. Reads the heights,
/// wind_x, wind_y; writes wind_shadow.
///
/// A long straight march is cut into pieces. A piece is left out if the highest ground around it is too low
/// to matter: neither steeper to look up to than what was found nearer, nor than where shadow begins. That
/// changes no bit of the result.

#include "desert_sim/core/parameters.hpp"
#include "desert_sim/kernels/buffer.hpp"
#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/layers.hpp"
#include "desert_sim/kernels/marching.hpp"
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

/// `around` holds, for each block of the surface, the highest of it and of the eight next to it, all ground
/// within `side` cells of any cell of the block; and a little more, so that no rounding of a sample gets
/// above it.
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
      for (int x = column - 1; x <= column + 1; ++x) top = maximum(top, highest[sample_index(blocks, x, y)]);
    around[blocks.index(column, row)] = top + rounding(top);
  }
  /// More than what rounding adds to heights of this size, and to their differences [quanta].
  DESERT_HD static float rounding(float height) { return 1.0f + 2e-6f * fabsf(height); }
};

/// Shadow by the steepest rise that a march finds, 0 … 1.
struct Shade {
  float start, full;  ///< rises [quanta a cell]
  float per_rise;     ///< 1 / (full − start)

  Shade(const WindShadowParameters& p, float quanta_per_cell) {
    const float degree = 3.14159265358979f / 180.0f;
    const float tangent = tanf(p.start_deg * degree);
    start = tangent * quanta_per_cell;
    full = maximum(tanf(p.full_deg * degree), tangent + 1e-6f) * quanta_per_cell;
    per_rise = 1.0f / (full - start);
  }
  DESERT_HD float operator()(float steepest) const {
    return clamp((steepest - start) * per_rise, 0.0f, 1.0f);
  }
};

/// Where the wind is no faster, nothing is sheltered from it [m/s].
constexpr float calm = 1e-6f;

/// What both marches look at.
struct March {
  Grid grid;
  Shade shade;
  const float *heights, *wind_x, *wind_y;
  const float* reciprocals;  ///< 1/j for j = 0 … steps (but for 0)
  int steps;                 ///< at most
  float reach;               ///< [cells]
  float* wind_shadow;
};

struct Shadow : March {
  static constexpr bool compact_warps = true;  ///< cells near each other leave out the same pieces
  Grid blocks;
  const float* around;  ///< null: no piece is left out

  /// Where a cell's march goes, and from where.
  struct Start {
    int x, y;
    float base;
    marching::Line line;
    int steps;
  };

  template <bool inside>
  DESERT_HD float highest_around(int x, int y) const {
    if (!inside) {
      x = grid.periodic_x ? wrap(x, grid.width) : clamp_index(x, grid.width);
      y = grid.periodic_y ? wrap(y, grid.height) : clamp_index(y, grid.height);
    }
    constexpr unsigned side = Blocks::side;
    return around[static_cast<unsigned>(y) / side * static_cast<unsigned>(blocks.width) +
                  static_cast<unsigned>(x) / side];
  }

  /// heights[n + across], as a processor is quickest at it: a GPU adds the same `across` to the pointer once
  /// a march.
  DESERT_HD float height_beside(int n, int across) const {
#if defined(__CUDA_ARCH__)
    return (heights + across)[n];
#else
    return heights[n + across];
#endif
  }

  template <bool inside>
  DESERT_HD float rise(const Start& s, int j) const {
    const int place = j * s.line.drift;
    float first, second;
    if (inside) {
      const int along = s.line.along_x ? s.line.step : s.line.step * grid.width,
                across = s.line.along_x ? grid.width : 1;
      const int n = grid.index(s.x, s.y) + j * along + (place >> 16) * across;
      first = heights[n];
      second = height_beside(n, across);
    } else {
      const int x = s.x + s.line.dx(j), y = s.y + s.line.dy(j);
      first = heights[sample_index(grid, x, y)];
      second = heights[s.line.along_x ? sample_index(grid, x, y + 1) : sample_index(grid, x + 1, y)];
    }
    return (marching::height_between(first, second, place) - s.base) * reciprocals[j];
  }

  /// The steepest rise [quanta a step]; `inside`: the whole march is on the grid.
  template <bool inside>
  DESERT_HD float march(const Start& s) const {
    const float enough = shade.full * s.line.cells_a_step * 1.00001f;
    const float begins = shade.start * s.line.cells_a_step * 0.99999f,
                low = s.base - HighestAround::rounding(s.base);
    float steepest = 0.0f;
    for (int first = 1; first <= s.steps && steepest < enough; first += Blocks::piece) {
      const int half_way = first + Blocks::side - 1, middle = half_way < s.steps ? half_way : s.steps;
      if (around && highest_around<inside>(s.x + s.line.dx(middle), s.y + s.line.dy(middle)) - low <=
                        higher(steepest, begins) * static_cast<float>(first))
        continue;
      if (first + Blocks::piece <= s.steps + 1) {
        for (int n = 0; n < Blocks::piece; ++n) steepest = higher(steepest, rise<inside>(s, first + n));
      } else {
        for (int j = first; j <= s.steps; ++j) steepest = higher(steepest, rise<inside>(s, j));
      }
    }
    return steepest;
  }

  /// Of the cell (x, y) and its number i, against the wind (u, v) of a speed > 0.
  DESERT_HD Start start(int x, int y, int i, float u, float v, float speed) const {
    Start s{x, y, heights[i], marching::Line(u, v, speed), 0};
    const int wanted = static_cast<int>(reach * s.line.steps_a_cell + 1e-3f);
    s.steps = wanted < 1 ? 1 : (wanted < steps ? wanted : steps);
    return s;
  }

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float u = wind_x[i], v = wind_y[i], speed = hypotenuse(u, v);
    if (!(speed > calm)) {
      wind_shadow[i] = 0.0f;
      return;
    }
    const Start s = start(x, y, i, u, v, speed);
    const int end_x = x + s.line.dx(s.steps), end_y = y + s.line.dy(s.steps);
    const bool inside = x + 1 < grid.width && y + 1 < grid.height && grid.inside(end_x, end_y) &&
                        grid.inside(end_x + 1, end_y + 1);
    wind_shadow[i] = shade((inside ? march<true>(s) : march<false>(s)) * s.line.steps_a_cell);
  }
};

/// Marches of at most `longest` steps, from cells more than that away from every edge: without a branch, so
/// that a CPU can do several at once.
template <int longest>
struct ShortShadow : Shadow {
  static constexpr int margin = longest + 1;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    const float u = wind_x[i], v = wind_y[i], speed = hypotenuse(u, v);
    const bool blows = speed > calm;
    const Start s = start(x, y, i, blows ? u : 1.0f, blows ? v : 0.0f, blows ? speed : 1.0f);
    float steepest = 0.0f;
    unrolled<longest>([&](auto n) DESERT_INLINE {
      const int j = n + 1;
      const float found = higher(steepest, rise<true>(s, j));
      steepest = j <= s.steps ? found : steepest;
    });
    wind_shadow[i] = blows ? shade(steepest * s.line.steps_a_cell) : 0.0f;
  }
};

/// The march that follows the wind as it turns.
struct CurvedShadow : March {
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    float u = wind_x[i], v = wind_y[i];
    float steepest = 0.0f;  // quanta a cell
    int dx = 0, dy = 0;
    for (int j = 1; j <= steps; ++j) {
      const float speed = hypotenuse(u, v);
      if (!(speed > calm)) break;
      dx -= subcells(u / speed);
      dy -= subcells(v / speed);
      const float rise = marching::height_at(grid, heights, marching::Place(x, y, dx, dy)) - heights[i];
      steepest = maximum(steepest, rise * reciprocals[j]);
      const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
      u = wind_x[there];
      v = wind_y[there];
    }
    wind_shadow[i] = shade(steepest);
  }
};

/// `around` is empty where marches are too short to be cut, follow the wind, or blocks do not fit a periodic
/// axis.
struct Workspace {
  Buffer<float> reciprocals, around;
};

inline int march_steps(const Grid& grid, const WindShadowParameters& p) {
  return static_cast<int>(maximum(1.0f, floorf(p.distance / grid.cell_size)));
}
Workspace make_workspace(Exec& exec, const Grid& grid, const WindShadowParameters& p);

/// Of marches of at most `longest` steps.
template <int longest, class E>
void short_shadow(E& exec, const Shadow& shadow) {
  if constexpr (longest > 1)
    if (shadow.steps < longest) return short_shadow<longest - 1>(exec, shadow);
  using Inside = ShortShadow<longest>;
  for_each_cell(exec, shadow.grid, Bordered<Inside, Shadow>{shadow.grid, Inside::margin, {shadow}, shadow});
}

inline March march(const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
                   const Workspace& work) {
  return {t.grid,
          Shade(p, t.grid.cell_size * t.quanta_per_metre),
          heights.of_cells.data(),
          t.real(Layer::wind_x),
          t.real(Layer::wind_y),
          work.reciprocals.data(),
          march_steps(t.grid, p),
          p.distance / t.grid.cell_size,
          t.real(Layer::wind_shadow)};
}

/// The law of straight marches, ready for the terrain as it is.
template <class E>
Shadow straight_shadow(E& exec, const TerrainView& t, const WindShadowParameters& p,
                       const surface::Heights& heights, const Workspace& work) {
  if (work.around)
    for_each_cell(exec, heights.blocks,
                  HighestAround{heights.blocks, heights.highest.data(), work.around.data()});
  return {march(t, p, heights, work), heights.blocks, work.around.data()};
}

template <class E>
void step(E& exec, const TerrainView& t, const WindShadowParameters& p, const surface::Heights& heights,
          const Workspace& work) {
  if (p.curved) {
    for_each_cell(exec, t.grid, CurvedShadow{march(t, p, heights, work)});
    return;
  }
  const Shadow shadow = straight_shadow(exec, t, p, heights, work);
  if constexpr (works_on_rows<E>)
    if (shadow.steps <= Blocks::piece) return short_shadow<Blocks::piece>(exec, shadow);
  for_each_cell(exec, t.grid, shadow);
}

}  // namespace wind_shadow
}  // namespace desert_sim

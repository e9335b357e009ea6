#pragma once
/// The marches upwind that find the wind shadow; equations in wind_shadow.hpp.
///
/// Four cells of a block that lie beside each other across the direction of the march are computed together:
/// their samples of a step lie between five cells. A block has four such groups.
///
///   march along x            march along y
///   +--+--+--+--+            +--+--+--+--+
///   |  |  |  | 3|            |  |  |  |  |
///   |  |  |  | 2|  <- wind   |  |  |  |  |
///   |  |  |  | 1|            |  |  |  |  |
///   |  |  |  | 0|            | 0| 1| 2| 3|
///   +--+--+--+--+            +--+--+--+--+
///
/// A march is divided into pieces of four steps. A long march skips a piece if the highest ground around it
/// is too low to matter: if it rises no more steeply than what was found nearer, or than where shadow begins.
/// That changes no bit of the result.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/marching.hpp"
#include "src/core/constants.hpp"

namespace desert_sim::wind_shadow {

constexpr int side = surface::block_side;
/// Steps of a march that are skipped together: as many as a block is wide, so that their samples lie within
/// 2 × 2 blocks.
constexpr int piece = side;

/// Wind speed up to which the air counts as calm and there is no wind shadow [m/s].
constexpr float calm = 1e-6f;

/// Direction of the marches of a block's cells.
struct alignas(8) MarchDirection {
  int word;  ///< the line, packed: its drift, a multiple of 16, plus its heading + 2
  float steps_a_cell;

  MarchDirection() = default;
  DESERT_HD explicit MarchDirection(const marching::Line& l)
      : word(l.drift + l.heading + 2), steps_a_cell(1.0f / l.cells_a_step()) {}
  DESERT_HD marching::Line line() const { return {(word & 15) - 2, word & ~15}; }
};

/// Finds the course of a block's marches.
struct FindMarchDirection {
  Grid grid;
  const float *wind_x, *wind_y;

  /// The course is against the mean wind of the block's four middle cells. Mirrored or rotated wind gives the
  /// same bits.
  DESERT_HD MarchDirection operator()(int column, int row) const {
    const int west = clamp_index(side * column + 1, grid.width), east = clamp_index(west + 1, grid.width);
    const int south = clamp_index(side * row + 1, grid.height), north = clamp_index(south + 1, grid.height);
    const int cells[] = {grid.index(west, south), grid.index(east, north), grid.index(east, south),
                         grid.index(west, north)};
    const auto middle = [&](const float* w) {
      return 0.25f * ((w[cells[0]] + w[cells[1]]) + (w[cells[2]] + w[cells[3]]));
    };
    const float u = middle(wind_x), v = middle(wind_y);
    const bool calms = !(hypotenuse(u, v) > calm);
    return MarchDirection(calms ? marching::Line{0, 0} : marching::Line::against(u, v));
  }
};

struct SetMarchDirection {
  FindMarchDirection find;
  Grid blocks;
  MarchDirection* march_directions;
  DESERT_HD void operator()(int column, int row) const {
    march_directions[blocks.index(column, row)] = find(column, row);
  }
};

/// `around` holds, for each block of the surface, the greatest height of the block and of its neighbours to
/// the east, north and north-east, plus a margin that covers the rounding of samples.
struct HighestNearby {
  Grid blocks;
  const float* highest;
  float* around;

  DESERT_HD void operator()(int column, int row) const {
    float top = -static_cast<float>(wall_height);
    for (int y = row; y <= row + 1; ++y)
      for (int x = column; x <= column + 1; ++x) top = maximum(top, highest[sample_index(blocks, x, y)]);
    around[blocks.index(column, row)] = top + rounding(top);
  }
  /// Upper bound of the rounding errors of heights of this size and of their differences [quanta].
  DESERT_HD static float rounding(float height) { return 1.0f + 2e-6f * fabsf(height); }
};

/// Prepares what marches need of each block.
struct PrepareBlock {
  SetMarchDirection course;  ///< `march_directions` null: not needed
  HighestNearby highest;     ///< `around` null: not needed
  DESERT_HD void operator()(int column, int row) const {
    if (course.march_directions) course(column, row);
    if (highest.around) highest(column, row);
  }
};

/// Wind shadow r_s, 0 … 1, from the steepest rise that a march finds.
struct ShadowFromSlope {
  float start, full;  ///< rises [quanta per cell]
  float per_rise;     ///< 1 / (full − start)

  ShadowFromSlope(float start_deg, float full_deg, float quanta_per_cell) {
    const float degree = static_cast<float>(pi) / 180.0f;
    const float tangent = tanf(start_deg * degree);
    start = tangent * quanta_per_cell;
    full = maximum(tanf(full_deg * degree), tangent + 1e-6f) * quanta_per_cell;
    per_rise = 1.0f / (full - start);
  }
  DESERT_HD float operator()(float steepest) const {
    return clamp((steepest - start) * per_rise, 0.0f, 1.0f);
  }
};

/// Axis of a march, where it is known at compile time and index strides become constants.
enum class Way { along_x, along_y, either };

/// The straight march.
struct Shadow {
  static constexpr bool compact_warps = true;  ///< nearby cells skip the same pieces
  FindMarchDirection find;
  float reach;  ///< length of a march [cells]
  int steps;    ///< upper bound of its steps
  ShadowFromSlope shade;
  const float* heights;
  const float* reciprocals;  ///< 1/j for j = 1 … steps
  float* wind_shadow;
  Grid blocks;
  const MarchDirection* march_directions;  ///< of the blocks; null: each cell finds its own
  const float* around;                     ///< see HighestNearby; null: no piece is skipped

  DESERT_HD const Grid& grid() const { return find.grid; }
  DESERT_HD MarchDirection course(int column, int row) const {
    return march_directions ? march_directions[blocks.index(column, row)] : find(column, row);
  }
  /// Number of steps of a march on this course; 0 where it is calm.
  DESERT_HD int steps_of(const MarchDirection& c) const {
    const int wanted = static_cast<int>(reach * c.steps_a_cell + 1e-3f);
    return c.line().heading == 0 ? 0 : (wanted < 1 ? 1 : (wanted < steps ? wanted : steps));
  }

  /// `count` cells that lie beside each other across the march; (x, y) is the first.
  template <Way way, int count>
  struct Cells {
    DESERT_HD bool along_x() const { return way == Way::either ? line.along_x() : way == Way::along_x; }

    marching::Line line;
    int x, y, first;
    int along, across;               ///< index strides along and across the march
    const float* beside[count + 1];  ///< the heights, shifted by k cells across the march
    float base[count];

    DESERT_HD Cells(const Shadow& law, const marching::Line& to, int first_x, int first_y)
        : line(to), x(first_x), y(first_y), first(law.grid().index(x, y)) {
      const int width = law.grid().width;
      along = line.step() * (along_x() ? 1 : width);
      across = along_x() ? width : 1;
      for (int k = 0; k <= count; ++k) beside[k] = law.heights + k * across;
      for (int k = 0; k < count; ++k) base[k] = load_read_only(beside[k] + first);
    }
    DESERT_HD float height(int k, int j, int drifted) const {
      return load_read_only(beside[k] + (first + j * along + drifted * across));
    }
  };

  /// Updates the steepest rises with the samples of step j [quanta per step].
  template <bool inside, Way way, int count>
  DESERT_HD void look(const Cells<way, count>& cells, int j, float (&steepest)[count]) const {
    const int place = j * cells.line.drift, drifted = place >> 16;
    const float per_step = load_read_only(reciprocals + j), one_and = one_plus_fraction(place);
    const float of_nearer = fused(-one_and, per_step, 2.0f * per_step),
                of_farther = fused(one_and, per_step, -per_step);
    float h[count + 1];
    for (int k = 0; k <= count; ++k)
      h[k] = inside ? cells.height(k, j, drifted) : height(cells, k, j, drifted);
    for (int k = 0; k < count; ++k)
      steepest[k] =
          higher(steepest[k], fused(-per_step, cells.base[k], h[k] * of_nearer + h[k + 1] * of_farther));
  }

  /// Finds the steepest rises within `end` steps [quanta per step]; `inside`: the whole march is on the grid.
  template <bool inside, Way way, int count>
  DESERT_HD void march(const Cells<way, count>& cells, int end, float (&steepest)[count]) const {
    const float cells_a_step = cells.line.cells_a_step();
    const float enough = shade.full * cells_a_step * 1.00001f, begins = shade.start * cells_a_step * 0.99999f;
    float rounding = 0.0f;
    for (float base : cells.base) rounding = higher(rounding, HighestNearby::rounding(base));
    for (float& s : steepest) s = 0.0f;
    for (int first = 1; first <= end && lowest(steepest) < enough; first += piece) {
      if (around && !matters<inside>(cells, first, end, begins, rounding, steepest)) continue;
      if (inside && first + piece <= end + 1) {
        for (int n = 0; n < piece; ++n) look<inside>(cells, first + n, steepest);
      } else {
        DESERT_NO_UNROLL
        for (int j = first; j <= end && j < first + piece; ++j) look<inside>(cells, j, steepest);
      }
    }
  }

  /// Writes the wind shadow of `count` cells, all on the grid, and returns that of the first.
  template <Way way, int count>
  DESERT_HD float shelter(const MarchDirection& c, int x, int y) const {
    const Grid& g = grid();
    const Cells<way, count> cells(*this, c.line(), x, y);
    const int end = steps_of(c), end_x = x + cells.line.dx(end), end_y = y + cells.line.dy(end);
    // Offset of the last cell that the samples of a step read.
    const int east = cells.along_x() ? 0 : count, north = cells.along_x() ? count : 0;
    float steepest[count];
    if (g.inside(x + east, y + north) && g.inside(end_x, end_y) && g.inside(end_x + east, end_y + north))
      march<true>(cells, end, steepest);
    else
      march<false>(cells, end, steepest);
    for (float& s : steepest) s = shade(s * c.steps_a_cell);
    for (int k = 0; k < count; ++k) wind_shadow[cells.first + k * cells.across] = steepest[k];
    return steepest[0];
  }

  DESERT_HD float operator()(int x, int y) const {
    return shelter<Way::either, 1>(course(x / side, y / side), x, y);
  }

 private:
  /// Height where the march may leave the grid.
  template <Way way, int count>
  DESERT_HD float height(const Cells<way, count>& cells, int k, int j, int drifted) const {
    const int along = j * cells.line.step();
    return heights[cells.along_x() ? sample_index(grid(), cells.x + along, cells.y + drifted + k)
                                   : sample_index(grid(), cells.x + drifted + k, cells.y + along)];
  }

  template <int count>
  DESERT_HD static float lowest(const float (&of)[count]) {
    float least = of[0];
    for (int k = 1; k < count; ++k) least = lower(least, of[k]);
    return least;
  }

  /// Whether the piece from step `first` on, up to step `end` at most, can change a cell's shadow. The
  /// samples of each march lie to the east and north of the cell (x, y) computed below, within the block of
  /// that cell and the three blocks that `around` adds to it. `rounding`: upper bound of the rounding error
  /// of the cells' heights.
  template <bool inside, Way way, int count>
  DESERT_HD bool matters(const Cells<way, count>& cells, int first, int end, float begins, float rounding,
                         const float (&steepest)[count]) const {
    static_assert(count <= side);
    const int last = first + piece - 1 < end ? first + piece - 1 : end;
    const int along = cells.line.heading > 0 ? first : -last,
              across = ((cells.line.drift < 0 ? last : first) * cells.line.drift) >> 16;
    const int x = cells.x + (cells.along_x() ? along : across),
              y = cells.y + (cells.along_x() ? across : along);
    float top = highest_around<inside>(x, y);
    if (count > 1)  // of the last cell; the samples of those between lie in the blocks of these two
      top = higher(top, cells.along_x() ? highest_around<inside>(x, y + count - 1)
                                        : highest_around<inside>(x + count - 1, y));
    float to_exceed[count];
    for (int k = 0; k < count; ++k)
      to_exceed[k] = fused(higher(steepest[k], begins), static_cast<float>(first), cells.base[k]);
    return top + rounding > lowest(to_exceed);
  }

  template <bool inside>
  DESERT_HD float highest_around(int x, int y) const {
    const Grid& g = grid();
    if (!inside) {
      x = g.periodic_x ? wrap(x, g.width) : clamp_index(x, g.width);
      y = g.periodic_y ? wrap(y, g.height) : clamp_index(y, g.height);
    }
    return load_read_only(around + (static_cast<unsigned>(y) / side * static_cast<unsigned>(blocks.width) +
                                    static_cast<unsigned>(x) / side));
  }
};

/// The march that follows the changing wind direction (`curved`).
struct CurvedShadow {
  Grid grid;
  ShadowFromSlope shade;
  const float *heights, *wind_x, *wind_y;
  const float* reciprocals;
  int steps;
  float* wind_shadow;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    float u = wind_x[i], v = wind_y[i];
    float steepest = 0.0f;  // [quanta per cell]
    int dx = 0, dy = 0;
    for (int j = 1; j <= steps; ++j) {
      const float speed = hypotenuse(u, v);
      if (!(speed > calm)) break;
      dx -= to_fixed_point(u / speed);
      dy -= to_fixed_point(v / speed);
      const float rise = marching::height_at(grid, heights, marching::Place(x, y, dx, dy)) - heights[i];
      steepest = maximum(steepest, rise * reciprocals[j]);
      const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
      u = wind_x[there];
      v = wind_y[there];
    }
    wind_shadow[i] = shade(steepest);
  }
};

}  // namespace desert_sim::wind_shadow

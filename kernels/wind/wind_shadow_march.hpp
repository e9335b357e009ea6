#pragma once
/// How a cell looks upwind for shelter; what it makes of it in wind_shadow.hpp.
///
/// Four cells of a block, beside each other across the march, go together: their samples of a step lie
/// between five cells.
///
///   march along x            march along y
///   +--+--+--+--+            +--+--+--+--+
///   |  |  |  | 3|            |  |  |  |  |   each cell of a block is one of 4 such fours
///   |  |  |  | 2|  <- wind   |  |  |  |  |
///   |  |  |  | 1|            |  |  |  |  |
///   |  |  |  | 0|            | 0| 1| 2| 3|
///   +--+--+--+--+            +--+--+--+--+
///
/// A march is cut into pieces of four steps. Of a long one a piece is left out if the highest ground around
/// it is too low to matter: not steeper to look up to than what was found nearer, or than where shadow
/// begins. That changes no bit of the result.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/marching.hpp"

namespace desert_sim::wind_shadow {

constexpr int side = surface::block_side;
/// Steps of a march that are left out together: as many as a block is wide, so that they stay within two by
/// two blocks.
constexpr int piece = side;

/// Where the wind is no faster, nothing is sheltered from it [m/s].
constexpr float calm = 1e-6f;

/// Where the marches of a block's cells go.
struct alignas(8) Course {
  int word;  ///< the line: its drift, a multiple of 16, and its heading + 2
  float steps_a_cell;

  Course() = default;
  DESERT_HD explicit Course(const marching::Line& l)
      : word(l.drift + l.heading + 2), steps_a_cell(1.0f / l.cells_a_step()) {}
  DESERT_HD marching::Line line() const { return {(word & 15) - 2, word & ~15}; }
};

/// The course of a block's marches.
struct FindCourse {
  Grid grid;
  const float *wind_x, *wind_y;

  /// Against the mean wind of the four cells in the middle. Mirrored or turned wind gives the same bits.
  DESERT_HD Course operator()(int column, int row) const {
    const int west = clamp_index(side * column + 1, grid.width), east = clamp_index(west + 1, grid.width);
    const int south = clamp_index(side * row + 1, grid.height), north = clamp_index(south + 1, grid.height);
    const int cells[] = {grid.index(west, south), grid.index(east, north), grid.index(east, south),
                         grid.index(west, north)};
    const auto middle = [&](const float* w) {
      return 0.25f * ((w[cells[0]] + w[cells[1]]) + (w[cells[2]] + w[cells[3]]));
    };
    const float u = middle(wind_x), v = middle(wind_y);
    const bool calms = !(hypotenuse(u, v) > calm);
    return Course(calms ? marching::Line{0, 0} : marching::Line::against(u, v));
  }
};

struct SetCourse {
  FindCourse find;
  Grid blocks;
  Course* courses;
  DESERT_HD void operator()(int column, int row) const {
    courses[blocks.index(column, row)] = find(column, row);
  }
};

/// `around` holds, for each block of the surface, the highest of it and of those to the east, north and
/// north-east of it; and a little more, so that no rounding of a sample gets above it.
struct HighestAround {
  Grid blocks;
  const float* highest;
  float* around;

  DESERT_HD void operator()(int column, int row) const {
    float top = -static_cast<float>(wall_height);
    for (int y = row; y <= row + 1; ++y)
      for (int x = column; x <= column + 1; ++x) top = maximum(top, highest[sample_index(blocks, x, y)]);
    around[blocks.index(column, row)] = top + rounding(top);
  }
  /// More than what rounding adds to heights of this size, and to their differences [quanta].
  DESERT_HD static float rounding(float height) { return 1.0f + 2e-6f * fabsf(height); }
};

/// What marches need of a block.
struct PrepareBlock {
  SetCourse course;       ///< `courses` null: not needed
  HighestAround highest;  ///< `around` null: not needed
  DESERT_HD void operator()(int column, int row) const {
    if (course.courses) course(column, row);
    if (highest.around) highest(column, row);
  }
};

/// Shadow by the steepest rise that a march finds, 0 … 1.
struct Shade {
  float start, full;  ///< rises [quanta a cell]
  float per_rise;     ///< 1 / (full − start)

  Shade(float start_deg, float full_deg, float quanta_per_cell) {
    const float degree = 3.14159265358979f / 180.0f;
    const float tangent = tanf(start_deg * degree);
    start = tangent * quanta_per_cell;
    full = maximum(tanf(full_deg * degree), tangent + 1e-6f) * quanta_per_cell;
    per_rise = 1.0f / (full - start);
  }
  DESERT_HD float operator()(float steepest) const {
    return clamp((steepest - start) * per_rise, 0.0f, 1.0f);
  }
};

/// Of a march, if that is known before it is compiled: columns of cells lie beside each other in memory.
enum class Way { along_x, along_y, either };

/// The straight march.
struct Shadow {
  static constexpr bool compact_warps = true;  ///< cells near each other leave out the same pieces
  FindCourse find;
  float reach;  ///< [cells]
  int steps;    ///< at most
  Shade shade;
  const float* heights;
  const float* reciprocals;  ///< 1/j for j = 0 … steps (but for 0)
  float* wind_shadow;
  Grid blocks;
  const Course* courses;  ///< of the blocks; null: found by each cell
  const float* around;    ///< null: no piece is left out

  DESERT_HD const Grid& grid() const { return find.grid; }
  DESERT_HD Course course(int column, int row) const {
    return courses ? courses[blocks.index(column, row)] : find(column, row);
  }
  /// Of the cells that go there; none where it is calm.
  DESERT_HD int steps_of(const Course& c) const {
    const int wanted = static_cast<int>(reach * c.steps_a_cell + 1e-3f);
    return c.line().heading == 0 ? 0 : (wanted < 1 ? 1 : (wanted < steps ? wanted : steps));
  }

  /// `count` cells beside each other across the march, of which (x, y) is the first.
  template <Way way, int count>
  struct Cells {
    DESERT_HD bool along_x() const { return way == Way::either ? line.along_x() : way == Way::along_x; }

    marching::Line line;
    int x, y, first;
    int along, across;               ///< to the next cell's index
    const float* beside[count + 1];  ///< heights, from k cells across on
    float base[count];

    DESERT_HD Cells(const Shadow& law, const marching::Line& to, int first_x, int first_y)
        : line(to), x(first_x), y(first_y), first(law.grid().index(x, y)) {
      const int width = law.grid().width;
      along = line.step() * (along_x() ? 1 : width);
      across = along_x() ? width : 1;
      for (int k = 0; k <= count; ++k) beside[k] = law.heights + k * across;
      for (int k = 0; k < count; ++k) base[k] = constant_at(beside[k] + first);
    }
    DESERT_HD float height(int k, int j, int drifted) const {
      return constant_at(beside[k] + (first + j * along + drifted * across));
    }
  };

  /// What the cells find at step j [quanta a step].
  template <bool inside, Way way, int count>
  DESERT_HD void look(const Cells<way, count>& cells, int j, float (&steepest)[count]) const {
    const int place = j * cells.line.drift, drifted = place >> 16;
    const float per_step = constant_at(reciprocals + j), one_and = one_and_fraction(place);
    const float of_nearer = fused(-one_and, per_step, 2.0f * per_step),
                of_farther = fused(one_and, per_step, -per_step);
    float h[count + 1];
    for (int k = 0; k <= count; ++k)
      h[k] = inside ? cells.height(k, j, drifted) : height(cells, k, j, drifted);
    for (int k = 0; k < count; ++k)
      steepest[k] =
          higher(steepest[k], fused(-per_step, cells.base[k], h[k] * of_nearer + h[k + 1] * of_farther));
  }

  /// The steepest rises [quanta a step] of `end` steps; `inside`: the whole march is on the grid.
  template <bool inside, Way way, int count>
  DESERT_HD void march(const Cells<way, count>& cells, int end, float (&steepest)[count]) const {
    const float cells_a_step = cells.line.cells_a_step();
    const float enough = shade.full * cells_a_step * 1.00001f, begins = shade.start * cells_a_step * 0.99999f;
    float rounding = 0.0f;
    for (float base : cells.base) rounding = higher(rounding, HighestAround::rounding(base));
    for (float& s : steepest) s = 0.0f;
    for (int first = 1; first <= end && lowest(steepest) < enough; first += piece) {
      if (around && !matters<inside>(cells, first, end, begins, rounding, steepest)) continue;
      if (inside && first + piece <= end + 1) {
        for (int n = 0; n < piece; ++n) look<inside>(cells, first + n, steepest);
      } else {
        DESERT_ROLLED
        for (int j = first; j <= end && j < first + piece; ++j) look<inside>(cells, j, steepest);
      }
    }
  }

  /// Of `count` cells, all on the grid; that of the first.
  template <Way way, int count>
  DESERT_HD float shelter(const Course& c, int x, int y) const {
    const Grid& g = grid();
    const Cells<way, count> cells(*this, c.line(), x, y);
    const int end = steps_of(c), end_x = x + cells.line.dx(end), end_y = y + cells.line.dy(end);
    const int east = cells.along_x() ? 0 : count, north = cells.along_x() ? count : 0;  // to a sample's last
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
  /// Likewise where the march leaves the grid.
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

  /// Whether the piece from step `first` on, of `end` at most, can change a cell's shadow. What each of the
  /// marches looks at there lies east and north of a cell of its, in that one's block and the three which
  /// `around` adds to it. `rounding`: of the cells' heights.
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
    if (count > 1)  // of the last; those between look where these two do
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
    return constant_at(around + (static_cast<unsigned>(y) / side * static_cast<unsigned>(blocks.width) +
                                 static_cast<unsigned>(x) / side));
  }
};

/// Shadow of four cells at a time; called for each four of each block.
struct ShadowOfFour {
  static constexpr bool compact_warps = true;
  Shadow shadow;

  DESERT_HD Grid fours() const { return {side * shadow.blocks.width, shadow.blocks.height, 1}; }
  DESERT_HD void operator()(int four, int row) const {
    const Course c = shadow.course(four / side, row);
    c.line().along_x() ? shelter<Way::along_x>(c, four, row) : shelter<Way::along_y>(c, four, row);
  }

 private:
  template <Way way>
  DESERT_HD void shelter(const Course& c, int four, int row) const {
    constexpr bool along_x = way == Way::along_x;
    const int x = four / side * side + (along_x ? four % side : 0);
    const int y = row * side + (along_x ? 0 : four % side);
    constexpr int east = along_x ? 0 : 1, north = along_x ? 1 : 0;
    if (shadow.grid().inside(x + (side - 1) * east, y + (side - 1) * north)) {
      shadow.shelter<way, side>(c, x, y);
      return;
    }
    DESERT_ROLLED
    for (int k = 0; k < side; ++k)
      if (shadow.grid().inside(x + k * east, y + k * north))
        shadow.shelter<way, 1>(c, x + k * east, y + k * north);
  }
};

/// Marches of at most `longest` steps, from cells more than that away from every edge: without a branch, so
/// that a CPU can do several at once.
template <int longest>
struct ShortShadow {
  static constexpr int margin = longest + 1;
  Shadow shadow;  ///< with courses

  DESERT_HD void operator()(int x, int y) const {
    const Course c = shadow.courses[y / side * shadow.blocks.width + x / side];
    const int end = shadow.steps_of(c);
    const Shadow::Cells<Way::either, 1> cell(shadow, c.line(), x, y);
    float steepest[1] = {0.0f};
    unrolled<longest>([&](auto n) DESERT_INLINE {
      float found[1] = {steepest[0]};
      shadow.look<true>(cell, n + 1, found);
      steepest[0] = n + 1 <= end ? found[0] : steepest[0];
    });
    shadow.wind_shadow[cell.first] = shadow.shade(steepest[0] * c.steps_a_cell);
  }
};

/// The march that follows the wind as it turns.
struct CurvedShadow {
  Grid grid;
  Shade shade;
  const float *heights, *wind_x, *wind_y;
  const float* reciprocals;
  int steps;
  float* wind_shadow;

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

}  // namespace desert_sim::wind_shadow

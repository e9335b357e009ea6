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
/// A long march is cut into pieces. A piece is left out if the highest ground around it is too low to matter:
/// neither steeper to look up to than what was found nearer, nor than where shadow begins. That changes no
/// bit of the result.

#include "desert_sim/kernels/for_each.hpp"
#include "desert_sim/kernels/marching.hpp"
#include "desert_sim/kernels/math.hpp"
#include "desert_sim/kernels/surface.hpp"

namespace desert_sim::wind_shadow {

constexpr int side = surface::block_side;
/// Steps of a march that stay within `side` cells of the cell under its middle, the second of the two cells
/// of a sample included.
constexpr int piece = 2 * (side - 1) + 1;

/// Where the wind is no faster, nothing is sheltered from it [m/s].
constexpr float calm = 1e-6f;

/// Where the marches of a block's cells go.
struct Course {
  marching::Line line;
  float cells_a_step, steps_a_cell;
  int steps;  ///< 0 where it is calm

  /// Of at most `most` steps that reach `reach` cells far.
  DESERT_HD Course(const marching::Line& l, float reach, int most)
      : line(l), cells_a_step(l.cells_a_step()), steps_a_cell(1.0f / cells_a_step) {
    const int wanted = static_cast<int>(reach * steps_a_cell + 1e-3f);
    steps = l.heading == 0 ? 0 : (wanted < 1 ? 1 : (wanted < most ? wanted : most));
  }
};

/// The line of a block's marches, in a word.
struct FindLine {
  Grid grid;
  const float *wind_x, *wind_y;

  DESERT_HD static int word(const marching::Line& line) { return line.drift / 16 * 8 + line.heading + 2; }
  DESERT_HD static marching::Line line(int word) { return {(word & 7) - 2, (word >> 3) * 16}; }

  /// Against the mean wind of the four cells in the middle; heading 0 where it is calm. Mirrored or turned
  /// wind gives the same bits.
  DESERT_HD marching::Line operator()(int column, int row) const {
    const int west = clamp_index(side * column + 1, grid.width), east = clamp_index(west + 1, grid.width);
    const int south = clamp_index(side * row + 1, grid.height), north = clamp_index(south + 1, grid.height);
    const int cells[] = {grid.index(west, south), grid.index(east, north), grid.index(east, south),
                         grid.index(west, north)};
    const auto middle = [&](const float* w) {
      return 0.25f * ((w[cells[0]] + w[cells[1]]) + (w[cells[2]] + w[cells[3]]));
    };
    const float u = middle(wind_x), v = middle(wind_y);
    return hypotenuse(u, v) > calm ? marching::Line::against(u, v) : marching::Line{0, 0};
  }
};

struct SetLine {
  FindLine find;
  Grid blocks;
  int* lines;
  DESERT_HD void operator()(int column, int row) const {
    lines[blocks.index(column, row)] = FindLine::word(find(column, row));
  }
};

/// `around` holds, for each block of the surface, the highest of it and of the eight next to it, all ground
/// within `side` cells of any cell of the block; and a little more, so that no rounding of a sample gets
/// above it.
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

/// What marches need of a block.
struct PrepareBlock {
  SetLine line;           ///< `lines` null: not needed
  HighestAround highest;  ///< `around` null: not needed
  DESERT_HD void operator()(int column, int row) const {
    if (line.lines) line(column, row);
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

/// The straight march.
struct Shadow {
  static constexpr bool compact_warps = true;  ///< cells near each other leave out the same pieces
  FindLine find;
  float reach;  ///< [cells]
  int steps;    ///< at most
  Shade shade;
  const float* heights;
  const float* reciprocals;  ///< 1/j for j = 0 … steps (but for 0)
  float* wind_shadow;
  Grid blocks;
  const int* lines;     ///< of the blocks; null: found by each cell
  const float* around;  ///< null: no piece is left out

  DESERT_HD const Grid& grid() const { return find.grid; }
  DESERT_HD Course course(int column, int row) const {
    const marching::Line line = lines ? FindLine::line(lines[blocks.index(column, row)]) : find(column, row);
    return Course(line, reach, steps);
  }

  /// Of `count` cells beside each other across the march, of which (x, y) is the first.
  template <int count>
  struct Cells {
    int x, y, first;
    int along, across;               ///< to the next cell's index
    const float* beside[count + 1];  ///< heights, from k cells across on: so that a GPU adds nothing else
    float base[count];
  };
  template <int count>
  DESERT_HD Cells<count> cells(const Course& c, int x, int y) const {
    const bool along_x = c.line.along_x();
    const int width = grid().width;
    Cells<count> cells{x,  y, grid().index(x, y), c.line.step() * (along_x ? 1 : width), along_x ? width : 1,
                       {}, {}};
    for (int k = 0; k <= count; ++k) cells.beside[k] = heights + k * cells.across;
    for (int k = 0; k < count; ++k) cells.base[k] = cells.beside[k][cells.first];
    return cells;
  }

  /// What the cells find at step j [quanta a step].
  template <bool inside, int count>
  DESERT_HD void look(const Course& c, const Cells<count>& cells, int j, float (&steepest)[count]) const {
    const int place = j * c.line.drift, across = place >> 16;
    const float share = fraction(place), per_step = reciprocals[j];
    const float of_nearer = (1.0f - share) * per_step, of_farther = share * per_step;
    float h[count + 1];
    for (int k = 0; k <= count; ++k) h[k] = height<inside>(c, cells, j, across, k);
    for (int k = 0; k < count; ++k)
      steepest[k] =
          higher(steepest[k], fused(-per_step, cells.base[k], h[k] * of_nearer + h[k + 1] * of_farther));
  }

  /// The steepest rises [quanta a step]; `inside`: the whole march is on the grid.
  template <bool inside, int count>
  DESERT_HD void march(const Course& c, const Cells<count>& cells, float (&steepest)[count]) const {
    const float enough = shade.full * c.cells_a_step * 1.00001f,
                begins = shade.start * c.cells_a_step * 0.99999f;
    for (float& s : steepest) s = 0.0f;
    for (int first = 1; first <= c.steps && any_below(enough, steepest); first += piece) {
      if (around && !matters<inside>(c, cells, first, enough, begins, steepest)) continue;
      if (first + piece <= c.steps + 1) {
        for (int n = 0; n < piece; ++n) look<inside>(c, cells, first + n, steepest);
      } else {
        for (int j = first; j <= c.steps; ++j) look<inside>(c, cells, j, steepest);
      }
    }
  }

  /// Of `count` cells; `inside` all of them are on the grid.
  template <int count>
  DESERT_HD void shelter(const Course& c, int x, int y) const {
    const Grid& g = grid();
    const Cells<count> these = cells<count>(c, x, y);
    const bool along_x = c.line.along_x();
    const int end_x = x + c.line.dx(c.steps), end_y = y + c.line.dy(c.steps);
    const int east = along_x ? 0 : count, north = along_x ? count : 0;  // to the last that a sample takes
    float steepest[count];
    if (g.inside(x + east, y + north) && g.inside(end_x, end_y) && g.inside(end_x + east, end_y + north))
      march<true>(c, these, steepest);
    else
      march<false>(c, these, steepest);
    for (int k = 0; k < count; ++k)
      wind_shadow[these.first + k * these.across] = shade(steepest[k] * c.steps_a_cell);
  }

  DESERT_HD void operator()(int x, int y) const { shelter<1>(course(x / side, y / side), x, y); }

 private:
  /// The height `across` + k cells beside where step j of the first cell is when it does not drift.
  template <bool inside, int count>
  DESERT_HD float height(const Course& c, const Cells<count>& cells, int j, int across, int k) const {
    if (inside) return cells.beside[k][cells.first + j * cells.along + across * cells.across];
    const int along = j * c.line.step();
    return heights[c.line.along_x() ? sample_index(grid(), cells.x + along, cells.y + across + k)
                                    : sample_index(grid(), cells.x + across + k, cells.y + along)];
  }

  template <int count>
  DESERT_HD static bool any_below(float enough, const float (&steepest)[count]) {
    bool any = false;
    for (float s : steepest) any = any || s < enough;
    return any;
  }

  /// Whether the piece that begins with step `first` can change a cell's shadow. What lies around its first
  /// and its last cell in the piece's middle is around those between, too.
  template <bool inside, int count>
  DESERT_HD bool matters(const Course& c, const Cells<count>& cells, int first, float enough, float begins,
                         const float (&steepest)[count]) const {
    static_assert(count <= side);
    const int half_way = first + side - 1, middle = half_way < c.steps ? half_way : c.steps;
    const int x = cells.x + c.line.dx(middle), y = cells.y + c.line.dy(middle);
    float top = highest_around<inside>(x, y);
    if (count > 1)
      top = higher(top, c.line.along_x() ? highest_around<inside>(x, y + count - 1)
                                         : highest_around<inside>(x + count - 1, y));
    bool any = false;
    for (int k = 0; k < count; ++k) {
      const float low = cells.base[k] - HighestAround::rounding(cells.base[k]);
      any = any ||
            (steepest[k] < enough && top - low > higher(steepest[k], begins) * static_cast<float>(first));
    }
    return any;
  }

  template <bool inside>
  DESERT_HD float highest_around(int x, int y) const {
    const Grid& g = grid();
    if (!inside) {
      x = g.periodic_x ? wrap(x, g.width) : clamp_index(x, g.width);
      y = g.periodic_y ? wrap(y, g.height) : clamp_index(y, g.height);
    }
    return around[static_cast<unsigned>(y) / side * static_cast<unsigned>(blocks.width) +
                  static_cast<unsigned>(x) / side];
  }
};

/// Shadow of four cells at a time; called for each four of each block.
struct ShadowOfFour {
  static constexpr bool compact_warps = true;
  Shadow shadow;

  DESERT_HD Grid fours() const { return {side * shadow.blocks.width, shadow.blocks.height, 1}; }
  DESERT_HD void operator()(int four, int row) const {
    const Course c = shadow.course(four / side, row);
    const bool along_x = c.line.along_x();
    const int x = four / side * side + (along_x ? four % side : 0);
    const int y = row * side + (along_x ? 0 : four % side);
    const int east = along_x ? 0 : 1, north = along_x ? 1 : 0;
    if (shadow.grid().inside(x + (side - 1) * east, y + (side - 1) * north))
      shadow.shelter<side>(c, x, y);
    else
      for (int k = 0; k < side; ++k)
        if (shadow.grid().inside(x + k * east, y + k * north))
          shadow.shelter<1>(c, x + k * east, y + k * north);
  }
};

/// Marches of at most `longest` steps, from cells more than that away from every edge: without a branch, so
/// that a CPU can do several at once.
template <int longest>
struct ShortShadow {
  static constexpr int margin = longest + 1;
  Shadow shadow;  ///< with lines

  DESERT_HD void operator()(int x, int y) const {
    const int word = shadow.lines[y / side * shadow.blocks.width + x / side];
    const Course c(FindLine::line(word), shadow.reach, shadow.steps);
    const Shadow::Cells<1> cell = shadow.cells<1>(c, x, y);
    float steepest[1] = {0.0f};
    unrolled<longest>([&](auto n) DESERT_INLINE {
      float found[1] = {steepest[0]};
      shadow.look<true>(c, cell, n + 1, found);
      steepest[0] = n + 1 <= c.steps ? found[0] : steepest[0];
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

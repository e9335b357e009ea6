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
#include "kernels/base/math.hpp"
#include "kernels/field/surface.hpp"
#include "kernels/wind/marching.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim::wind_shadow {

constexpr int side = surface::block_side;
/// Steps of a march that are skipped together: as many as a block is wide, so that their samples lie within
/// 2 × 2 blocks.
constexpr int piece_steps = side;

/// Wind speed up to which the air counts as calm and there is no wind shadow [m/s].
constexpr float calm = 1e-6f;

/// Direction of the marches of a block's cells.
struct alignas(8) MarchDirection {
  int word;  ///< the line, packed: its drift, a multiple of 16, plus its heading + 2
  float steps_per_cell;

  MarchDirection() = default;
  DESERT_HD explicit MarchDirection(const marching::Line& l)
      : word(l.drift + l.heading + 2), steps_per_cell(1.0f / l.cells_per_step()) {}
  DESERT_HD marching::Line line() const { return {(word & 15) - 2, word & ~15}; }
};

/// Finds the direction of a block's marches.
struct FindMarchDirection {
  Grid grid;
  const float *wind_x, *wind_y;

  /// The direction is against the mean wind of the block's four middle cells. Mirrored or rotated wind gives
  /// the same bits.
  DESERT_HD MarchDirection operator()(int column, int row) const {
    const int west = clamp_index(side * column + 1, grid.width), east = clamp_index(west + 1, grid.width);
    const int south = clamp_index(side * row + 1, grid.height), north = clamp_index(south + 1, grid.height);
    const int cells[] = {grid.index(west, south), grid.index(east, north), grid.index(east, south),
                         grid.index(west, north)};
    const auto middle = [&](const float* w) {
      return 0.25f * ((w[cells[0]] + w[cells[1]]) + (w[cells[2]] + w[cells[3]]));
    };
    const float u = middle(wind_x), v = middle(wind_y);
    const bool is_calm = !(hypotenuse(u, v) > calm);
    return MarchDirection(is_calm ? marching::Line{0, 0} : marching::Line::against(u, v));
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

/// `highest_nearby` holds, for each block of the surface, the greatest height of the block and of its
/// neighbours to the east, north and north-east, plus a margin that covers the rounding of samples.
struct HighestNearby {
  Grid blocks;
  const float* highest;
  float* highest_nearby;

  DESERT_HD void operator()(int column, int row) const {
    float top = -static_cast<float>(wall_height);
    for (int y = row; y <= row + 1; ++y)
      for (int x = column; x <= column + 1; ++x) top = maximum(top, highest[sample_index(blocks, x, y)]);
    highest_nearby[blocks.index(column, row)] = top + rounding(top);
  }
  /// Upper bound of the rounding errors of heights of this size and of their differences [quanta].
  DESERT_HD static float rounding(float height) { return 1.0f + 2e-6f * fabsf(height); }
};

/// Prepares what marches need of each block.
struct PrepareBlock {
  SetMarchDirection direction;  ///< `march_directions` null: not needed
  HighestNearby highest;        ///< `highest_nearby` null: not needed
  DESERT_HD void operator()(int column, int row) const {
    if (direction.march_directions) direction(column, row);
    if (highest.highest_nearby) highest(column, row);
  }
};

/// Wind shadow r_s, 0 … 1, from the steepest rise that a march finds.
struct ShadowFromSlope {
  float start, full;  ///< rises [quanta per cell]
  float per_rise;     ///< 1 / (full − start)

  ShadowFromSlope(float start_deg, float full_deg, float quanta_per_cell) {
    const auto tangent = static_cast<float>(elementary::tan_deg(start_deg));
    start = tangent * quanta_per_cell;
    full = maximum(static_cast<float>(elementary::tan_deg(full_deg)), tangent + 1e-6f) * quanta_per_cell;
    per_rise = 1.0f / (full - start);
  }
  DESERT_HD float operator()(float steepest) const {
    return clamp((steepest - start) * per_rise, 0.0f, 1.0f);
  }
};

/// How much higher the ground lies at one cell's distance in the direction of a unit vector, on the quadratic
/// surface through the nine cells around [units of height]:
///
///   rise = e·∇h + ½ eᵀ(∇∇h) e   with central differences
///
/// Along an axis this is the next cell's rise. The first step of a march is √2 cells long on a diagonal: with
/// the samples of steps alone, rough ground has up to a quarter less shadow there than on an axis.
struct RiseOverOneCell {
  float ahead, behind, right, left, corners;

  DESERT_HD RiseOverOneCell(float along, float across)
      : ahead(0.5f * along * (along + 1.0f)),
        behind(0.5f * along * (along - 1.0f)),
        right(0.5f * across * (across + 1.0f)),
        left(0.5f * across * (across - 1.0f)),
        corners(0.25f * along * across) {}

  /// `height(a, b)`: of the cell a cells along and b cells across. The order of summation is symmetric, so
  /// that mirrored or rotated terrain gives the same bits.
  template <class Height>
  DESERT_HD float operator()(const Height& height) const {
    const float here = height(0, 0);
    return ((ahead * (height(1, 0) - here) + behind * (height(-1, 0) - here)) +
            (right * (height(0, 1) - here) + left * (height(0, -1) - here))) +
           corners * ((height(1, 1) + height(-1, -1)) - (height(1, -1) + height(-1, 1)));
  }
};

/// The rise over the first cell of a march, for as far as a step [units of height]; 0 where the ground falls.
struct RiseOverFirstStep {
  float cells_per_step, along;
  RiseOverOneCell rise;

  DESERT_HD explicit RiseOverFirstStep(const marching::Line& line)
      : cells_per_step(line.cells_per_step()),
        along(1.0f / cells_per_step),
        rise(along, along * static_cast<float>(line.drift) * (1.0f / 65536.0f)) {}
  template <class Height>
  DESERT_HD float operator()(const Height& height) const {
    return fast_max(0.0f, cells_per_step * rise(height));
  }
};

/// The sample of step j, between two cells of a column or row.
struct StepSample {
  int drifted;  ///< cells across the march up to the nearer one
  float per_step, nearer_weight, farther_weight;

  /// `reciprocals`: of Shadow.
  DESERT_HD StepSample(int j, int drift, const float* reciprocals) {
    const int place = j * drift;
    const float one_and = one_plus_fraction(place);
    drifted = place >> 16;
    per_step = load_read_only(reciprocals + j);
    nearer_weight = fused(-one_and, per_step, 2.0f * per_step);
    farther_weight = fused(one_and, per_step, -per_step);
  }
  /// Rise from `base` to it, between heights [units of height per step].
  DESERT_HD float rise(float base, float nearer, float farther) const {
    return fused(-per_step, base, nearer * nearer_weight + farther * farther_weight);
  }
};

/// Axis of a march, where it is known at compile time and index strides become constants.
enum class MarchAxis { along_x, along_y, either };

/// The straight march.
struct Shadow {
  static constexpr bool compact_warps = true;  ///< nearby cells skip the same pieces
  FindMarchDirection find;
  float reach;  ///< length of a march [cells]
  int steps;    ///< upper bound of its steps
  ShadowFromSlope shadow_from_slope;
  const float* heights;
  const float* reciprocals;  ///< 1/j for j = 1 … steps
  float* wind_shadow;
  Grid blocks;
  const MarchDirection* march_directions;  ///< of the blocks; null: each cell finds its own
  const float* highest_nearby;             ///< see HighestNearby; null: no piece is skipped

  DESERT_HD const Grid& grid() const { return find.grid; }
  DESERT_HD MarchDirection march_direction(int column, int row) const {
    return march_directions ? march_directions[blocks.index(column, row)] : find(column, row);
  }
  /// Number of steps of a march in this direction; 0 where it is calm.
  DESERT_HD int steps_of(const MarchDirection& c) const {
    const int wanted = static_cast<int>(reach * c.steps_per_cell + 1e-3f);
    return c.line().heading == 0 ? 0 : (wanted < 1 ? 1 : (wanted < steps ? wanted : steps));
  }

  /// `count` cells that lie beside each other across the march; (x, y) is the first.
  template <MarchAxis axis, int count>
  struct CellGroup {
    DESERT_HD bool along_x() const {
      return axis == MarchAxis::either ? line.along_x() : axis == MarchAxis::along_x;
    }

    marching::Line line;
    int x, y, first;
    int along, across;                        ///< index strides along and across the march
    const float* shifted_heights[count + 1];  ///< the heights, shifted by k cells across the march
    float base[count];

    DESERT_HD CellGroup(const Shadow& law, const marching::Line& to, int first_x, int first_y)
        : line(to), x(first_x), y(first_y), first(law.grid().index(x, y)) {
      const int width = law.grid().width;
      along = line.step() * (along_x() ? 1 : width);
      across = along_x() ? width : 1;
      for (int k = 0; k <= count; ++k) shifted_heights[k] = law.heights + k * across;
      for (int k = 0; k < count; ++k) base[k] = load_read_only(shifted_heights[k] + first);
    }
    DESERT_HD float height(int k, int j, int drifted) const {
      return load_read_only(shifted_heights[k] + (first + j * along + drifted * across));
    }
  };

  /// The rises over the first cell [quanta per step], or 0 where the first step's samples stand for them;
  /// `inside`: all cells around are on the grid.
  template <bool inside, MarchAxis axis, int count>
  DESERT_HD void rise_over_one_cell(const CellGroup<axis, count>& cells, float (&steepest)[count]) const {
    for (float& s : steepest) s = 0.0f;
    if (!cells.line.is_oblique()) return;
    const RiseOverFirstStep rise(cells.line);
    float h[3][count + 2];  // from the row behind to the row ahead
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < count + 2; ++k)
        h[row][k] =
            inside
                ? load_read_only(heights + (cells.first + (row - 1) * cells.along + (k - 1) * cells.across))
                : height(cells, k - 1, row - 1, 0);
    DESERT_SIMD
    for (int k = 0; k < count; ++k)
      steepest[k] = rise([&](int a, int b) DESERT_INLINE { return h[a + 1][k + 1 + b]; });
  }

  /// Updates the steepest rises with the samples of step j [quanta per step].
  template <bool inside, MarchAxis axis, int count>
  DESERT_HD void sample_step(const CellGroup<axis, count>& cells, int j, float (&steepest)[count]) const {
    const StepSample sample(j, cells.line.drift, reciprocals);
    float h[count + 1];
    for (int k = 0; k <= count; ++k)
      h[k] = inside ? cells.height(k, j, sample.drifted) : height(cells, k, j, sample.drifted);
    for (int k = 0; k < count; ++k)
      steepest[k] = fast_max(steepest[k], sample.rise(cells.base[k], h[k], h[k + 1]));
  }

  /// Finds the steepest rises within `end` steps [quanta per step]; `inside`: the whole march is on the grid.
  template <bool inside, MarchAxis axis, int count>
  DESERT_HD void march(const CellGroup<axis, count>& cells, int end, float (&steepest)[count]) const {
    const float cells_per_step = cells.line.cells_per_step();
    const float full_rise = shadow_from_slope.full * cells_per_step * 1.00001f,
                start_rise = shadow_from_slope.start * cells_per_step * 0.99999f;
    float rounding = 0.0f;
    for (float base : cells.base) rounding = fast_max(rounding, HighestNearby::rounding(base));
    rise_over_one_cell<inside>(cells, steepest);
    for (int first = 1; first <= end && min_of(steepest) < full_rise; first += piece_steps) {
      if (highest_nearby && !can_change_shadow<inside>(cells, first, end, start_rise, rounding, steepest))
        continue;
      if (inside && first + piece_steps <= end + 1) {
        for (int n = 0; n < piece_steps; ++n) sample_step<inside>(cells, first + n, steepest);
      } else {
        DESERT_NO_UNROLL
        for (int j = first; j <= end && j < first + piece_steps; ++j) sample_step<inside>(cells, j, steepest);
      }
    }
  }

  /// Writes the wind shadow of `count` cells, all on the grid, and returns that of the first.
  template <MarchAxis axis, int count>
  DESERT_HD float compute_shadow(const MarchDirection& c, int x, int y) const {
    const Grid& g = grid();
    const CellGroup<axis, count> cells(*this, c.line(), x, y);
    const int end = steps_of(c), end_x = x + cells.line.dx(end), end_y = y + cells.line.dy(end);
    // Offset of the last cell that the samples of a step read.
    const int east = cells.along_x() ? 0 : count, north = cells.along_x() ? count : 0;
    const bool around =
        g.inside(x - 1, y - 1) && g.inside(x + (east > 0 ? east : 1), y + (north > 0 ? north : 1));
    float steepest[count];
    if (around && g.inside(end_x, end_y) && g.inside(end_x + east, end_y + north))
      march<true>(cells, end, steepest);
    else
      march<false>(cells, end, steepest);
    for (float& s : steepest) s = shadow_from_slope(s * c.steps_per_cell);
    for (int k = 0; k < count; ++k) wind_shadow[cells.first + k * cells.across] = steepest[k];
    return steepest[0];
  }

  DESERT_HD float operator()(int x, int y) const {
    return compute_shadow<MarchAxis::either, 1>(march_direction(x / side, y / side), x, y);
  }

 private:
  /// Height where the march may leave the grid.
  template <MarchAxis axis, int count>
  DESERT_HD float height(const CellGroup<axis, count>& cells, int k, int j, int drifted) const {
    const int along = j * cells.line.step();
    return heights[cells.along_x() ? sample_index(grid(), cells.x + along, cells.y + drifted + k)
                                   : sample_index(grid(), cells.x + drifted + k, cells.y + along)];
  }

  template <int count>
  DESERT_HD static float min_of(const float (&of)[count]) {
    float least = of[0];
    for (int k = 1; k < count; ++k) least = fast_min(least, of[k]);
    return least;
  }

  /// Whether the piece from step `first` on, up to step `end` at most, can change a cell's shadow. The
  /// samples of each march lie to the east and north of the cell (x, y) computed below, within the block of
  /// that cell and the three blocks that `highest_nearby` adds to it. `rounding`: upper bound of the rounding
  /// error of the cells' heights.
  template <bool inside, MarchAxis axis, int count>
  DESERT_HD bool can_change_shadow(const CellGroup<axis, count>& cells, int first, int end, float start_rise,
                                   float rounding, const float (&steepest)[count]) const {
    static_assert(count <= side);
    const int last = first + piece_steps - 1 < end ? first + piece_steps - 1 : end;
    const int along = cells.line.heading > 0 ? first : -last,
              across = ((cells.line.drift < 0 ? last : first) * cells.line.drift) >> 16;
    const int x = cells.x + (cells.along_x() ? along : across),
              y = cells.y + (cells.along_x() ? across : along);
    float top = highest_at<inside>(x, y);
    if (count > 1)  // of the last cell; the samples of those between lie in the blocks of these two
      top = fast_max(
          top, cells.along_x() ? highest_at<inside>(x, y + count - 1) : highest_at<inside>(x + count - 1, y));
    float to_exceed[count];
    for (int k = 0; k < count; ++k)
      to_exceed[k] = fused(fast_max(steepest[k], start_rise), static_cast<float>(first), cells.base[k]);
    return top + rounding > min_of(to_exceed);
  }

  template <bool inside>
  DESERT_HD float highest_at(int x, int y) const {
    const Grid& g = grid();
    if (!inside) {
      x = g.periodic_x ? wrap(x, g.width) : clamp_index(x, g.width);
      y = g.periodic_y ? wrap(y, g.height) : clamp_index(y, g.height);
    }
    return load_read_only(highest_nearby +
                          (static_cast<unsigned>(y) / side * static_cast<unsigned>(blocks.width) +
                           static_cast<unsigned>(x) / side));
  }
};

/// The march that follows the changing wind direction (`curved`).
struct CurvedShadow {
  Grid grid;
  ShadowFromSlope shadow_from_slope;
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
      const float rise =
          j == 1 ? rise_over_one_cell(x, y, -u / speed, -v / speed)
                 : marching::height_at(grid, heights, marching::SamplePosition(x, y, dx, dy)) - heights[i];
      steepest = maximum(steepest, rise * reciprocals[j]);
      const int there = sample_index(grid, x + nearest_cell(dx), y + nearest_cell(dy));
      u = wind_x[there];
      v = wind_y[there];
    }
    wind_shadow[i] = shadow_from_slope(steepest);
  }

 private:
  DESERT_HD float rise_over_one_cell(int x, int y, float east, float north) const {
    return RiseOverOneCell(east,
                           north)([&](int a, int b) { return heights[sample_index(grid, x + a, y + b)]; });
  }
};

}  // namespace desert_sim::wind_shadow

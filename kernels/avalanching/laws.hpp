#pragma once
/// The per-cell and per-tile laws of avalanching; equations and schemes in avalanching.hpp.

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/math.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim {
namespace avalanching {

/// Rounding could make eight parts of a release exceed it by a few 2⁻²⁴; this keeps them below.
constexpr float rounding_guard = 1.0f - 1.0f / 1048576.0f;

/// How far a donor stands above its neighbour beyond repose [quanta].
DESERT_HD float excess(Quanta donor, Quanta receiver, float repose_drop) {
  return maximum(static_cast<float>(donor - receiver) - repose_drop, 0.0f);
}

/// Share of each excess that is released: A/B_sum with A = min(k_c B_max/(1 + B_max/B_sum), available).
DESERT_HD float release_share(const float (&b)[8], float transfer, float available) {
  const float sum = Neighbours::sum(b);
  const float largest = maximum(maximum(maximum(b[0], b[1]), maximum(b[2], b[3])),
                                maximum(maximum(b[4], b[5]), maximum(b[6], b[7])));
  constexpr float tiny = 1e-20f;
  return minimum(transfer * largest / (sum + largest + tiny), available / (sum + tiny)) * rounding_guard;
}

/// One level of the hierarchy, and the fine grid: sand that can move over ground that can't.
/// Ground at wall_height or above is a wall, and so is an obstacle.
struct LevelView {
  Grid grid;
  const Quanta *ground, *soil;  ///< the ground's top is their sum; without soil null
  const float* obstacle;        ///< or null
  Quanta* sand;
  const float* repose;    ///< tangents
  float quanta_per_cell;  ///< cell size / quantum: a tangent times this is the drop over one cell

  DESERT_HD bool wall(int i) const { return ground[i] >= wall_height || value_or_zero(obstacle, i) > 0.0f; }
  DESERT_HD Quanta ground_top(int i) const { return ground[i] + value_or_zero(soil, i); }
  DESERT_HD Quanta height(int i) const { return wall(i) ? wall_height : ground_top(i) + sand[i]; }
};

/// The terrain as the finest level; `repose` has the tangent of each cell.
inline LevelView finest(const TerrainView& t, const float* repose) {
  return {t.grid,
          t.quanta(Layer::bedrock),
          t.quanta(Layer::soil),
          t.real(Layer::obstacle),
          t.quanta(Layer::sand),
          repose,
          t.grid.cell_size * t.quanta_per_metre};
}

/// What a level knows of a cell; ground at wall_height is a wall.
struct LevelCell {
  Quanta ground, sand;
  float repose;
};

/// The means of four children's ground and sand, and the steepest angle of theirs: the brink of a slip face
/// is no reason for the face below it to slide. A child that is a wall makes a wall.
DESERT_HD LevelCell coarse_cell(const LevelCell (&child)[4]) {
  long long ground = 0, sand = 0;
  bool wall = false;
  float steepest = 0.0f;
  for (int n = 0; n < 4; ++n) {
    wall = wall || child[n].ground >= wall_height;
    ground += child[n].ground;
    sand += child[n].sand;
    steepest = maximum(steepest, child[n].repose);
  }
  return {wall ? wall_height : static_cast<Quanta>(ground >> 2), static_cast<Quanta>(sand >> 2), steepest};
}

/// A coarse level to be filled.
struct LevelOut {
  Grid grid;
  Quanta *ground, *sand, *sand_before;
  float* repose;

  DESERT_HD void put(int x, int y, const LevelCell& cell) const {
    const int i = grid.index(x, y);
    ground[i] = cell.ground;
    sand[i] = sand_before[i] = cell.sand;
    repose[i] = cell.repose;
  }
  /// Of two cells beside each other, where x and the width are even.
  DESERT_HD void put_two(int x, int y, const LevelCell& west, const LevelCell& east) const {
    const int i = grid.index(x, y);
    const Two<Quanta> both{west.sand, east.sand};
    put_beside(ground + i, Two<Quanta>{west.ground, east.ground});
    put_beside(sand + i, both);
    put_beside(sand_before + i, both);
    put_beside(repose + i, Two<float>{west.repose, east.repose});
  }
};

/// Fills one coarse level from the next finer one, and the one after that, if there is one, in the same pass.
struct Restrict {
  LevelView fine;
  LevelOut first, second;  ///< second: with an empty grid if there is none

  /// What a thread fills: two by two cells of the first level, the last ones perhaps not whole.
  DESERT_HD Grid blocks() const { return {(first.grid.width + 1) / 2, (first.grid.height + 1) / 2, 1}; }

  DESERT_HD LevelCell fine_cell(int i) const {
    return {fine.wall(i) ? wall_height : fine.ground_top(i), fine.sand[i], fine.repose[i]};
  }
  /// Four cells in a row, of which the first has an index that is a multiple of four; walls are ground, too.
  DESERT_HD surface::GroundAndSand row_at(int i) const {
    surface::GroundAndSand row{four_at(fine.ground + i), four_at(static_cast<const Quanta*>(fine.sand) + i)};
    if (fine.soil || fine.obstacle)
      for (int n = 0; n < 4; ++n) row.ground.values[n] = fine_cell(i + n).ground;
    return row;
  }

  DESERT_HD void operator()(int x, int y) const {
    if (fine.grid.width % 4 == 0 && first.grid.inside(2 * x + 1, 2 * y + 1)) {
      const int corner = fine.grid.index(4 * x, 4 * y);
      return fill_whole(x, y, [&](int n) { return row_at(corner + n * fine.grid.width); });
    }
    LevelCell filled[4] = {};
    for (int n = 0; n < 4; ++n) {
      const int fx = 2 * x + n % 2, fy = 2 * y + n / 2;
      if (!first.grid.inside(fx, fy)) continue;
      const int i = fine.grid.index(2 * fx, 2 * fy), north = i + fine.grid.width;
      const LevelCell children[4] = {fine_cell(i), fine_cell(i + 1), fine_cell(north), fine_cell(north + 1)};
      filled[n] = coarse_cell(children);
      first.put(fx, fy, filled[n]);
    }
    if (second.grid.inside(x, y)) second.put(x, y, coarse_cell(filled));
  }

  /// Likewise where all of the cells are there and rows of the fine grid begin at multiples of 16 bytes, with
  /// what row_of(n) knows of the nth row of the four.
  template <class RowOf>
  DESERT_HD void fill_whole(int x, int y, const RowOf& row_of) const {
    const int corner = fine.grid.index(4 * x, 4 * y);
    LevelCell filled[4];
    unrolled<2>([&](auto half) DESERT_INLINE {
      const surface::GroundAndSand row[2] = {row_of(2 * half), row_of(2 * half + 1)};
      const Four<float> repose[2] = {four_at(fine.repose + corner + 2 * half * fine.grid.width),
                                     four_at(fine.repose + corner + (2 * half + 1) * fine.grid.width)};
      for (int n = 0; n < 2; ++n) {
        LevelCell children[4];
        for (int k = 0; k < 4; ++k) {
          const int from = 2 * n + k % 2;
          children[k] = {row[k / 2].ground.values[from], row[k / 2].sand.values[from],
                         repose[k / 2].values[from]};
        }
        filled[2 * half + n] = coarse_cell(children);
      }
      first.put_two(2 * x, 2 * y + half, filled[2 * half], filled[2 * half + 1]);
    });
    if (second.grid.width > 0) second.put(x, y, coarse_cell(filled));
  }
};

/// Takes 4·|change| from four children in proportion to their sand; exactly.
inline DESERT_RARE void take_in_proportion(Quanta change, Quanta* sand) {
  long long all = 0;
  for (int n = 0; n < 4; ++n) all += sand[n];
  const long long wanted = -4LL * change;
  long long missing = wanted;
  for (int n = 0; n < 4; ++n) {
    const Quanta part = static_cast<Quanta>(wanted * sand[n] / all);
    sand[n] -= part;
    missing -= part;
  }
  for (int n = 0; n < 4; ++n) {
    const Quanta part = sand[n] < missing ? sand[n] : static_cast<Quanta>(missing);
    sand[n] -= part;
    missing -= part;
  }
}

/// Whether each of four children has enough for a coarse cell's change.
DESERT_HD bool have_enough(Quanta change, Quanta a, Quanta b, Quanta c, Quanta d) {
  const Quanta south = a < b ? a : b, north = c < d ? c : d;
  return (south < north ? south : north) + change >= 0;
}
/// A coarse cell's change handed to its four children: alike, but where one has too little to give, in
/// proportion to their sand. What the four change by is exactly four times the coarse change.
DESERT_HD void hand_down(Quanta change, Quanta& a, Quanta& b, Quanta& c, Quanta& d) {
  if (have_enough(change, a, b, c, d)) {
    a += change, b += change, c += change, d += change;
    return;
  }
  Quanta sand[4] = {a, b, c, d};
  take_in_proportion(change, sand);
  a = sand[0], b = sand[1], c = sand[2], d = sand[3];
}

/// Hands a coarse cell's change down.
struct Prolong {
  Grid coarse;
  const Quanta *sand_after, *sand_before;  ///< null: nothing to hand down
  Grid fine;
  Quanta* sand;

  DESERT_HD Quanta change(int i) const { return sand_after[i] - sand_before[i]; }  ///< of coarse cell i
  DESERT_HD void operator()(int x, int y) const {
    const Quanta by = change(coarse.index(x, y));
    if (by == 0) return;
    const int c = fine.index(2 * x, 2 * y);
    hand_down(by, sand[c], sand[c + 1], sand[c + fine.width], sand[c + fine.width + 1]);
  }
};

/// One synchronous sweep over the whole grid, first half: each cell's share, and what it gives in all.
/// `by_tangent` is Taylor & Keyser's distribution: k_c of the largest drop, in proportion to the tangents.
/// `Level` is LevelView, or what looks like it.
template <class Level>
struct Release {
  Level level;
  float transfer;
  bool by_tangent;
  float* share;
  Quanta* given;

  DESERT_HD static float weight(bool by_tangent, Quanta donor, Quanta receiver, float drop, int k) {
    const float over = excess(donor, receiver, drop * Neighbours::distance(k));
    if (!by_tangent || over <= 0.0f) return over;
    return static_cast<float>(donor - receiver) / Neighbours::distance(k);
  }

  DESERT_HD void operator()(int x, int y) const {
    const Grid& g = level.grid;
    const int i = g.index(x, y);
    share[i] = 0.0f;
    given[i] = 0;
    if (level.wall(i)) return;
    const Quanta h = level.height(i);
    const float drop = level.repose[i] * level.quanta_per_cell;
    float w[8], deepest = 0.0f;
    for (int k = 0; k < 8; ++k) {
      const int j = neighbour_index(g, x + Neighbours::dx(k), y + Neighbours::dy(k));
      w[k] = j >= 0 ? weight(by_tangent, h, level.height(j), drop, k) : 0.0f;
      if (w[k] > 0.0f) deepest = maximum(deepest, static_cast<float>(h - level.height(j)));
    }
    const float available = static_cast<float>(level.sand[i]);
    const float part =
        by_tangent ? minimum(transfer * deepest, available) / (Neighbours::sum(w) + 1e-20f) * rounding_guard
                   : release_share(w, transfer, available);
    Quanta total = 0;
    for (int k = 0; k < 8; ++k) total += static_cast<Quanta>(part * w[k]);
    share[i] = part;
    given[i] = total;
  }
};

/// Second half: what the neighbours give to each cell, less what it gives.
template <class Level>
struct Gather {
  Level level;
  bool by_tangent;
  const float* share;
  const Quanta* given;
  Quanta* received;

  DESERT_HD void operator()(int x, int y) const {
    const Grid& g = level.grid;
    const int i = g.index(x, y);
    const Quanta h = level.height(i);
    Quanta sum = 0;
    for (int k = 0; k < 8; ++k) {
      const int j = neighbour_index(g, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0 || share[j] <= 0.0f) continue;
      sum +=
          static_cast<Quanta>(share[j] * Release<Level>::weight(by_tangent, level.height(j), h,
                                                                level.repose[j] * level.quanta_per_cell, k));
    }
    received[i] = sum;
  }
};

struct ApplySweep {
  Grid grid;
  const Quanta *given, *received;
  Quanta* sand;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += received[i] - given[i];
  }
};

/// Largest excess of a cell over its own repose, as a tangent, that its sand could still slide off.
struct Excess {
  LevelView level;

  DESERT_HD float operator()(int x, int y) const {
    const Grid& g = level.grid;
    const int i = g.index(x, y);
    if (level.wall(i) || level.sand[i] <= 0) return 0.0f;
    const Quanta h = level.height(i);
    const float drop = level.repose[i] * level.quanta_per_cell, sand = static_cast<float>(level.sand[i]);
    float largest = 0.0f;
    for (int k = 0; k < 8; ++k) {
      const int j = neighbour_index(g, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0) continue;
      const float over = minimum(excess(h, level.height(j), drop * Neighbours::distance(k)), sand);
      largest = maximum(largest, over / (Neighbours::distance(k) * level.quanta_per_cell));
    }
    return largest;
  }
};

}  // namespace avalanching
}  // namespace desert_sim

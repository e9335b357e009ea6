#pragma once
/// Laws of avalanching: synchronous sweeps cell by cell, and the transfer between levels (restriction and
/// prolongation). Equations and schemes are in avalanching.hpp.

#include "kernels/avalanching/quads.hpp"
#include "kernels/backend/for_each.hpp"
#include "kernels/backend/vec4.hpp"
#include "kernels/base/math.hpp"
#include "kernels/field/layers.hpp"
#include "kernels/field/surface_laws.hpp"

namespace desert_sim {
namespace avalanching {

/// Rounding could make the eight parts of a release exceed it by a few 2⁻²⁴ of it; this factor keeps their
/// sum below.
constexpr float rounding_guard = 1.0f - 1.0f / 1048576.0f;

/// B_ij: how far a donor stands above its neighbour beyond the drop at repose [quanta].
DESERT_HD float excess(Quanta donor, Quanta receiver, float repose_drop) {
  return maximum(static_cast<float>(donor - receiver) - repose_drop, 0.0f);
}

/// A/B_sum, the share of each excess that is released, with A = min(k_c B_max/(1 + B_max/B_sum), available).
/// `transfer` is k_c.
DESERT_HD float release_share(const float (&b)[8], float transfer, float available) {
  const float sum = Neighbours::sum(b);
  const float largest = maximum(maximum(maximum(b[0], b[1]), maximum(b[2], b[3])),
                                maximum(maximum(b[4], b[5]), maximum(b[6], b[7])));
  constexpr float tiny = 1e-20f;
  return minimum(transfer * largest / (sum + largest + tiny), available / (sum + tiny)) * rounding_guard;
}

/// One level of the hierarchy, or the fine grid: mobile sand on ground that does not move. Cells whose ground
/// is at wall_height or above are walls, and so are obstacles.
struct LevelView {
  Grid grid;
  const Quanta *ground, *soil;  ///< the top of the ground is their sum; soil may be null
  const float* obstacle;        ///< or null
  Quanta* sand;
  const float* repose;    ///< tangent of the angle of repose
  float quanta_per_cell;  ///< cell size / quantum; times a tangent: drop over one cell

  DESERT_HD bool wall(int i) const { return ground[i] >= wall_height || value_or_zero(obstacle, i) > 0.0f; }
  DESERT_HD Quanta ground_top(int i) const { return ground[i] + value_or_zero(soil, i); }
  DESERT_HD Quanta height(int i) const { return wall(i) ? wall_height : ground_top(i) + sand[i]; }
};

/// The terrain as the finest level; `repose` has the tangent of each cell's angle of repose.
inline LevelView finest_level(const TerrainView& t, const float* repose) {
  return {t.grid,
          t.quanta(Layer::bedrock),
          t.quanta(Layer::soil),
          t.real(Layer::obstacle),
          t.quanta(Layer::sand),
          repose,
          t.grid.cell_size * t.quanta_per_metre};
}

/// One cell of a level; ground at wall_height marks a wall.
struct LevelCell {
  Quanta ground, sand;
  float repose;
};

/// Restricts four children to one coarse cell: the means of their ground and sand, and the steepest of their
/// angles of repose, because the lower angle at the brink of a slip face must not make the face below it
/// slide. If one child is a wall, the coarse cell is a wall.
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

/// The buffers of a coarse level that is to be filled.
struct LevelBuffers {
  Grid grid;
  Quanta *ground, *sand, *sand_before;
  float* repose;

  DESERT_HD void store(int x, int y, const LevelCell& cell) const {
    const int i = grid.index(x, y);
    ground[i] = cell.ground;
    sand[i] = sand_before[i] = cell.sand;
    repose[i] = cell.repose;
  }
  /// Writes two cells beside each other at once; x and the width of the grid must be even.
  DESERT_HD void store_two(int x, int y, const LevelCell& west, const LevelCell& east) const {
    const int i = grid.index(x, y);
    const Vec2<Quanta> both{west.sand, east.sand};
    store_vec(ground + i, Vec2<Quanta>{west.ground, east.ground});
    store_vec(sand + i, both);
    store_vec(sand_before + i, both);
    store_vec(repose + i, Vec2<float>{west.repose, east.repose});
  }
};

/// Restriction: fills one coarse level from the next finer one and, if there is one, the level after it in
/// the same pass over memory.
struct Restrict {
  LevelView fine;
  LevelBuffers first, second;  ///< second: its grid is empty if there is none

  /// One call fills two by two cells of the first level; blocks at the far edges may be incomplete.
  DESERT_HD Grid blocks() const { return {(first.grid.width + 1) / 2, (first.grid.height + 1) / 2, 1}; }

  DESERT_HD LevelCell fine_cell(int i) const {
    return {fine.wall(i) ? wall_height : fine.ground_top(i), fine.sand[i], fine.repose[i]};
  }
  /// Ground and sand of four cells in a row; the index of the first must be a multiple of four. Walls are
  /// part of the ground.
  DESERT_HD surface::GroundAndSand row_at(int i) const {
    surface::GroundAndSand row{load_vec4(fine.ground + i),
                               load_vec4(static_cast<const Quanta*>(fine.sand) + i)};
    if (fine.soil || fine.obstacle)
      for (int n = 0; n < 4; ++n) row.ground.values[n] = fine_cell(i + n).ground;
    return row;
  }

  DESERT_HD void operator()(int x, int y) const {
    if (fine.grid.width % 4 == 0 && first.grid.inside(2 * x + 1, 2 * y + 1)) {
      const int corner = fine.grid.index(4 * x, 4 * y);
      return fill_complete_block(x, y, [&](int n) { return row_at(corner + n * fine.grid.width); });
    }
    LevelCell filled[4] = {};
    for (int n = 0; n < 4; ++n) {
      const int fx = 2 * x + n % 2, fy = 2 * y + n / 2;
      if (!first.grid.inside(fx, fy)) continue;
      const int i = fine.grid.index(2 * fx, 2 * fy), north = i + fine.grid.width;
      const LevelCell children[4] = {fine_cell(i), fine_cell(i + 1), fine_cell(north), fine_cell(north + 1)};
      filled[n] = coarse_cell(children);
      first.store(fx, fy, filled[n]);
    }
    if (second.grid.inside(x, y)) second.store(x, y, coarse_cell(filled));
  }

  /// Fills a block whose cells all exist, on a grid whose rows begin at multiples of 16 bytes. row_of(n)
  /// gives ground and sand of the nth of its four rows of fine cells.
  template <class RowOf>
  DESERT_HD void fill_complete_block(int x, int y, const RowOf& row_of) const {
    const int corner = fine.grid.index(4 * x, 4 * y);
    LevelCell filled[4];
    unrolled<2>([&](auto half) DESERT_INLINE {
      const surface::GroundAndSand row[2] = {row_of(2 * half), row_of(2 * half + 1)};
      const Vec4<float> repose[2] = {load_vec4(fine.repose + corner + 2 * half * fine.grid.width),
                                     load_vec4(fine.repose + corner + (2 * half + 1) * fine.grid.width)};
      for (int n = 0; n < 2; ++n) {
        LevelCell children[4];
        for (int k = 0; k < 4; ++k) {
          const int from = 2 * n + k % 2;
          children[k] = {row[k / 2].ground.values[from], row[k / 2].sand.values[from],
                         repose[k / 2].values[from]};
        }
        filled[2 * half + n] = coarse_cell(children);
      }
      first.store_two(2 * x, 2 * y + half, filled[2 * half], filled[2 * half + 1]);
    });
    if (second.grid.width > 0) second.store(x, y, coarse_cell(filled));
  }
};

/// Takes exactly 4·|change| from four children in proportion to their sand. What rounding leaves over is
/// taken from the first children that still have sand.
inline DESERT_NOINLINE void remove_in_proportion(Quanta change, Quanta* sand) {
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

/// Whether each of four children has enough sand for a coarse cell's change.
DESERT_HD bool have_enough_sand(Quanta change, Quanta a, Quanta b, Quanta c, Quanta d) {
  const Quanta south = a < b ? a : b, north = c < d ? c : d;
  return (south < north ? south : north) + change >= 0;
}
/// Prolongs a coarse cell's change to its four children: by the same amount to each, or, where one of them
/// has too little sand to give, in proportion to their sand. The four together change by exactly four times
/// the coarse change.
DESERT_HD void prolong_change(Quanta change, Quanta& a, Quanta& b, Quanta& c, Quanta& d) {
  if (have_enough_sand(change, a, b, c, d)) {
    a += change, b += change, c += change, d += change;
    return;
  }
  Quanta sand[4] = {a, b, c, d};
  remove_in_proportion(change, sand);
  a = sand[0], b = sand[1], c = sand[2], d = sand[3];
}

/// Prolongation: adds the change of each coarse cell to its four children.
struct Prolong {
  Grid coarse;
  const Quanta *sand_after, *sand_before;  ///< null: nothing to prolong
  Grid fine;
  Quanta* sand;

  DESERT_HD Quanta change(int i) const { return sand_after[i] - sand_before[i]; }  ///< of coarse cell i
  DESERT_HD void operator()(int x, int y) const {
    const Quanta by = change(coarse.index(x, y));
    if (by == 0) return;
    const int c = fine.index(2 * x, 2 * y);
    prolong_change(by, sand[c], sand[c + 1], sand[c + fine.width], sand[c + fine.width + 1]);
  }
};

/// First half of a synchronous sweep over the whole grid: the share of its excesses that each cell releases,
/// and the sum of what it gives. `by_tangent` selects the distribution of Taylor & Keyser: k_c of the largest
/// drop, in proportion to the tangents. `Level` is LevelView or a type with the same interface; `inside`: no
/// neighbour lies over an edge.
template <class Level, bool inside>
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
      const int j = neighbour<inside>(g, x, y, k);
      w[k] = j >= 0 ? weight(by_tangent, h, level.height(j), drop, k) : 0.0f;
      if (w[k] > 0.0f) deepest = maximum(deepest, static_cast<float>(h - level.height(j)));
    }
    if (!(deepest > 0.0f)) return;
    const float available = static_cast<float>(level.sand[i]);
    const float part =
        by_tangent ? minimum(transfer * deepest, available) / (Neighbours::sum(w) + 1e-20f) * rounding_guard
                   : release_share(w, transfer, available);
    Quanta total = 0;
    for (int k = 0; k < 8; ++k) total += static_cast<Quanta>(part * w[k]);
    share[i] = total > 0 ? part : 0.0f;
    given[i] = total;
  }
};

/// Second half: the sum of what each cell receives from its neighbours.
template <class Level, bool inside>
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
      const int j = neighbour<inside>(g, x, y, k);
      if (j < 0 || share[j] <= 0.0f) continue;
      const float drop = level.repose[j] * level.quanta_per_cell;
      sum += static_cast<Quanta>(share[j] *
                                 Release<Level, inside>::weight(by_tangent, level.height(j), h, drop, k));
    }
    received[i] = sum;
  }
};

/// Both halves: what each cell gives, and what it receives.
template <class E, class Level>
void give_and_receive(E& exec, const Level& level, float transfer, bool by_tangent, float* share,
                      Quanta* given, Quanta* received) {
  constexpr int reach = 1;
  for_each_cell(
      exec, level.grid,
      Bordered<Release<Level, true>, Release<Level, false>>{level.grid,
                                                            reach,
                                                            {level, transfer, by_tangent, share, given},
                                                            {level, transfer, by_tangent, share, given}});
  for_each_cell(
      exec, level.grid,
      Bordered<Gather<Level, true>, Gather<Level, false>>{level.grid,
                                                          reach,
                                                          {level, by_tangent, share, given, received},
                                                          {level, by_tangent, share, given, received}});
}

struct ApplySweep {
  Grid grid;
  const Quanta *given, *received;
  Quanta* sand;
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] += received[i] - given[i];
  }
};

/// Largest excess of a cell over its neighbours beyond its own angle of repose, as a tangent, no larger than
/// the cell's sand allows.
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

/// The same for scheme `gradient`: the largest slide, as a tangent, that is left in the quad whose south-west
/// cell is (x, y), or along its straight pairs if one of its cells is a wall.
struct QuadExcess {
  LevelView level;

  DESERT_HD float operator()(int x, int y) const {
    const Grid& g = level.grid;
    int cell[4];
    bool walls = false;
    for (int n = 0; n < 4; ++n) {
      cell[n] = neighbour_index(g, x + n % 2, y + n / 2);
      walls = walls || cell[n] < 0 || level.wall(cell[n]);
    }
    return (walls ? of_straight_pairs(cell) : of_quad(cell)) / level.quanta_per_cell;
  }

 private:
  DESERT_HD float of_quad(const int (&cell)[4]) const {
    float h[4], sand[4], repose = 0.0f;  // heights above the first cell
    for (int n = 0; n < 4; ++n) {
      h[n] = static_cast<float>(level.height(cell[n]) - level.height(cell[0]));
      sand[n] = static_cast<float>(level.sand[cell[n]]);
      repose += level.repose[cell[n]];
    }
    const Quad quad{h[0] - h[3], h[1] - h[2], (h[0] - h[1]) - (h[2] - h[3]), sand[0], sand[1],
                    sand[2],     sand[3]};
    const auto share = SlidingShares::of<false>(quad, repose * level.quanta_per_cell, 0.0f);
    QuadSlides slides{share.p * quad.p, share.q * quad.q, share.t * quad.t};
    slides.limit(h[0], h[1], h[2], h[3], quad);
    return maximum(maximum(fabsf(slides.p), fabsf(slides.q)), fabsf(slides.t));
  }
  DESERT_HD float of_straight_pairs(const int (&cell)[4]) const {
    return maximum(maximum(of_pair(cell[0], cell[1]), of_pair(cell[2], cell[3])),
                   maximum(of_pair(cell[0], cell[2]), of_pair(cell[1], cell[3])));
  }
  DESERT_HD float of_pair(int i, int j) const {
    if (i < 0 || j < 0 || level.wall(i) || level.wall(j)) return 0.0f;
    const Quanta h_i = level.height(i), h_j = level.height(j);
    const int donor = h_i > h_j ? i : j;
    const float over =
        excess(h_i > h_j ? h_i : h_j, h_i > h_j ? h_j : h_i, level.repose[donor] * level.quanta_per_cell);
    return minimum(over, static_cast<float>(level.sand[donor]));
  }
};

}  // namespace avalanching
}  // namespace desert_sim

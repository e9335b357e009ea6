#pragma once
/// Relaxation of one tile of 32 × 32 cells by sweeps over pairs of neighbours. Tiles are closed: nothing
/// crosses a tile's edge, so that tiles do not depend on each other. Obstacles, and cells beyond the grid,
/// stand in a tile as walls: too high to receive sand, and with an angle of repose so steep that they give
/// none.
///
/// A sweep relaxes the pairs (patch.hpp) or quads (quads.hpp) of all patches of 4 × 4 cells in the tile. From
/// sweep to sweep the patches shift by one cell to the east and to the south, so that over four sweeps all
/// cells are treated alike:
///
///        . . . . . .
///        . 0 . . . .     a corner of the patches in sweeps 0, 1, 2, 3, after which
///        . . 1 . . .     the sequence repeats; every other pass begins with sweep 2
///        . . . 2 . .
///        . . . . 3 .
///
/// Patches that are shifted out of the tile on one side re-enter on the other; nothing slides between their
/// two parts. Two successive sweeps together cover all pairs of neighbours, except diagonal ones that cross
/// an edge of a patch in both.
///
/// A tile takes at least `sweeps` sweeps, unless two successive ones move nothing, and goes on, up to
/// `max_sweeps_while_sliding`, while a pair moves more than `continue_threshold`. A tile whose relief is less
/// than the drop at repose from any of its cells to the next takes none.
///
/// Heights are floats that count whole units (tile_units.hpp). This law is the reference; on a GPU
/// tuned/tile.cu gives the same bits faster.

#include <type_traits>

#include "kernels/avalanching/laws.hpp"
#include "kernels/avalanching/patch.hpp"
#include "kernels/avalanching/quads.hpp"
#include "kernels/avalanching/tile_units.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::avalanching {

/// A tile in which much sand still slides takes up to this many sweeps.
constexpr int max_sweeps_while_sliding = 8;

/// Shift of a sweep's patches to the east and to the north [cells].
struct PatchShift {
  int x, y;
  bool transposed;  ///< whether quads are relaxed in transposed order (quads.hpp)

  /// `n`: the shift to the east, modulo the side of a patch.
  DESERT_HD constexpr PatchShift(int n, bool transposes_quads)
      : x(n & (Patch::side - 1)), y((Patch::side - x) & (Patch::side - 1)), transposed(transposes_quads) {
    static_assert(Patch::side == 4);
  }
};

/// The share ω of an excess that slides across the nth gap between columns, or between rows, of a tile. Gap n
/// lies behind column n. Numbers continue beyond the tile's edge, because patches that are shifted over it
/// re-enter on the other side; the gap at the edge itself is closed.
class GapOmega {
 public:
  /// `next_to_edge`: ω of the first and the last gap. Sand that cannot cross the edge piles up before it and
  /// is missing behind it; if less slides across the gap before the edge, this is spread over more cells.
  GapOmega(float inside, float next_to_edge)
      : inside_(with_odd_mantissa(inside)), next_to_edge_(with_odd_mantissa(next_to_edge)) {}

  DESERT_HD float operator()(int n) const {
    const int gap = n % Tiles::side;
    const float share = gap == 0 || gap == Tiles::side - 2 ? next_to_edge_ : inside_;
    return gap == Tiles::side - 1 ? closed_gap : share;
  }

 private:
  float inside_, next_to_edge_;
};

/// Lowest and highest surface, and highest ground, of the cells of a tile that are not walls [quanta].
struct Range {
  Quanta lowest, highest;
  Quanta highest_ground;
  /// Whether the ground nowhere reaches above the lowest cell; then pairs need not limit slides (patch.hpp).
  DESERT_HD bool deep() const { return highest_ground <= lowest; }
};

struct RelaxTile {
  static constexpr int side = Tiles::side, patches = side / Patch::side;  ///< along an axis
  /// Cells of a row are stored by their column within a patch: cells 0, 4, 8 … first, then cells 1, 5, 9 …
  /// and so on, each group followed by a copy of its first cell. The same column of neighbouring patches is
  /// then contiguous and can be loaded as a vector, also where patches are shifted over the tile's edge.
  static constexpr int column_stride = patches + 4, stride = Patch::side * column_stride,
                       cells = side * stride;

  Tiles tiles;
  LevelView level;
  Prolong from_coarse;  ///< prolonged first; children of a coarse cell lie in one tile
  GapOmega share;       ///< ω (patch.hpp), in (0, 1]
  int sweeps;
  float continue_threshold;              ///< [cell sizes]
  const Quanta* active_flags = nullptr;  ///< flags, 0 for tiles to skip; null: relax all
  bool by_gradient = false;              ///< quads in place of pairs
  /// Of the patches, in the first sweep; each further one shifts them by one more. Every other sweep relaxes
  /// transposed quads.
  int first_shift = 0;

  DESERT_HD bool is_skipped(int column, int row) const {
    return active_flags && active_flags[row * tiles.columns() + column] == 0;
  }

  /// Whether the tile may stop after `done` sweeps; `moved_much`: the last one has moved more than
  /// `continue_threshold`.
  DESERT_HD bool may_stop(int done, bool moved_much) const {
    return done >= sweeps && (done >= max_sweeps_while_sliding || !moved_much);
  }

  /// What one sweep has moved: `much` where a pair moved more than `continue_threshold`.
  enum class Moved { nothing, little, much };
  /// The loop of sweeps over a tile, for every backend: sweeps until two in a row move nothing, or until the
  /// tile may stop. `sweep(n, shift)` does the nth sweep. Returns whether anything moved.
  template <class Sweep>
  DESERT_HD bool relax(const Sweep& sweep) const {
    bool moved = false, moved_before = true;
    for (int n = 0;; ++n) {
      const Moved now = sweep(n, PatchShift(first_shift + n, (first_shift / 2 + n) % 2 != 0));
      const bool moves = now != Moved::nothing;
      moved = moved || moves;
      if (!moves && !moved_before) break;
      if (may_stop(n + 1, now == Moved::much)) break;
      moved_before = moves;
    }
    return moved;
  }

  template <class Team>
  static constexpr int scratch_bytes = 4 * cells * 4;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row) const {
    if (is_skipped(column, row)) return;
    float* h = reinterpret_cast<float*>(team.scratch);
    float *ground = h + cells, *drop = ground + cells;
    Quanta* base = reinterpret_cast<Quanta*>(drop + cells);
    clear(team, h, ground, drop);
    if (from_coarse.sand_after)
      team.for_each(sibling_groups, [=](int n) DESERT_INLINE { prolong_coarse_cell(column, row, n); });
    const Range range = load_heights(team, column, row, h, ground);
    if (range.lowest >= wall_height) return;
    const Units units(range.lowest, range.highest, level.quanta_per_cell);
    load(team, column, row, units, h, ground, drop, base);
    // √3 is the most by which the gradient of a quad exceeds its relief.
    const float steepest = (units.height(range.highest) - Units::floor) * (by_gradient ? 1.7320509f : 1.0f);
    if (steepest <= least(team, drop)) return;
    const float threshold = units.drop(continue_threshold, level.quanta_per_cell);
    const bool walls = by_gradient && has_walls(team, drop);
    const bool moved = relax([&](int, const PatchShift& shift) DESERT_INLINE {
      const float max_moved = by_gradient
                                  ? (range.deep() ? sweep<true, true>(team, shift, h, ground, drop, walls)
                                                  : sweep<false, true>(team, shift, h, ground, drop, walls))
                                  : (range.deep() ? sweep<true, false>(team, shift, h, ground, drop)
                                                  : sweep<false, false>(team, shift, h, ground, drop));
      return max_moved > threshold ? Moved::much : (max_moved > 0.0f ? Moved::little : Moved::nothing);
    });
    if (moved) store(team, column, row, units, h, base);
  }

  static constexpr int sibling_groups = side / 2 * (side / 2);
  /// Prolongs the change of the tile's nth coarse cell, if that exists, to its children.
  DESERT_HD void prolong_coarse_cell(int column, int row, int n) const {
    const int x = grid_x(column, 2 * (n % (side / 2))), y = grid_y(row, 2 * (n / (side / 2)));
    if (x >= 0 && y >= 0 && from_coarse.coarse.inside(x / 2, y / 2)) from_coarse(x / 2, y / 2);
  }

  /// The column of the grid at column x of the tile, or −1 if there is none; grid_y() gives the row. On a
  /// periodic axis each cell of the grid belongs to exactly one tile.
  DESERT_HD int grid_x(int column, int x) const {
    return along(column * side - tiles.offset + x, level.grid.width, level.grid.periodic_x);
  }
  DESERT_HD int grid_y(int row, int y) const {
    return along(row * side - tiles.offset + y, level.grid.height, level.grid.periodic_y);
  }

  /// Whether all cells of the tile exist and its rows are contiguous in the grid.
  DESERT_HD bool is_contiguous(int column, int row) const {
    const int x = column * side - tiles.offset, y = row * side - tiles.offset;
    const int right = level.grid.width - (level.grid.periodic_x ? tiles.offset : 0);
    const int top = level.grid.height - (level.grid.periodic_y ? tiles.offset : 0);
    return x >= 0 && y >= 0 && x + side <= right && y + side <= top;
  }

 private:
  DESERT_HD int along(int p, int cells_along, bool periodic) const {
    if (p >= (periodic ? cells_along - tiles.offset : cells_along)) return -1;
    return p >= 0 ? p : (periodic ? wrap(p, cells_along) : -1);
  }

  /// Index of the cell in row y, in column k of the nth patch.
  DESERT_HD static constexpr int local(int y, int n, int k) { return y * stride + k * column_stride + n; }

  /// Index of a cell of a patch in row `patch_row` of patches, the first one being patch `first`.
  struct At {
    PatchShift shift;
    int patch_row, first;
    bool transposed;  ///< `row` and `column` are exchanged
    DESERT_HD int operator()(int patch_y, int patch_x) const {
      const int row = transposed ? patch_x : patch_y, column = transposed ? patch_y : patch_x;
      const int y = (patch_row * Patch::side + shift.y + row) % side, x = shift.x + column;
      return local(y, first + x / Patch::side, x % Patch::side);
    }
  };

  /// One sweep over all pairs, or quads. `walls`: whether the tile has any; for quads. Returns the largest
  /// amount that one has moved.
  template <bool deep, bool quads, class Team>
  DESERT_HD float sweep(const Team& team, const PatchShift& shift, float* h, const float* ground,
                        const float* drop, bool walls = false) const {
    const GapOmega omega = share;
    const auto copy_first = [=](int from, int to) DESERT_INLINE {
      team.for_each(side, [=](int y) DESERT_INLINE {
        for (int k = 0; k < shift.x; ++k) h[local(y, to, k)] = h[local(y, from, k)];
      });
    };
    copy_first(0, patches);
    const float max_moved = team.max_of(patches * patches / Team::patch_lanes, [=](int i) DESERT_INLINE {
      constexpr int lanes = Team::patch_lanes, vectors = patches / lanes;
      const int patch_row = i / vectors, first = i % vectors * lanes;
      const bool transposed = quads && shift.transposed;
      const At at{shift, patch_row, first, transposed};
      Shares<lanes> shares;
      float max_moved_by_patch[lanes] = {};
      for (int k = 0; k + 1 < Patch::side; ++k) {
        shares.y[k] = omega(patch_row * Patch::side + shift.y + k);
        for (int n = 0; n < lanes; ++n) shares.x[k][n] = omega((first + n) * Patch::side + shift.x + k);
      }
      if constexpr (quads)
        QuadsOfPatches<lanes, deep, At>{
            h, ground, drop, at, QuadShares<lanes>(shares, transposed), max_moved_by_patch, walls}
            .relax();
      else
        PairsOfPatches<lanes, deep, At>{h, ground, drop, at, shares, max_moved_by_patch}.relax();
      float max_moved_here = 0.0f;
      for (int n = 0; n < lanes; ++n) max_moved_here = fast_max(max_moved_here, max_moved_by_patch[n]);
      return max_moved_here;
    });
    copy_first(patches, 0);
    return max_moved;
  }

  struct Nothing {
    DESERT_HD void operator()(int) const {}
  };
  /// Calls body(i, n) for each cell of the tile that exists, with its index in the grid and in the tile. If
  /// the tile's rows are contiguous, before_row(i) is called with the first cell of each.
  template <class Team, class Body, class BeforeRow = Nothing>
  DESERT_HD void for_each_cell_of_tile(const Team& team, int column, int row, const Body& body,
                                       const BeforeRow& before_row = {}) const {
    const int width = level.grid.width;
    const int corner = (row * side - tiles.offset) * width + column * side - tiles.offset;
    const bool contiguous = is_contiguous(column, row);
    team.for_each_row([=](int y) DESERT_INLINE {
      const int first = corner + y * width;
      if (contiguous) before_row(first);
      if (contiguous)
        team.template for_each_in_row<Patch::side>(
            [=](int n, auto k) DESERT_INLINE { body(first + n * Patch::side + k, local(y, n, k)); });
      else
        team.template for_each_in_row<Patch::side>([=](int n, auto k) DESERT_INLINE {
          const int cell_x = grid_x(column, n * Patch::side + k), cell_y = grid_y(row, y);
          if (cell_x >= 0 && cell_y >= 0) body(cell_y * width + cell_x, local(y, n, k));
        });
    });
  }

  /// Fills the tile with walls.
  template <class Team>
  DESERT_HD static void clear(const Team& team, float* h, float* ground, float* drop) {
    team.for_each(cells, [=](int n) DESERT_INLINE {
      h[n] = float_from_bits(static_cast<std::uint32_t>(wall_height));
      ground[n] = Units::wall;
      drop[n] = Units::wall;
    });
  }

  /// Loads heights and ground, and returns their range. `h` and `ground` hold the bits of integers until
  /// load() converts them to units.
  template <class Team>
  DESERT_HD Range load_heights(const Team& team, int column, int row, float* h, float* ground) const {
    const LevelView from = level;
    for_each_cell_of_tile(
        team, column, row,
        [=](int i, int n) DESERT_INLINE {
          const Quanta height = from.height(i);
          h[n] = float_from_bits(static_cast<std::uint32_t>(height));
          ground[n] = float_from_bits(static_cast<std::uint32_t>(height - from.sand[i]));
        },
        [=](int first) DESERT_INLINE { team.fetch_ahead(from.repose + first, side); });
    const auto height = [=](int n) DESERT_INLINE { return static_cast<Quanta>(bits_of(h[n])); };
    const auto below = [=](int n, const float* of) DESERT_INLINE {
      return height(n) < wall_height ? -static_cast<Quanta>(bits_of(of[n])) : wall_height;
    };
    return {team.min_of(cells, height), -team.min_of(cells, [=](int n) DESERT_INLINE { return below(n, h); }),
            -team.min_of(cells, [=](int n) DESERT_INLINE { return below(n, ground); })};
  }

  /// Converts the tile to units. `base` gets the part of each cell's sand that does not change with its
  /// height.
  template <class Team>
  DESERT_HD void load(const Team& team, int column, int row, const Units& units, float* h, float* ground,
                      float* drop, Quanta* base) const {
    const LevelView from = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      const Quanta read = static_cast<Quanta>(bits_of(h[n])), sand = from.sand[i];
      const bool wall = read >= wall_height;
      // Of walls, too, without branches, so that the loop becomes vectors.
      const Quanta height = wall ? units.lowest : read;
      const float drop_here = units.drop(from.repose[i], from.quanta_per_cell),
                  height_here = units.height(height), ground_here = units.ground(height, sand);
      h[n] = wall ? Units::wall : height_here;
      ground[n] = wall ? Units::wall : ground_here;
      drop[n] = wall ? Units::wall : drop_here;
      base[n] = difference_modulo(sand, units.of_height(h[n]));
    });
    // Where there is no cell, too. All ground but that of walls is lower than the height.
    team.for_each(cells, [=](int n) DESERT_INLINE { h[n] = fast_max(h[n], ground[n]); });
    // Copies of the first cells of each row at its end.
    team.for_each(side * Patch::side, [=](int i) DESERT_INLINE {
      const int y = i / Patch::side, k = i % Patch::side;
      ground[local(y, patches, k)] = ground[local(y, 0, k)];
      drop[local(y, patches, k)] = drop[local(y, 0, k)];
    });
  }

  /// The least of a tile's values, which are positive: their bits are in the same order.
  template <class Team>
  DESERT_HD static float least(const Team& team, const float* of) {
    return float_from_bits(static_cast<std::uint32_t>(
        team.min_of(cells, [=](int n) DESERT_INLINE { return static_cast<int>(bits_of(of[n])); })));
  }

  /// Whether any cell of a tile with these drops is a wall: theirs is the greatest there is. What lies
  /// between the groups of columns is no cell.
  template <class Team>
  DESERT_HD static bool has_walls(const Team& team, const float* drop) {
    const auto bits = [](float value) DESERT_INLINE { return static_cast<int>(bits_of(value)); };
    const auto below = [=](int n, int group) DESERT_INLINE { return -bits(drop[group * column_stride + n]); };
    return team.min_of(patches, side * Patch::side, below) <= -bits(Units::wall);
  }

  template <class Team>
  DESERT_HD void store(const Team& team, int column, int row, const Units& units, const float* h,
                       const Quanta* base) const {
    Quanta* sand = level.sand;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      sand[i] = sum_modulo(base[n], units.of_height(h[n]));
    });
  }
};

/// Relaxes all tiles by calling RelaxTile for each.
template <class E>
void relax_tiles_reference(E& exec, const RelaxTile& law);

/// Laws that may follow a pass: none, restriction to coarse levels, or measuring the heights.
/// follow_up_grid() gives the grid that the latter two are called for.
struct NoFollowUp {};
inline Grid follow_up_grid(const Restrict& law) { return law.blocks(); }
inline Grid follow_up_grid(const surface::ComputeBlockHeights& law) { return law.blocks; }

/// Relaxes all tiles in the fastest way that the backend has, and then applies `then`, in the same kernel if
/// possible. `Then` is one of the three laws above.
template <class E, class Then>
void relax_tiles(E& exec, const RelaxTile& law, const Then& then);

}  // namespace desert_sim::avalanching

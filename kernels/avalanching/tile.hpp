#pragma once
/// Sweeps inside one closed tile: nothing crosses its edge, so tiles do not see each other. What is around
/// the tile, obstacles, and what lies beyond the grid, stand in it as walls: too high for anything to slide
/// there, and so steep at rest that nothing slides from there.
///
/// A sweep goes through the pairs of all patches of the tile (avalanching_patch.hpp). In each of four sweeps
/// these begin a cell further east and south, so that all cells are alike to them:
///
// clang-format off
///      . . . . . .
///      . 0 . . . .     a corner of the patches in sweeps 0, 1, 2, 3, and then again;
///      . . 1 . . .     every other pass begins with sweep 2
///      . . . 2 . .
///      . . . . 3 .
// clang-format on
///
/// What is shifted out of the tile on one side comes in on the other, where nothing slides over the edge.
/// Two sweeps that follow each other have all pairs between them, but for diagonal ones across an edge of
/// each.
///
/// A tile takes `sweeps` sweeps, unless two that follow each other move nothing, and goes on, up to
/// `most_sweeps`, while a pair moves `plenty`.
///
/// Heights are floats that count whole units (avalanching_units.hpp). This is the reference; on a GPU
/// tuned/avalanching_tile.cu gives the same bits sooner.

#include <type_traits>

#include "kernels/avalanching/laws.hpp"
#include "kernels/avalanching/patch.hpp"
#include "kernels/avalanching/tile_units.hpp"
#include "kernels/field/surface.hpp"

namespace desert_sim::avalanching {

/// Sweeps up to which a tile goes on where much slides.
constexpr int most_sweeps = 8;

/// How far the patches of a sweep are shifted, to the east and to the north [cells].
struct PatchShift {
  int x, y;

  /// Of the nth sweep of a pass whose tiles begin at −offset. Tiles of passes that follow each other lie 16
  /// cells apart (seam_offsets in avalanching.hpp).
  DESERT_HD PatchShift(int n, int offset) : PatchShift(n + offset / 16 * 2) {}
  DESERT_HD explicit constexpr PatchShift(int n)
      : x(n & (Patch::side - 1)), y((Patch::side - x) & (Patch::side - 1)) {
    static_assert(Patch::side == 4);
  }
};

/// The share ω of an excess that slides over the nth gap between a tile's columns, or between its rows,
/// counted over its edge: what is shifted out of the tile on one side comes in on the other, but nothing
/// slides there.
class ShareOfGap {
 public:
  /// `next_to_edge`: what cannot go on over the edge piles up before it, and is missing behind it; where less
  /// slides to the last cells, that is spread over more of them.
  ShareOfGap(float inside, float next_to_edge)
      : inside_(never_halfway(inside)), next_to_edge_(never_halfway(next_to_edge)) {}

  DESERT_HD float operator()(int n) const {
    const int gap = n % Tiles::side;
    const float share = gap == 0 || gap == Tiles::side - 2 ? next_to_edge_ : inside_;
    return gap == Tiles::side - 1 ? 0.0f : share;
  }

 private:
  float inside_, next_to_edge_;
};

/// Of the cells of a tile, but walls [quanta].
struct Range {
  Quanta lowest, highest;
  Quanta highest_ground;
  /// avalanching_patch.hpp
  DESERT_HD bool deep() const { return highest_ground <= lowest; }
};

struct RelaxTile {
  static constexpr int side = Tiles::side, patches = side / Patch::side;  ///< along an axis
  /// A row of cells lies in memory as four of patches' columns, each with the tile's first cell again at its
  /// end: then patches beside each other are a vector, also where they are shifted over the edge.
  static constexpr int column_stride = patches + 4, stride = Patch::side * column_stride,
                       cells = side * stride;

  Tiles tiles;
  LevelView level;
  Prolong from_coarse;  ///< what the tile's cells get first; their families lie in one tile
  ShareOfGap share;     ///< ω (avalanching_patch.hpp), in (0, 1]
  int sweeps;
  float plenty;                  ///< [cell sizes]
  const Quanta* open = nullptr;  ///< 0 for tiles that are left as they are; null: none

  DESERT_HD bool closed(int column, int row) const {
    return open && open[row * tiles.columns() + column] == 0;
  }

  /// After so many sweeps, where the last has moved much or has not.
  DESERT_HD bool has_had_enough(int done, bool much) const {
    return done >= sweeps && (done >= most_sweeps || !much);
  }

  template <class Team>
  static constexpr int scratch_bytes = 4 * cells * 4;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row) const {
    if (closed(column, row)) return;
    float* h = reinterpret_cast<float*>(team.scratch);
    float *ground = h + cells, *drop = ground + cells;
    Quanta* base = reinterpret_cast<Quanta*>(drop + cells);
    clear(team, h, ground, drop);
    if (from_coarse.sand_after)
      team.for_each(families, [=](int n) DESERT_INLINE { prolong_family(column, row, n); });
    const Range range = load_heights(team, column, row, h, ground);
    if (range.lowest >= wall_height) return;
    const Units units(range.lowest, range.highest, level.quanta_per_cell);
    load(team, column, row, units, h, ground, drop, base);
    const float much = units.drop(plenty, level.quanta_per_cell);
    bool moved = false, moved_before = true;
    for (int n = 0;; ++n) {
      const PatchShift shift(n, tiles.offset);
      const float most = range.deep() ? sweep<true>(team, shift, h, ground, drop)
                                      : sweep<false>(team, shift, h, ground, drop);
      moved = moved || most > 0.0f;
      if (most == 0.0f && !moved_before) break;
      if (has_had_enough(n + 1, most > much)) break;
      moved_before = most > 0.0f;
    }
    if (moved) store(team, column, row, units, h, base);
  }

  static constexpr int families = side / 2 * (side / 2);
  /// Hands the nth coarse cell of the tile, if it is there, its change down to its children.
  DESERT_HD void prolong_family(int column, int row, int n) const {
    const int x = grid_x(column, 2 * (n % (side / 2))), y = grid_y(row, 2 * (n / (side / 2)));
    if (x >= 0 && y >= 0 && from_coarse.coarse.inside(x / 2, y / 2)) from_coarse(x / 2, y / 2);
  }

  /// The grid's column under column x of the tile, or −1; likewise its row. On a periodic axis each belongs
  /// to exactly one tile.
  DESERT_HD int grid_x(int column, int x) const {
    return along(column * side - tiles.offset + x, level.grid.width, level.grid.periodic_x);
  }
  DESERT_HD int grid_y(int row, int y) const {
    return along(row * side - tiles.offset + y, level.grid.height, level.grid.periodic_y);
  }

  /// Whether the tile's cells are all there, side by side.
  DESERT_HD bool whole(int column, int row) const {
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

  /// Where column k of the nth patch of row y lies.
  DESERT_HD static constexpr int local(int y, int n, int k) { return y * stride + k * column_stride + n; }

  /// Where the cells of a row of patches lie, from patch `first` on.
  struct At {
    PatchShift shift;
    int patch_row, first;
    DESERT_HD int operator()(int row, int column) const {
      const int y = (patch_row * Patch::side + shift.y + row) % side, x = shift.x + column;
      return local(y, first + x / Patch::side, x % Patch::side);
    }
  };

  /// The most that a pair has moved.
  template <bool deep, class Team>
  DESERT_HD float sweep(const Team& team, const PatchShift& shift, float* h, const float* ground,
                        const float* drop) const {
    const ShareOfGap omega = share;
    const auto copy_first = [=](int from, int to) DESERT_INLINE {
      team.for_each(side, [=](int y) DESERT_INLINE {
        for (int k = 0; k < shift.x; ++k) h[local(y, to, k)] = h[local(y, from, k)];
      });
    };
    copy_first(0, patches);
    const float most = team.most(patches * patches / Team::patches_at_once, [=](int i) DESERT_INLINE {
      constexpr int lanes = Team::patches_at_once, pieces = patches / lanes;
      const int patch_row = i / pieces, first = i % pieces * lanes;
      Shares<lanes> shares;
      float most_of[lanes] = {};
      for (int k = 0; k + 1 < Patch::side; ++k) {
        shares.y[k] = omega(patch_row * Patch::side + shift.y + k);
        for (int n = 0; n < lanes; ++n) shares.x[k][n] = omega((first + n) * Patch::side + shift.x + k);
      }
      PairsOfPatches<lanes, deep, At>{h, ground, drop, At{shift, patch_row, first}, shares, most_of}.relax();
      float most_here = 0.0f;
      for (int n = 0; n < lanes; ++n) most_here = higher(most_here, most_of[n]);
      return most_here;
    });
    copy_first(patches, 0);
    return most;
  }

  /// Calls body(i, n) with the grid's cell and the tile's for each cell of the tile that is there.
  template <class Team, class Body>
  DESERT_HD void for_each_cell_of_tile(const Team& team, int column, int row, const Body& body) const {
    const int width = level.grid.width;
    const int corner = (row * side - tiles.offset) * width + column * side - tiles.offset;
    const bool simple = whole(column, row);
    team.for_each_row([=](int y) DESERT_INLINE {
      const int first = corner + y * width;
      if (simple)
        team.template for_each_in_row<Patch::side>(
            [=](int n, auto k) DESERT_INLINE { body(first + n * Patch::side + k, local(y, n, k)); });
      else
        team.template for_each_in_row<Patch::side>([=](int n, auto k) DESERT_INLINE {
          const int there_x = grid_x(column, n * Patch::side + k), there_y = grid_y(row, y);
          if (there_x >= 0 && there_y >= 0) body(there_y * width + there_x, local(y, n, k));
        });
    });
  }

  /// Walls everywhere.
  template <class Team>
  DESERT_HD static void clear(const Team& team, float* h, float* ground, float* drop) {
    team.for_each(cells, [=](int n) DESERT_INLINE {
      h[n] = float_of(static_cast<std::uint32_t>(wall_height));
      ground[n] = Units::wall;
      drop[n] = Units::wall;
    });
  }

  /// In `h` and `ground` lie the bits of integers until load() has their units.
  template <class Team>
  DESERT_HD Range load_heights(const Team& team, int column, int row, float* h, float* ground) const {
    const LevelView from = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      const Quanta height = from.height(i);
      h[n] = float_of(static_cast<std::uint32_t>(height));
      ground[n] = float_of(static_cast<std::uint32_t>(height - from.sand[i]));
    });
    const auto height = [=](int n) DESERT_INLINE { return static_cast<Quanta>(bits_of(h[n])); };
    const auto below = [=](int n, const float* of) DESERT_INLINE {
      return height(n) < wall_height ? -static_cast<Quanta>(bits_of(of[n])) : wall_height;
    };
    return {team.lowest(cells, height), -team.lowest(cells, [=](int n) DESERT_INLINE { return below(n, h); }),
            -team.lowest(cells, [=](int n) DESERT_INLINE { return below(n, ground); })};
  }

  /// `base`: of a cell's sand, what does not change with its height.
  template <class Team>
  DESERT_HD void load(const Team& team, int column, int row, const Units& units, float* h, float* ground,
                      float* drop, Quanta* base) const {
    const LevelView from = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      const Quanta height = static_cast<Quanta>(bits_of(h[n])), sand = from.sand[i];
      const bool wall = height >= wall_height;
      h[n] = wall ? Units::wall : units.height(height);
      ground[n] = wall ? Units::wall : units.ground(height, sand);
      drop[n] = wall ? Units::wall : units.drop(from.repose[i], from.quanta_per_cell);
      base[n] = sand - units.of_height(h[n]);
    });
    team.for_each(cells, [=](int n) DESERT_INLINE { h[n] = ground[n] == Units::wall ? Units::wall : h[n]; });
    // The first cells of a row again at its end.
    team.for_each(side * Patch::side, [=](int i) DESERT_INLINE {
      const int y = i / Patch::side, k = i % Patch::side;
      ground[local(y, patches, k)] = ground[local(y, 0, k)];
      drop[local(y, patches, k)] = drop[local(y, 0, k)];
    });
  }

  template <class Team>
  DESERT_HD void store(const Team& team, int column, int row, const Units& units, const float* h,
                       const Quanta* base) const {
    Quanta* sand = level.sand;
    for_each_cell_of_tile(team, column, row,
                          [=](int i, int n) DESERT_INLINE { sand[i] = base[n] + units.of_height(h[n]); });
  }
};

/// Relaxes all tiles by the law above.
template <class E>
void relax_by_law(E& exec, const RelaxTile& law);

/// What a pass can be followed by: nothing, filling coarse levels, or measuring the heights; the grid that
/// the latter two are called for.
struct NothingThen {};
inline Grid passed_over(const Restrict& law) { return law.blocks(); }
inline Grid passed_over(const surface::MeasureBlock& law) { return law.blocks; }

/// Relaxes all tiles, as the backend does it best, and then calls `then`, perhaps in the same pass. `Then` is one
/// of the three above.
template <class E, class Then>
void relax_tiles(E& exec, const RelaxTile& law, const Then& then);

}  // namespace desert_sim::avalanching

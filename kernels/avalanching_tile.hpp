#pragma once
/// Sweeps inside one closed tile: nothing crosses its edge, so tiles do not see each other. What is around
/// the tile, obstacles, and what lies beyond the grid, stand in it as walls: infinitely high, so that nothing
/// slides there, and without sand, so that nothing slides from there.
///
/// A tile takes at least `sweeps` sweeps, unless it comes to rest, and goes on while one of its cells gives
/// `plenty`.
///
/// A sweep is synchronous: each cell lays out what it gives to its eight neighbours, then each takes what is
/// laid out for it. Most of a desert is at rest: a row gives again only if a row within two of it gave in the
/// sweep before, and takes only from rows that give. That leaves out only what would change nothing.
///
/// Heights and amounts are floats that count whole units (avalanching_units.hpp). This is the reference; on a
/// GPU tuned/avalanching_tile.cu gives the same bits sooner.

#include <type_traits>

#include "desert_sim/kernels/avalanching_laws.hpp"
#include "desert_sim/kernels/avalanching_units.hpp"
#include "desert_sim/kernels/surface.hpp"

namespace desert_sim::avalanching {

struct RelaxTile {
  static constexpr int side = Tiles::side;
  static constexpr int lead = 8, stride = lead + side,
                       cells = (side + 2) * stride + lead;  // vectors begin at x = 0
  static constexpr int flags = side + 4;  ///< a row's flag, with two rows of margin on either side
  static constexpr int layouts =
      Neighbours::count + 1;  ///< what a row lays out: eight parts, and what is left

  Tiles tiles;
  LevelView level;
  Prolong from_coarse;  ///< what the tile's cells get first; their families lie in one tile
  float transfer, rest;
  int sweeps;                    ///< at most most_sweeps
  float plenty;                  ///< [cell sizes]
  float onward = 0.0f;           ///< how far slides are handed on (avalanching_units.hpp)
  const Quanta* open = nullptr;  ///< 0 for tiles that are left as they are; null: none

  DESERT_HD bool closed(int column, int row) const {
    return open && open[row * tiles.columns() + column] == 0;
  }

  template <class Team>
  static constexpr int scratch_bytes = (3 * cells + Team::rows_at_once * layouts * stride + 2 * flags) * 4;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row) const {
    if (closed(column, row)) return;
    float* h = reinterpret_cast<float*>(team.scratch);
    float *ground = h + cells, *drop = ground + cells, *laid_out = drop + cells;
    int* giving = reinterpret_cast<int*>(laid_out + Team::rows_at_once * layouts * stride);
    int* giving_next = giving + flags;
    const float k_c = transfer, ends = rest, on = onward;

    clear(team, h, ground, drop, laid_out, giving);
    if (from_coarse.sand_after)
      team.for_each(families, [=](int n) DESERT_INLINE { prolong_family(column, row, n); });
    Quanta lowest, highest;
    load_heights(team, column, row, h, lowest, highest);
    if (lowest >= wall_height) return;
    const Units units(lowest, highest, level.quanta_per_cell);
    load(team, column, row, units, h, ground, drop);
    bool moved = false;
    const float much = units.drop(plenty, level.quanta_per_cell);
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      const auto give = [=](int y) DESERT_INLINE {
        const int* near = giving + y;  // rows y − 2 … y + 2
        const bool stale = (near[0] | near[1] | near[2] | near[3] | near[4]) != 0;
        float* to = laid_out + slot<Team>(y);
        const float most = stale ? team.most_in_row([=](int x) DESERT_INLINE {
          return lay_out(h, ground, drop, ends, k_c, on, local(x, y), to + x);
        })
                                 : 0.0f;
        if (team.leads_row()) giving_next[y + 2] = most > much ? 2 : (most > 0.0f ? 1 : 0);
      };
      const auto take = [=](int y) DESERT_INLINE {
        if (giving_next[y + 2]) take_what_is_left(team, h, laid_out + slot<Team>(y), y);
        if (giving_next[y + 1]) take_from<2, 4, 6>(team, h, laid_out + slot<Team>(y - 1), y);
        if (giving_next[y + 3]) take_from<3, 5, 7>(team, h, laid_out + slot<Team>(y + 1), y);
      };
      team.for_each_row_then_behind(give, take);
      if (!team.any(side, [=](int y) { return giving_next[y + 2] != 0; })) break;
      moved = true;
      if (sweep + 1 >= sweeps && !team.any(side, [=](int y) { return giving_next[y + 2] == 2; })) break;
      int* last = giving;
      giving = giving_next;
      giving_next = last;
    }
    if (moved) store(team, column, row, units, h, ground);
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
    if (periodic) return p < cells_along - tiles.offset ? wrap(p, cells_along) : -1;
    return p >= 0 && p < cells_along ? p : -1;
  }
  DESERT_HD static int local(int x, int y) { return (y + 1) * stride + lead + x; }
  DESERT_HD static constexpr int offset_to(int k) { return Neighbours::dy(k) * stride + Neighbours::dx(k); }
  /// Where row y lays out: layout k of cell x at [k·stride + x]. Beside the row there is always 0.
  template <class Team>
  DESERT_HD static int slot(int y) {
    return (y % Team::rows_at_once) * layouts * stride + lead;
  }

  /// Calls body(i, n) with the grid's cell and the tile's for each cell of the tile that is there.
  template <class Team, class Body>
  DESERT_HD void for_each_cell_of_tile(const Team& team, int column, int row, const Body& body) const {
    const int width = level.grid.width;
    const int first = (row * side - tiles.offset) * width + column * side - tiles.offset;
    const bool simple = whole(column, row);
    team.for_each_row([=](int y) DESERT_INLINE {
      if (simple)
        team.for_each_in_row([=](int x) DESERT_INLINE { body(first + y * width + x, local(x, y)); });
      else
        team.for_each_in_row([=](int x) DESERT_INLINE {
          const int there_x = grid_x(column, x), there_y = grid_y(row, y);
          if (there_x >= 0 && there_y >= 0) body(there_y * width + there_x, local(x, y));
        });
    });
  }

  /// Walls everywhere; at first every row may give, the margins never do.
  template <class Team>
  DESERT_HD static void clear(const Team& team, float* h, float* ground, float* drop, float* laid_out,
                              int* giving) {
    team.for_each(cells, [=](int n) DESERT_INLINE {
      h[n] = float_of(static_cast<std::uint32_t>(wall_height));
      ground[n] = Units::wall_ground;
      drop[n] = 0.0f;
    });
    team.for_each(Team::rows_at_once * layouts * stride, [=](int n) DESERT_INLINE { laid_out[n] = 0.0f; });
    team.for_each(2 * flags, [=](int n) DESERT_INLINE { giving[n] = n >= 2 && n < side + 2 ? 1 : 0; });
  }

  /// In `h` lie the bits of the integers until load() has their units. Lowest and highest: of all but walls.
  template <class Team>
  DESERT_HD void load_heights(const Team& team, int column, int row, float* h, Quanta& lowest,
                              Quanta& highest) const {
    const LevelView from = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      h[n] = float_of(static_cast<std::uint32_t>(from.height(i)));
    });
    const auto height = [=](int n) DESERT_INLINE { return static_cast<Quanta>(bits_of(h[n])); };
    const auto depth = [=](int n)
                           DESERT_INLINE { return height(n) < wall_height ? -height(n) : wall_height; };
    lowest = team.lowest(cells, height);
    highest = -team.lowest(cells, depth);
  }

  template <class Team>
  DESERT_HD void load(const Team& team, int column, int row, const Units& units, float* h, float* ground,
                      float* drop) const {
    const LevelView from = level;
    team.for_each(cells, [=](int n) DESERT_INLINE {
      const Quanta height = static_cast<Quanta>(bits_of(h[n]));
      h[n] = height < wall_height ? units.height(height) : Units::wall;
    });
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      ground[n] = h[n] < Units::wall ? h[n] - units.depth_over_film(from.sand[i]) : Units::wall_ground;
      drop[n] = units.drop(from.repose[i], from.quanta_per_cell);
    });
  }

  template <class Team>
  DESERT_HD void store(const Team& team, int column, int row, const Units& units, const float* h,
                       const float* ground) const {
    Quanta* sand = level.sand;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      const Quanta gain = units.gain(ground[n] + units.depth_over_film(sand[i]), h[n]);
      sand[i] += h[n] < Units::wall ? gain : 0;  // always stored: so it can be a vector
    });
  }

  /// What cell n gives in all.
  DESERT_HD static float lay_out(const float* h, const float* ground, const float* drop, float rest,
                                 float transfer, float onward, int n, float* to) {
    float around[Neighbours::count];
    Neighbours::unrolled([&](auto k) DESERT_INLINE { around[k] = h[n + offset_to(k)]; });
    const Slide slide(h[n], around, lower(lower(around[0], around[1]), lower(around[2], around[3])),
                      lower(lower(around[4], around[5]), lower(around[6], around[7])), ground[n], drop[n],
                      rest, transfer, onward);
    Neighbours::unrolled([&](auto k) DESERT_INLINE { to[k * stride] = slide.part[k]; });
    to[8 * stride] = slide.left;
    return h[n] - slide.left;
  }

  /// What is left of row y, and what its cells give along it.
  template <class Team>
  DESERT_HD static void take_what_is_left(const Team& team, float* h, const float* from, int y) {
    team.for_each_in_row([=](int x) DESERT_INLINE {
      h[local(x, y)] = from[8 * stride + x] + (from[x - 1] + from[stride + x + 1]);
    });
  }
  /// Parts a, b and c, which come from the next row on one side.
  template <int a, int b, int c, class Team>
  DESERT_HD static void take_from(const Team& team, float* h, const float* from, int y) {
    team.for_each_in_row([=](int x) DESERT_INLINE {
      h[local(x, y)] += from[a * stride + x - Neighbours::dx(a)] +
                        (from[b * stride + x - Neighbours::dx(b)] + from[c * stride + x - Neighbours::dx(c)]);
    });
  }
};

/// All tiles, by the law above.
template <class E>
void relax_by_law(E& exec, const RelaxTile& law) {
  for_each_tile(exec, law.tiles, law);
}
/// All tiles, as the backend does it best.
template <class E>
void relax_tiles(E& exec, const RelaxTile& law) {
  relax_by_law(exec, law);
}
/// What a pass can be followed by: nothing, filling coarse levels, or measuring the heights; the grid that
/// the latter two are called for.
struct NothingThen {};
inline Grid passed_over(const Restrict& law) { return law.blocks(); }
inline Grid passed_over(const surface::MeasureBlock& law) { return law.blocks; }
/// All tiles, and then that: a backend may do it in passing.
template <class E, class Then>
void relax_tiles_then(E& exec, const RelaxTile& law, const Then& then) {
  relax_tiles(exec, law);
  if constexpr (!std::is_same_v<Then, NothingThen>) for_each_cell(exec, passed_over(then), then);
}
#if DESERT_WITH_CUDA  // tuned/avalanching_tile.cu
void relax_tiles(CudaExec& exec, const RelaxTile& law);
void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const Restrict& then);
void relax_tiles_then(CudaExec& exec, const RelaxTile& law, const surface::MeasureBlock& then);
#endif

}  // namespace desert_sim::avalanching

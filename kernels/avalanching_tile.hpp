#pragma once
/// Sweeps inside one closed tile: nothing crosses its edge, so tiles do not see each other. What is around
/// the tile, obstacles, and what lies beyond the grid, stand in it as walls: infinitely high, so that nothing
/// slides there, and without sand, so that nothing slides from there.
///
/// Most of a desert is at rest: a row of the tile is released again only if a row within two of it moved in
/// the sweep before, and gathered only if a row next to it gives. That leaves out only what would change
/// nothing.

#include "desert_sim/kernels/avalanching_laws.hpp"

namespace desert_sim::avalanching {

struct RelaxTile {
  static constexpr int side = Tiles::side, stride = side + 2, cells = stride * stride;
  static constexpr int flags = side + 4;  ///< a row's flag, with two rows of margin on either side
  static constexpr int scratch_bytes = (6 * cells + 2 * flags) * 4;

  Tiles tiles;
  LevelView level;
  float transfer;
  int sweeps;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row) const {
    Quanta* h = reinterpret_cast<Quanta*>(team.scratch);
    Quanta* h_next = h + cells;
    Quanta* sand = h_next + cells;
    Quanta* given = sand + cells;
    float* drop = reinterpret_cast<float*>(given + cells);
    float* share = drop + cells;
    int* giving = reinterpret_cast<int*>(share + cells);
    int* giving_next = giving + flags;

    load(team, column, row, h, h_next, sand, given, drop, share, giving);
    bool moved = false;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      team.for_each_row([=](int y) DESERT_INLINE {
        const int* near = giving + y;  // rows y − 2 … y + 2
        const bool stale = (near[0] | near[1] | near[2] | near[3] | near[4]) != 0;
        const bool gives = stale && team.any_in_row([=](int x) DESERT_INLINE {
          return release(h, sand, drop, share, given, local(x, y));
        });
        if (team.leads_row()) giving_next[y + 2] = gives ? 1 : 0;
      });
      if (!team.any(side, [=](int y) { return giving_next[y + 2] != 0; })) break;
      moved = true;
      team.for_each_row([=](int y) DESERT_INLINE {
        const bool changes = (giving_next[y + 1] | giving_next[y + 2] | giving_next[y + 3]) != 0;
        if (changes)
          team.for_each_in_row(
              [=](int x) DESERT_INLINE { gather(h, h_next, sand, drop, share, given, local(x, y)); });
        else
          team.for_each_in_row([=](int x) DESERT_INLINE { h_next[local(x, y)] = h[local(x, y)]; });
      });
      exchange(h, h_next);
      exchange(giving, giving_next);
    }
    if (moved) store(team, column, row, sand);
  }

 private:
  template <class T>
  DESERT_HD static void exchange(T*& a, T*& b) {
    T* c = a;
    a = b;
    b = c;
  }
  DESERT_HD static int local(int x, int y) { return (y + 1) * stride + x + 1; }
  DESERT_HD static constexpr int offset_to(int k) { return Neighbours::dy(k) * stride + Neighbours::dx(k); }

  /// Cell of the grid under (x, y) of the tile, or −1. On a periodic axis each cell belongs to exactly one
  /// tile.
  DESERT_HD int cell(int column, int row, int x, int y) const {
    const Grid& g = level.grid;
    int px = column * side - tiles.offset + x, py = row * side - tiles.offset + y;
    if (g.periodic_x) px = px < g.width - tiles.offset ? wrap(px, g.width) : -1;
    if (g.periodic_y) py = py < g.height - tiles.offset ? wrap(py, g.height) : -1;
    return g.inside(px, py) ? g.index(px, py) : -1;
  }
  /// Whether the tile's cells are all there, side by side.
  DESERT_HD bool whole(int column, int row) const {
    const int x = column * side - tiles.offset, y = row * side - tiles.offset;
    const int right = level.grid.width - (level.grid.periodic_x ? tiles.offset : 0);
    const int top = level.grid.height - (level.grid.periodic_y ? tiles.offset : 0);
    return x >= 0 && y >= 0 && x + side <= right && y + side <= top;
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
          const int i = cell(column, row, x, y);
          if (i >= 0) body(i, local(x, y));
        });
    });
  }

  template <class Team>
  DESERT_HD void load(const Team& team, int column, int row, Quanta* h, Quanta* h_next, Quanta* sand,
                      Quanta* given, float* drop, float* share, int* giving) const {
    team.for_each(cells, [=](int n) DESERT_INLINE {
      h[n] = h_next[n] = wall_height;
      sand[n] = given[n] = 0;
      drop[n] = share[n] = 0.0f;
    });
    // At first every row may give; the margins never do.
    team.for_each(2 * flags, [=](int n) DESERT_INLINE { giving[n] = n >= 2 && n < side + 2 ? 1 : 0; });
    const LevelView from = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      const bool wall = from.wall(i);
      h[n] = wall ? wall_height : from.ground[i] + from.sand[i];
      sand[n] = wall ? 0 : from.sand[i];
      drop[n] = from.repose[i] * from.quanta_per_cell;
    });
  }

  template <class Team>
  DESERT_HD void store(const Team& team, int column, int row, const Quanta* sand) const {
    const LevelView to = level;
    for_each_cell_of_tile(team, column, row, [=](int i, int n) DESERT_INLINE {
      if (!to.wall(i)) to.sand[i] = sand[n];
    });
  }

  /// Computes a cell's share and what it gives in all; whether that is anything.
  DESERT_HD bool release(const Quanta* h, const Quanta* sand, const float* drop, float* share, Quanta* given,
                         int n) const {
    float b[8];
    Neighbours::unrolled([&](auto k) DESERT_INLINE {
      b[k] = excess(h[n], h[n + offset_to(k)], drop[n] * Neighbours::distance(k));
    });
    const float part = release_share(b, transfer, static_cast<float>(sand[n]));
    Quanta total = 0;
    Neighbours::unrolled([&](auto k) DESERT_INLINE { total += static_cast<Quanta>(part * b[k]); });
    share[n] = part;
    given[n] = total;
    return total != 0;
  }

  /// What the neighbours give to a cell, less what it gives.
  DESERT_HD static void gather(const Quanta* h, Quanta* h_next, Quanta* sand, const float* drop,
                               const float* share, const Quanta* given, int n) {
    Quanta change = -given[n];
    Neighbours::unrolled([&](auto k) DESERT_INLINE {
      const int j = n + offset_to(k);
      change += static_cast<Quanta>(share[j] * excess(h[j], h[n], drop[j] * Neighbours::distance(k)));
    });
    h_next[n] = h[n] + change;
    sand[n] += change;
  }
};

}  // namespace desert_sim::avalanching

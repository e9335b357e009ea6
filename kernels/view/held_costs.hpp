#pragma once
/// What others hold of the costs of a terrain, and what they lack.
///
///   cost   lethal where the traversability is 0, else 99 (1 − traversability) rounded, 0 … 99; unknown where
///          it is NaN
///
/// A cell has changed if its cost is off by more than a threshold; to and from lethal and unknown always. The
/// smallest box with all cells that changed is brought up to date; tiles of it that differ at all from what
/// is held are packed. Reads what traversability reads; writes the costs of now, and what is held.

#include "kernels/field/cell_box.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_costs {

using packed_tiles::TileOfGrid;
using packed_tiles::Tiling;

constexpr std::int8_t unknown_cost = -1, lethal_cost = 100;
/// No cost: where nothing is held.
constexpr std::int8_t no_cost = -128;

DESERT_HD std::int8_t cost_of(float traversability) {
  if (!(traversability == traversability)) return unknown_cost;
  if (traversability <= 0.0f) return lethal_cost;
  return static_cast<std::int8_t>(nearest(99.0f * (1.0f - minimum(traversability, 1.0f))));
}

DESERT_HD bool is_special(std::int8_t cost) { return cost == lethal_cost || cost < 0; }
DESERT_HD bool differs(std::int8_t now, std::int8_t held, int threshold) {
  const int off = now < held ? held - now : now - held;
  return off > (is_special(now) || is_special(held) ? 0 : threshold);
}

struct Judge {
  traversability::Traversability law;
  std::int8_t* now;
  DESERT_HD void operator()(int x, int y) const {
    now[law.roughness.surface.grid.index(x, y)] = cost_of(law.at(x, y));
  }
};

/// A box that cells are added to, in numbers that grow with it; all 0 while it is empty.
struct GrowingBox {
  int west = 0, south = 0, east = 0, north = 0;  ///< width − x0, height − y0, x1, y1
  DESERT_HD CellBox cells(const Grid& grid) const {
    return {grid.width - west, grid.height - south, east, north};
  }
};

/// The box of the cells that changed.
struct FindChanges {
  Tiling tiles;
  const std::int8_t *now, *held;
  int threshold;
  GrowingBox* box;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  /// The greatest of value(x, y) > 0 for cells that changed; 0 if none did.
  template <class Team, class Value>
  DESERT_HD int most(const Team& team, const TileOfGrid& tile, const Value& value) const {
    const FindChanges law = *this;
    return -team.lowest(tile.width, tile.height, [law, tile, value](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      return differs(law.now[i], law.held[i], law.threshold) ? -value(tile.x0 + x, tile.y0 + y) : 0;
    });
  }

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const TileOfGrid tile(tiles, column, tiles.first_row + row_of_band);
    const Grid grid = tiles.grid;
    GrowingBox mine;
    mine.east = most(team, tile, [](int x, int) DESERT_INLINE { return x + 1; });
    if (mine.east == 0) return;
    mine.west = most(team, tile, [grid](int x, int) DESERT_INLINE { return grid.width - x; });
    mine.north = most(team, tile, [](int, int y) DESERT_INLINE { return y + 1; });
    mine.south = most(team, tile, [grid](int, int y) DESERT_INLINE { return grid.height - y; });
    GrowingBox* const all = box;
    team.for_each(1, [mine, all](int) {
      atomic_max(&all->west, mine.west);
      atomic_max(&all->south, mine.south);
      atomic_max(&all->east, mine.east);
      atomic_max(&all->north, mine.north);
    });
  }
};

/// Holds the costs of a box, and packs the tiles of which that changes something, as they are held then: the
/// box of what changed, unless it is empty, with that of `recent`; or `recent` alone if `changed` is null.
struct TakeBox {
  Tiling tiles;
  const std::int8_t* now;
  std::int8_t* held;
  const GrowingBox* changed;
  CellBox recent;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const TileOfGrid tile(tiles, column, tiles.first_row + row_of_band);
    CellBox box = changed ? changed->cells(tiles.grid) : recent;
    if (box.empty()) return;
    box = box.with(recent);
    const std::int8_t* const from = now;
    std::int8_t* const to = held;
    const int none = team.lowest(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      return box.has(tile.x0 + x, tile.y0 + y) && from[i] != to[i] ? -1 : 0;
    });
    if (none == 0) return;
    packed_tiles::TileHead head;
    head.tile = tile.number;
    auto* const packed =
        reinterpret_cast<std::int8_t*>(packed_tiles::begin_tile(team, pack, head, tile.cells()));
    team.for_each(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const std::int8_t cost = box.has(tile.x0 + x, tile.y0 + y) ? from[i] : to[i];
      to[i] = cost;
      packed[y * tile.width + x] = cost;
    });
  }
};

/// The costs of now, of all cells. `elevation` must be up to date.
template <class E>
void judge(E& exec, const TerrainView& t, const TraversabilityParameters& p, const ReposeParameters& repose,
           std::int8_t* now) {
  for_each_cell(exec, t.grid, Judge{traversability::law(t, p, repose), now});
}

/// Writes to `box`.
template <class E>
void find_changes(E& exec, const Tiling& tiles, const std::int8_t* now, const std::int8_t* held,
                  int threshold, GrowingBox* box) {
  exec.set_zero(box, sizeof *box);
  for_each_tile(exec, tiles, FindChanges{tiles, now, held, threshold, box});
}

/// See TakeBox; `pack` has room for most_packed().
template <class E>
void take_box(E& exec, const Tiling& tiles, const std::int8_t* now, std::int8_t* held,
              const GrowingBox* changed, const CellBox& recent, char* pack) {
  exec.set_zero(pack, sizeof(packed_tiles::PackedHead));
  for_each_tile(exec, tiles, TakeBox{tiles, now, held, changed, recent, pack});
}

}  // namespace desert_sim::held_costs

/// Laws and functions of held_costs.hpp; compiled once for each backend.
#include "kernels/view/held_costs.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/field/cell_box.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/rover/traversability_laws.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_costs {

using packed_tiles::TileOfGrid;

DESERT_HD bool is_special(std::int8_t cost) { return cost == lethal_cost || cost < 0; }

DESERT_HD bool differs(std::int8_t now, std::int8_t held, int threshold) {
  const int off = now < held ? held - now : now - held;
  return off > (is_special(now) || is_special(held) ? 0 : threshold);
}

struct ComputeCosts {
  traversability::Traversability law;
  std::int8_t* now;
  DESERT_HD void operator()(int x, int y) const {
    now[law.roughness.surface.grid.index(x, y)] = cost_of(law.at(x, y));
  }
};

/// Grows a box around all cells that changed.
struct FindChangedBox {
  Tiling tiles;
  const std::int8_t *now, *held;
  int threshold;
  BoundingBox* box;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  /// Maximum of value(x, y) > 0 over the cells of a tile that changed; 0 if none did.
  template <class Team, class Value>
  DESERT_HD int max_of_changed(const Team& team, const TileOfGrid& tile, const Value& value) const {
    const FindChangedBox law = *this;
    return -team.min_of(tile.width, tile.height, [law, tile, value](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      return differs(law.now[i], law.held[i], law.threshold) ? -value(tile.x0 + x, tile.y0 + y) : 0;
    });
  }

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const TileOfGrid tile(tiles, column, tiles.first_row + row_of_band);
    const Grid grid = tiles.grid;
    BoundingBox mine;
    mine.east = max_of_changed(team, tile, [](int x, int) DESERT_INLINE { return x + 1; });
    if (mine.east == 0) return;
    mine.west = max_of_changed(team, tile, [grid](int x, int) DESERT_INLINE { return grid.width - x; });
    mine.north = max_of_changed(team, tile, [](int, int y) DESERT_INLINE { return y + 1; });
    mine.south = max_of_changed(team, tile, [grid](int, int y) DESERT_INLINE { return grid.height - y; });
    BoundingBox* const all = box;
    team.for_each(1, [mine, all](int) {
      atomic_max(&all->west, mine.west);
      atomic_max(&all->south, mine.south);
      atomic_max(&all->east, mine.east);
      atomic_max(&all->north, mine.north);
    });
  }
};

/// Copies the current costs of a box to the held ones, and packs each tile in which that changes something,
/// as it is held afterwards. The box is that of `changed` joined with `recent`; nothing is done if `changed`
/// is empty. If `changed` is null, the box is `recent`.
struct CopyRegion {
  Tiling tiles;
  const std::int8_t* now;
  std::int8_t* held;
  const BoundingBox* changed;
  CellBox recent;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const TileOfGrid tile(tiles, column, tiles.first_row + row_of_band);
    CellBox box = changed ? changed->cells(tiles.grid) : recent;
    if (box.empty()) return;
    box = box.united_with(recent);
    const std::int8_t* const from = now;
    std::int8_t* const to = held;
    const int none = team.min_of(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      return box.contains_cell(tile.x0 + x, tile.y0 + y) && from[i] != to[i] ? -1 : 0;
    });
    if (none == 0) return;
    packed_tiles::TileHeader head;
    head.tile = tile.number;
    auto* const packed =
        reinterpret_cast<std::int8_t*>(packed_tiles::reserve_tile(team, pack, head, tile.cells()));
    team.for_each(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      const std::int8_t cost = box.contains_cell(tile.x0 + x, tile.y0 + y) ? from[i] : to[i];
      to[i] = cost;
      packed[y * tile.width + x] = cost;
    });
  }
};

template <class E>
void compute_costs(E& exec, const TerrainView& t, const traversability::Rover& rover, std::int8_t* now) {
  for_each_cell(exec, t.grid, ComputeCosts{traversability::make_law(t, rover), now});
}

template <class E>
void find_changed_box(E& exec, const Tiling& tiles, const std::int8_t* now, const std::int8_t* held,
                      int threshold, BoundingBox* box) {
  exec.set_zero(box, sizeof *box);
  for_each_tile(exec, tiles, FindChangedBox{tiles, now, held, threshold, box});
}

template <class E>
void copy_region(E& exec, const Tiling& tiles, const std::int8_t* now, std::int8_t* held,
                 const BoundingBox* changed, const CellBox& recent, char* pack) {
  exec.set_zero(pack, sizeof(packed_tiles::PackHeader));
  for_each_tile(exec, tiles, CopyRegion{tiles, now, held, changed, recent, pack});
}

template void compute_costs(Backend&, const TerrainView&, const traversability::Rover&, std::int8_t*);
template void find_changed_box(Backend&, const Tiling&, const std::int8_t*, const std::int8_t*, int,
                               BoundingBox*);
template void copy_region(Backend&, const Tiling&, const std::int8_t*, std::int8_t*, const BoundingBox*,
                          const CellBox&, char*);

}  // namespace desert_sim::held_costs

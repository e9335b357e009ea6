/// Laws and functions of held_costs.hpp; compiled once for each backend.
#include "kernels/view/held_costs.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/rover/traversability.hpp"
#include "kernels/rover/traversability_laws.hpp"
#include "kernels/view/packed_tiles.hpp"

namespace desert_sim::held_costs {

using packed_tiles::TileOfGrid;

DESERT_HD bool is_special(std::int8_t cost) { return cost == cell_cost::lethal || cost < 0; }

DESERT_HD bool differs(std::int8_t now, std::int8_t held, int threshold) {
  const int off = now < held ? held - now : now - held;
  return off > (is_special(now) || is_special(held) ? 0 : threshold);
}

struct ComputeCosts {
  traversability::Traversability law;
  std::int8_t* now;
  DESERT_HD void operator()(int x, int y) const {
    now[law.roughness.surface.grid.index(x, y)] = cell_cost::of(law.at(x, y));
  }
};

/// Copies the current costs of each tile that has a changed cell to the held ones, and packs them.
struct CopyTiles {
  Tiling tiles;
  const std::int8_t* now;
  std::int8_t* held;
  int threshold;
  char* pack;

  template <class Team>
  static constexpr int scratch_bytes = packed_tiles::scratch_bytes;

  template <class Team>
  DESERT_HD void operator()(const Team& team, int column, int row_of_band) const {
    const TileOfGrid tile(tiles, column, tiles.first_row + row_of_band);
    const std::int8_t* const from = now;
    std::int8_t* const to = held;
    const int more_than = threshold;
    const int none = team.min_of(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      return differs(from[i], to[i], more_than) ? -1 : 0;
    });
    if (none == 0) return;
    packed_tiles::TileHeader head;
    head.tile = tile.number;
    auto* const packed =
        reinterpret_cast<std::int8_t*>(packed_tiles::reserve_tile(team, pack, head, tile.cells()));
    team.for_each(tile.width, tile.height, [=](int x, int y) DESERT_INLINE {
      const int i = tile.index(x, y);
      to[i] = from[i];
      packed[y * tile.width + x] = from[i];
    });
  }
};

template <class E>
void compute_costs(E& exec, const TerrainView& t, const traversability::Rover& rover, std::int8_t* now) {
  for_each_cell(exec, t.grid, ComputeCosts{traversability::make_law(t, rover), now});
}

template <class E>
void copy_tiles(E& exec, const Tiling& tiles, const std::int8_t* now, std::int8_t* held, int threshold,
                char* pack) {
  exec.set_zero(pack, sizeof(packed_tiles::PackHeader));
  for_each_tile(exec, tiles, CopyTiles{tiles, now, held, threshold, pack});
}

template void compute_costs(Backend&, const TerrainView&, const traversability::Rover&, std::int8_t*);
template void copy_tiles(Backend&, const Tiling&, const std::int8_t*, std::int8_t*, int, char*);

}  // namespace desert_sim::held_costs

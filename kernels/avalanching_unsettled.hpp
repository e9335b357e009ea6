#pragma once
/// Which tiles still have to be passed over, when most of the grid is at rest: those within reach of a cell
/// that is too steep. Found and kept on the device.

#include "desert_sim/kernels/avalanching_laws.hpp"
#include "desert_sim/kernels/buffer.hpp"

namespace desert_sim::avalanching {

/// Passes that follow each other before it is asked again what is too steep.
constexpr int passes_a_round = 4;
/// From a cell that is too steep, tiles so many cells away are passed over too: slides come that far.
constexpr int slides_reach = 8;

/// Tiles of a round's passes; 0 for one that need not be passed over.
struct OpenTiles {
  Buffer<Quanta> flags;   ///< a pass after the other
  Buffer<Quanta> counts;  ///< cells that are too steep, of rounds that follow each other
  int most_tiles = 0;     ///< of a pass

  Quanta* of_pass(int pass) const { return flags.data() + static_cast<std::size_t>(pass) * most_tiles; }
};

inline OpenTiles make_open_tiles(Exec& exec, const Grid& grid, int rounds) {
  const Tiles most{grid, Tiles::side - 1};
  return {Buffer<Quanta>(exec, static_cast<std::size_t>(passes_a_round) * most.count()),
          Buffer<Quanta>(exec, static_cast<std::size_t>(rounds)), most.count()};
}

struct OpenNearUnsettled {
  Excess excess;
  float tolerance;
  int offsets[passes_a_round];  ///< of the passes' seams
  Quanta* flags;                ///< all 0
  int most_tiles;
  Quanta* count;  ///< 0

  DESERT_HD void operator()(int x, int y) const {
    if (excess(x, y) <= tolerance) return;
    atomic_add(count, Quanta{1});
    for (int pass = 0; pass < passes_a_round; ++pass) {
      const Tiles tiles{excess.level.grid, offsets[pass]};
      Quanta* of_pass = flags + pass * most_tiles;
      // A whole tile that is within reach holds one of the corners; one at an edge may only hold the cell.
      const int west = tiles.column_of(x - slides_reach), east = tiles.column_of(x + slides_reach);
      const int south = tiles.row_of(y - slides_reach) * tiles.columns();
      const int north = tiles.row_of(y + slides_reach) * tiles.columns();
      for (int tile : {south + west, south + east, north + west, north + east,
                       tiles.row_of(y) * tiles.columns() + tiles.column_of(x)})
        raise_flag(of_pass + tile);
    }
  }
};

}  // namespace desert_sim::avalanching

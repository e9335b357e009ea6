#pragma once
/// Which tiles still have to be passed over, when most of the grid is at rest: those within reach of a cell
/// that is too steep. Found and kept on the device.
///
/// A cell that was at rest can only have become too steep in or beside a tile that has been passed over
/// since. So after a round only the blocks around its tiles are asked:
///
///   tiles of the round's passes --AskAround--> blocks to ask --OpenNearUnsettled--> tiles of the next round
///
/// There are two sets of tiles, of the last round and of the next, in turns.

#include "desert_sim/kernels/avalanching_laws.hpp"
#include "desert_sim/kernels/buffer.hpp"

namespace desert_sim::avalanching {

/// Passes that follow each other before it is asked again what is too steep.
constexpr int passes_a_round = 4;
/// From a cell that is too steep, tiles so many cells away are passed over too: slides come that far.
constexpr int slides_reach = 8;

/// The tiles of a round's passes: 0 for one that need not be passed over.
struct RoundOfTiles {
  Grid grid;
  int offsets[passes_a_round];  ///< of the passes' seams
  Quanta* flags;                ///< a pass after the other
  int most_tiles;               ///< of a pass

  DESERT_HD Tiles of(int pass) const { return {grid, offsets[pass]}; }
  DESERT_HD Quanta* of_pass(int pass) const { return flags + static_cast<long long>(pass) * most_tiles; }
};

struct OpenTiles {
  Buffer<Quanta> flags;   ///< of two rounds
  Buffer<Quanta> ask;     ///< blocks, the tiles of offset 0, that are to be asked
  Buffer<Quanta> counts;  ///< cells that are too steep, of rounds that follow each other
  int most_tiles = 0;     ///< of a pass

  Quanta* of_round(int round) const {
    return flags.data() + static_cast<std::size_t>(round % 2) * passes_a_round * most_tiles;
  }
};

inline OpenTiles make_open_tiles(Exec& exec, const Grid& grid, int rounds) {
  const std::size_t most = static_cast<std::size_t>(Tiles{grid, Tiles::side - 1}.count());
  return {Buffer<Quanta>(exec, 2 * passes_a_round * most),
          Buffer<Quanta>(exec, static_cast<std::size_t>(Tiles{grid, 0}.count())),
          Buffer<Quanta>(exec, static_cast<std::size_t>(rounds)), static_cast<int>(most)};
}

/// Marks the blocks that a tile of a pass has cells in, or beside.
struct AskAround {
  RoundOfTiles passed;
  Quanta* ask;

  DESERT_HD void operator()(int tile, int pass) const {
    const Tiles tiles = passed.of(pass), blocks{passed.grid, 0};
    if (tile >= tiles.count() || passed.of_pass(pass)[tile] == 0) return;
    const int west = tile % tiles.columns() * Tiles::side - tiles.offset,
              south = tile / tiles.columns() * Tiles::side - tiles.offset;
    int last_row = -1;
    for (int y = south - 1; y <= south + Tiles::side; ++y) {
      const int row = blocks.row_of(y);
      if (row == last_row) continue;
      last_row = row;
      int last_column = -1;
      for (int x = west - 1; x <= west + Tiles::side; ++x) {
        const int column = blocks.column_of(x);
        if (column == last_column) continue;
        last_column = column;
        raise_flag(ask + row * blocks.columns() + column);
      }
    }
  }
};

/// Whether a cell's excess (Excess) is over the tolerance, without a division. `inside`: it has all
/// neighbours beside it.
template <bool inside>
struct TooSteep {
  LevelView level;
  float tolerance;

  DESERT_HD Quanta lowest(int i, int x, int y, int first) const {
    Quanta low = wall_height;
    for (int k = first; k < first + 4; ++k) {
      const int j = inside ? i + Neighbours::dy(k) * level.grid.width + Neighbours::dx(k)
                           : neighbour_index(level.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      const Quanta h = inside || j >= 0 ? level.height(j) : wall_height;
      low = h < low ? h : low;
    }
    return low;
  }
  DESERT_HD bool operator()(int x, int y) const {
    constexpr float guard = 1.0f - 1e-4f;  // what Excess finds over the tolerance is never missed by rounding
    const int i = level.grid.index(x, y);
    const float least = guard * tolerance * level.quanta_per_cell, sand = static_cast<float>(level.sand[i]);
    if (!(sand > least) || level.wall(i)) return false;
    const Quanta h = level.height(i);
    const float drop = level.repose[i] * level.quanta_per_cell + least;
    constexpr float diagonal = Neighbours::distance(4);
    return static_cast<float>(h - lowest(i, x, y, 0)) > drop ||
           (static_cast<float>(h - lowest(i, x, y, 4)) > diagonal * drop && sand > diagonal * least);
  }
};

template <bool inside>
struct OpenNearUnsettled {
  TooSteep<inside> too_steep;
  const Quanta* ask;  ///< null: everywhere
  RoundOfTiles next;  ///< all 0
  Quanta* count;      ///< 0

  DESERT_HD void operator()(int x, int y) const {
    const Tiles blocks{next.grid, 0};
    if (ask && ask[y / Tiles::side * blocks.columns() + x / Tiles::side] == 0) return;
    if (!too_steep(x, y)) return;
    atomic_add(count, Quanta{1});
    for (int pass = 0; pass < passes_a_round; ++pass) {
      const Tiles tiles = next.of(pass);
      Quanta* of_pass = next.of_pass(pass);
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

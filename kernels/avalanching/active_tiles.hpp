#pragma once
/// Which tiles still have to be passed over, when most of the grid is at rest: those within reach of a cell
/// that is too steep. Found and kept on the device, by blocks of 8 × 8 cells:
///
///   tiles of the round's passes --AskAround--> blocks to ask --FindSteep--> blocks with too steep cells
///                                                            --OpenNear--> tiles of the next round
///
/// A cell that was at rest can only have become too steep in or beside a tile that has been passed over
/// since, so that after a round only the blocks around its tiles are asked.

#include "kernels/avalanching/steep_blocks.hpp"
#include "kernels/backend/buffer.hpp"

namespace desert_sim::avalanching {

/// Passes that follow each other before it is asked again what is too steep.
constexpr int passes_a_round = 4;

/// From a block with a cell that is too steep, tiles so many cells away are passed over too: slides come that
/// far.
constexpr int slides_reach = 4;
static_assert(Blocks::side + 2 * slides_reach <= Tiles::side,
              "far from edges a tile within reach then holds a corner of what is");

/// The tiles of a round's passes: 0 for one that need not be passed over.
struct RoundOfTiles {
  Grid grid;
  int offsets[passes_a_round];  ///< of the passes' seams
  Quanta* flags;                ///< a pass after the other
  int most_tiles;               ///< of a pass

  DESERT_HD Tiles of(int pass) const { return {grid, offsets[pass]}; }
  DESERT_HD Quanta* of_pass(int pass) const { return flags + static_cast<long long>(pass) * most_tiles; }

  /// Of each pass four, perhaps the same.
  static constexpr int corners = 4 * passes_a_round;
  /// The flags of the tiles of each pass that have a cell in a block, or at most `margin` cells from it,
  /// where all tiles there are whole: what is narrower than a tile has cells of those alone that its corners
  /// lie in. Nobody waits for one after the other. False if they may not be whole.
  DESERT_HD bool find_corners(int block_column, int block_row, int margin, Quanta* (&around)[corners]) const {
    const int west = block_column * Blocks::side - margin, south = block_row * Blocks::side - margin;
    const int last = Blocks::side + 2 * margin - 1;
    if (!are_whole(west, last, grid.width, grid.periodic_x) ||
        !are_whole(south, last, grid.height, grid.periodic_y))
      return false;
    for (int pass = 0; pass < passes_a_round; ++pass) {
      const int columns = of(pass).columns();
      for (int n = 0; n < 4; ++n) {
        const int column = tile_at(west + n % 2 * last + offsets[pass], grid.width);
        const int row = tile_at(south + n / 2 * last + offsets[pass], grid.height);
        around[4 * pass + n] = of_pass(pass) + row * columns + column;
      }
    }
    return true;
  }
  /// Calls body(flag) for each of them, wherever they lie.
  template <class Body>
  DESERT_HD void for_each_around(int block_column, int block_row, int margin, const Body& body) const {
    const int west = block_column * Blocks::side - margin, south = block_row * Blocks::side - margin;
    const int last = Blocks::side + 2 * margin - 1;
    // Tiles begin at multiples of four; but over a periodic edge, where the grid's width is none, anywhere.
    const int step = grid.width % 4 == 0 && grid.height % 4 == 0 ? 4 : 1;
    for (int pass = 0; pass < passes_a_round; ++pass) {
      const Tiles tiles = of(pass);
      int last_row = -1;
      for (int y = 0; y < last + step; y += step) {
        const int row = tiles.row_of(south + (y < last ? y : last));
        if (row == last_row) continue;
        last_row = row;
        int last_column = -1;
        for (int x = 0; x < last + step; x += step) {
          const int column = tiles.column_of(west + (x < last ? x : last));
          if (column != last_column) body(of_pass(pass) + row * tiles.columns() + column);
          last_column = column;
        }
      }
    }
  }

 private:
  /// Along an axis of n cells, far from its ends, or where tiles go on over them.
  DESERT_HD static bool are_whole(int first, int last, int n, bool periodic) {
    return (first >= Tiles::side && first + last < n - Tiles::side) || (periodic && n % Tiles::side == 0);
  }
  /// Of a cell's place, counted from where the tiles begin: without a division where it can be.
  DESERT_HD static int tile_at(int place, int n) {
    return (place >= 0 && place < n ? place : wrap(place, n)) / Tiles::side;
  }
};

/// A number that many add to at once, in several places, far enough from each other not to wait.
struct Tally {
  static constexpr int places = 64, apart = 32;
  static constexpr std::size_t size = places * apart;
  Quanta* parts;
  DESERT_HD void add(int place, Quanta n) const { atomic_add(&parts[place % places * apart], n); }
  DESERT_HD long long total() const {
    long long sum = 0;
    unrolled<places>([&](auto n)
                         DESERT_INLINE { sum += parts[n * apart]; });  // so that no load waits for another
    return sum;
  }
};

/// How far a step has come to rest, kept on the device.
struct Progress {
  long long sweeps;   ///< of the fine grid, of all steps, as if all tiles took as many as planned
  long long of_step;  ///< of these, of this step
  long long rounds;   ///< since the last cycle
  long long steep;    ///< blocks with cells too steep, after the last cycle
  long long more_rounds, more_cycles;  ///< whether there is to be another, 0 or 1
};

struct OpenTiles {
  Buffer<Quanta> ask;              ///< blocks that are to be asked
  Buffer<Quanta> found;            ///< what is found, in one piece, because all of it begins with 0: as below
  Buffer<Progress> progress;       ///< one
  int blocks = 0, most_tiles = 0;  ///< most_tiles: of a pass

  Tally tally() const { return {found.data()}; }                ///< of blocks with cells that are too steep
  Quanta* steep() const { return found.data() + Tally::size; }  ///< whether a block is one, 0 or 1
  Quanta* flags() const { return steep() + blocks; }            ///< of a round's tiles
};

inline OpenTiles make_open_tiles(Exec& exec, const Grid& grid) {
  const int most = Tiles{grid, Tiles::side - 1}.count(), blocks = Blocks{grid}.count();
  const std::size_t of_blocks = static_cast<std::size_t>(blocks),
                    of_tiles = static_cast<std::size_t>(passes_a_round) * static_cast<std::size_t>(most);
  OpenTiles open{Buffer<Quanta>(exec, of_blocks), Buffer<Quanta>(exec, Tally::size + of_blocks + of_tiles),
                 Buffer<Progress>(exec, 1), blocks, most};
  open.progress.set_zero();
  return open;
}

/// Whether a block has cells in, or beside, a tile that has been passed over: called for each block.
struct AskAround {
  RoundOfTiles passed;
  Quanta* ask;

  DESERT_HD void operator()(int column, int row) const {
    Quanta any = 0;
    Quanta* around[RoundOfTiles::corners];
    if (passed.find_corners(column, row, 1, around))
      for (const Quanta* open : around) any |= *open;
    else
      passed.for_each_around(column, row, 1, [&](const Quanta* open) { any |= *open; });
    ask[row * Blocks{passed.grid}.columns() + column] = any;
  }
};

/// Opens the next round's tiles within reach of what is too steep: called for each block.
struct OpenNear {
  const Quanta* steep;
  RoundOfTiles next;  ///< all 0
  Tally tally;        ///< all 0

  DESERT_HD void operator()(int column, int row) const {
    if (steep[row * Blocks{next.grid}.columns() + column] == 0) return;
    tally.add(column + row, 1);
    Quanta* around[RoundOfTiles::corners];
    if (!next.find_corners(column, row, slides_reach, around))
      return next.for_each_around(column, row, slides_reach, [](Quanta* open) {
        if (is_lowered(open)) raise_flag(open);
      });
    bool closed[RoundOfTiles::corners];
    for (int n = 0; n < RoundOfTiles::corners; ++n) closed[n] = is_lowered(around[n]);
    for (int n = 0; n < RoundOfTiles::corners; ++n)
      if (closed[n]) raise_flag(around[n]);
  }
};

/// What follows from what is too steep, as an item of one: nothing but the device needs to know it. Where the
/// first round after a cycle does not halve it, something large slides, which another cycle brings down
/// sooner, and more evenly to all sides. What remains of small slides later rounds take longer to halve, but
/// a cycle would start more of them.
struct Look {
  enum class After { first_cycle, cycle, round };  ///< first_cycle: of this step
  Progress* progress;
  Tally tally;
  int max_iterations;
  After after;
  int sweeps;  ///< done since the look before

  DESERT_HD void operator()(int) const {
    const long long steep = tally.total();
    if (after == After::first_cycle) progress->of_step = 0;
    if (after != After::round)
      progress->rounds = 0, progress->steep = steep;
    else
      ++progress->rounds;
    progress->of_step += sweeps;
    progress->sweeps += sweeps;
    const bool more = steep > 0 && progress->of_step < max_iterations;
    const bool large = progress->rounds == 1 && steep > progress->steep / 2;
    progress->more_rounds = more && !large;
    progress->more_cycles = more && large;
  }
};

}  // namespace desert_sim::avalanching

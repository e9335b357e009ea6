#pragma once
/// Active tiles: when most of the grid is at rest, only the tiles within reach of a cell that is too steep
/// are relaxed again. They are found and kept on the device, by way of blocks of 8 × 8 cells:
///
///   tiles of the last round  --MarkNeighbours-->  blocks to check
///   blocks to check          --FindSteep-->  blocks that have a cell which is too steep
///   those blocks             --ActivateTiles-->   tiles of the next round
///
/// A cell that was at rest can only have become too steep in or beside a tile that has been relaxed since, so
/// that after a round only the blocks around its tiles are checked.

#include "kernels/avalanching/steep_blocks.hpp"
#include "kernels/backend/buffer.hpp"

namespace desert_sim::avalanching {

/// Passes over the active tiles between two convergence checks.
constexpr int passes_per_round = 4;

/// Tiles up to this many cells away from a block that is too steep are activated, because slides reach that
/// far.
constexpr int activation_margin = 4;
static_assert(Blocks::side + 2 * activation_margin <= Tiles::side,
              "far from edges a tile within reach then holds a corner of what is");

/// Flags of the active tiles in each pass of a round; a tile with flag 0 is skipped.
struct ActiveTileFlags {
  Grid grid;
  int offsets[passes_per_round];  ///< of the tiles of each pass
  Quanta* flags;                  ///< those of each pass, one pass after the other
  int max_tiles;                  ///< flags of each pass

  DESERT_HD Tiles tiles_of_pass(int pass) const { return {grid, offsets[pass]}; }
  DESERT_HD Quanta* flags_of_pass(int pass) const { return flags + static_cast<long long>(pass) * max_tiles; }

  /// Four corners for each pass; some may lie in the same tile.
  static constexpr int corners = 4 * passes_per_round;
  /// Finds the flags of those tiles of each pass that have a cell within `margin` cells of a block, where all
  /// tiles around are complete. That square is narrower than a tile, so the tiles under its four corners are
  /// all of them, and their flags can be loaded without one load waiting for another. Returns false where
  /// tiles may be incomplete.
  DESERT_HD bool find_corner_flags(int block_column, int block_row, int margin,
                                   Quanta* (&corner_flags)[corners]) const {
    const int west = block_column * Blocks::side - margin, south = block_row * Blocks::side - margin;
    const int last = Blocks::side + 2 * margin - 1;
    if (!are_complete(west, last, grid.width, grid.periodic_x) ||
        !are_complete(south, last, grid.height, grid.periodic_y))
      return false;
    for (int pass = 0; pass < passes_per_round; ++pass) {
      const int columns = tiles_of_pass(pass).columns();
      for (int n = 0; n < 4; ++n) {
        const int column = tile_at(west + n % 2 * last + offsets[pass], grid.width);
        const int row = tile_at(south + n / 2 * last + offsets[pass], grid.height);
        corner_flags[4 * pass + n] = flags_of_pass(pass) + row * columns + column;
      }
    }
    return true;
  }
  /// Calls body(flag) for the flags of the same tiles, near edges of the grid too.
  template <class Body>
  DESERT_HD void for_each_nearby_flag(int block_column, int block_row, int margin, const Body& body) const {
    const int west = block_column * Blocks::side - margin, south = block_row * Blocks::side - margin;
    const int last = Blocks::side + 2 * margin - 1;
    // Tiles begin at multiples of four cells, but anywhere across a periodic edge if the grid's size is no
    // multiple of four.
    const int step = grid.width % 4 == 0 && grid.height % 4 == 0 ? 4 : 1;
    for (int pass = 0; pass < passes_per_round; ++pass) {
      const Tiles tiles = tiles_of_pass(pass);
      int last_row = -1;
      for (int y = 0; y < last + step; y += step) {
        const int row = tiles.row_of(south + (y < last ? y : last));
        if (row == last_row) continue;
        last_row = row;
        int last_column = -1;
        for (int x = 0; x < last + step; x += step) {
          const int column = tiles.column_of(west + (x < last ? x : last));
          if (column != last_column) body(flags_of_pass(pass) + row * tiles.columns() + column);
          last_column = column;
        }
      }
    }
  }

 private:
  /// Whether tiles from cell `first` to `first` + `last` are complete on an axis of n cells: they lie far
  /// from its ends, or the axis is periodic and a whole number of tiles long.
  DESERT_HD static bool are_complete(int first, int last, int n, bool periodic) {
    return (first >= Tiles::side && first + last < n - Tiles::side) || (periodic && n % Tiles::side == 0);
  }
  /// The tile of a cell, whose place counts from where the tiles begin. wrap(), which divides, is avoided if
  /// possible.
  DESERT_HD static int tile_at(int place, int n) {
    return (place >= 0 && place < n ? place : wrap(place, n)) / Tiles::side;
  }
};

/// A counter that many threads increment at once. It is spread over several words, far enough apart not to
/// contend for the same cache line.
struct StripedCounter {
  static constexpr int stripes = 64, word_stride = 32;
  static constexpr std::size_t size = stripes * word_stride;
  Quanta* words;
  DESERT_HD void add(int place, Quanta n) const { atomic_add(&words[place % stripes * word_stride], n); }
  DESERT_HD long long total() const {
    long long sum = 0;
    unrolled<stripes>(
        [&](auto n) DESERT_INLINE { sum += words[n * word_stride]; });  // loads do not wait for each other
    return sum;
  }
};

/// Progress of a step towards convergence, kept on the device.
struct Progress {
  long long sweeps;          ///< of the fine grid, in all steps, as if every tile took all planned ones
  long long sweeps_of_step;  ///< those of this step
  long long rounds;          ///< rounds since the last cycle
  long long steep;           ///< blocks with a cell that was too steep after the last cycle
  long long more_rounds, more_cycles;  ///< 1 if another one has to follow, else 0
};

struct ActiveTiles {
  Buffer<Quanta> blocks_to_check;  ///< flags of the blocks
  Buffer<Quanta> check_buffer;     ///< steep_counter(), steep() and flags(), which one call clears
  Buffer<Progress> progress;       ///< one element
  int blocks = 0, max_tiles = 0;   ///< max_tiles: in a pass

  /// Counts the blocks that are too steep.
  StripedCounter steep_counter() const { return {check_buffer.data()}; }
  /// 1 for a block that is too steep.
  Quanta* steep() const { return check_buffer.data() + StripedCounter::size; }
  /// Flags of the tiles of a round.
  Quanta* flags() const { return steep() + blocks; }
};

inline ActiveTiles make_active_tiles(Exec& exec, const Grid& grid) {
  const int max_tiles = Tiles{grid, Tiles::side - 1}.count(), blocks = Blocks{grid}.count();
  const auto block_flags = static_cast<std::size_t>(blocks);
  const auto tile_flags = static_cast<std::size_t>(passes_per_round) * static_cast<std::size_t>(max_tiles);
  ActiveTiles tiles{Buffer<Quanta>(exec, block_flags),
                    Buffer<Quanta>(exec, StripedCounter::size + block_flags + tile_flags),
                    Buffer<Progress>(exec, 1), blocks, max_tiles};
  tiles.progress.set_zero();
  return tiles;
}

/// Marks the blocks that have cells in, or beside, a tile that the last round has relaxed. Called for each
/// block.
struct MarkNeighbours {
  ActiveTileFlags last_round;
  Quanta* blocks_to_check;

  DESERT_HD void operator()(int column, int row) const {
    Quanta any = 0;
    Quanta* corner_flags[ActiveTileFlags::corners];
    if (last_round.find_corner_flags(column, row, 1, corner_flags))
      for (const Quanta* flag : corner_flags) any |= *flag;
    else
      last_round.for_each_nearby_flag(column, row, 1, [&](const Quanta* flag) { any |= *flag; });
    blocks_to_check[row * Blocks{last_round.grid}.columns() + column] = any;
  }
};

/// Activates the next round's tiles within reach of what is too steep. Called for each block.
struct ActivateTiles {
  const Quanta* steep;
  ActiveTileFlags next;          ///< all flags 0 before
  StripedCounter steep_counter;  ///< 0 before

  DESERT_HD void operator()(int column, int row) const {
    if (steep[row * Blocks{next.grid}.columns() + column] == 0) return;
    steep_counter.add(column + row, 1);
    Quanta* corner_flags[ActiveTileFlags::corners];
    if (!next.find_corner_flags(column, row, activation_margin, corner_flags))
      return next.for_each_nearby_flag(column, row, activation_margin, [](Quanta* flag) {
        if (is_flag_clear(flag)) set_flag(flag);
      });
    bool is_clear[ActiveTileFlags::corners];
    for (int n = 0; n < ActiveTileFlags::corners; ++n) is_clear[n] = is_flag_clear(corner_flags[n]);
    for (int n = 0; n < ActiveTileFlags::corners; ++n)
      if (is_clear[n]) set_flag(corner_flags[n]);
  }
};

/// The convergence check, as a loop over one item, so that its result stays on the device. If the first round
/// after a cycle does not halve the number of blocks that are too steep, something large is sliding, and
/// another cycle brings it down sooner and more evenly in all directions. Later rounds take longer to halve
/// what remains, but those are small slides, and a cycle would start more of them.
struct CheckConvergence {
  enum class After { first_cycle, cycle, round };  ///< first_cycle: the first one of this step
  Progress* progress;
  StripedCounter steep_counter;
  int max_iterations;
  After after;
  int sweeps;  ///< done since the check before

  DESERT_HD void operator()(int) const {
    const long long steep = steep_counter.total();
    if (after == After::first_cycle) progress->sweeps_of_step = 0;
    if (after != After::round)
      progress->rounds = 0, progress->steep = steep;
    else
      ++progress->rounds;
    progress->sweeps_of_step += sweeps;
    progress->sweeps += sweeps;
    const bool more = steep > 0 && progress->sweeps_of_step < max_iterations;
    const bool large = progress->rounds == 1 && steep > progress->steep / 2;
    progress->more_rounds = more && !large;
    progress->more_cycles = more && large;
  }
};

}  // namespace desert_sim::avalanching

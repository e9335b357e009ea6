#pragma once
/// Which tiles still have to be passed over, when most of the grid is at rest: those within reach of a cell
/// that is too steep. Found and kept on the device, by blocks of 8 × 8 cells:
///
///   tiles of the round's passes --AskAround--> blocks to ask --CountSteep--> too steep cells a block
///                                                            --OpenNear--> tiles of the next round
///
/// A cell that was at rest can only have become too steep in or beside a tile that has been passed over
/// since, so that after a round only the blocks around its tiles are asked. There are two sets of tiles, of
/// the last round and of the next, in turns.

#include "desert_sim/kernels/avalanching_laws.hpp"
#include "desert_sim/kernels/buffer.hpp"

namespace desert_sim::avalanching {

/// Passes that follow each other before it is asked again what is too steep.
constexpr int passes_a_round = 4;

/// Blocks of cells.
struct Blocks {
  static constexpr int side = 8;
  Grid grid;

  DESERT_HD int columns() const { return (grid.width + side - 1) / side; }
  DESERT_HD int rows() const { return (grid.height + side - 1) / side; }
  DESERT_HD int count() const { return columns() * rows(); }
  DESERT_HD Grid cells() const { return {columns(), rows(), 1}; }
  DESERT_HD int of_cell(int x, int y) const { return y / side * columns() + x / side; }
};

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

  /// Calls body(flag) for each tile of each pass that has a cell in a block, or at most `margin` cells from
  /// it.
  template <class Body>
  DESERT_HD void for_each_around(int block_column, int block_row, int margin, const Body& body) const {
    const int west = block_column * Blocks::side - margin, south = block_row * Blocks::side - margin;
    const int last = Blocks::side + 2 * margin - 1;
    // Tiles begin at multiples of four; but over a periodic edge, where the grid's width is none, anywhere.
    const bool fours = grid.width % 4 == 0 && grid.height % 4 == 0;
    // What is narrower than a tile holds one of its ends, if no tile is cut off by the grid's edge there.
    const bool far = is_far(west, last, grid.width) && is_far(south, last, grid.height);
    const int step = far ? last : (fours ? 4 : 1);
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
  /// From the edges of an axis of n cells.
  DESERT_HD static bool is_far(int first, int last, int n) {
    return first >= Tiles::side && first + last < n - Tiles::side;
  }
};

/// A number that many add to at once, in several places, far enough from each other not to wait.
struct Tally {
  static constexpr int places = 16, apart = 32;
  static constexpr std::size_t size = places * apart;
  Quanta* parts;
  /// The nth after this one.
  DESERT_HD Tally after(int n) const { return {parts + n * size}; }
  DESERT_HD void add(int place, Quanta n) const { atomic_add(&parts[place % places * apart], n); }
  DESERT_HD long long total() const {
    long long sum = 0;
    for (int n = 0; n < places; ++n) sum += parts[n * apart];
    return sum;
  }
};

/// How far a step has come to rest, kept on the device.
struct Progress {
  long long sweeps;                    ///< of the fine grid, of all steps; at least, where tiles may go on
  long long of_step;                   ///< of these, of this step
  long long steep;                     ///< cells that are too steep, at the last look
  long long more_rounds, more_cycles;  ///< whether there is to be another, 0 or 1
};

struct OpenTiles {
  Buffer<Quanta> flags;       ///< of two rounds
  Buffer<Quanta> steep;       ///< cells of each block that are too steep
  Buffer<Quanta> ask;         ///< blocks that are to be asked
  Buffer<Quanta> tallies;     ///< of cells that are too steep, of rounds that follow each other
  Buffer<Progress> progress;  ///< one
  int most_tiles = 0;         ///< of a pass

  Quanta* of_round(int round) const {
    return flags.data() + static_cast<std::size_t>(round % 2) * passes_a_round * most_tiles;
  }
  Tally tally(int round) const { return Tally{tallies.data()}.after(round); }
};

inline OpenTiles make_open_tiles(Exec& exec, const Grid& grid, int rounds) {
  const std::size_t most = static_cast<std::size_t>(Tiles{grid, Tiles::side - 1}.count());
  const std::size_t blocks = static_cast<std::size_t>(Blocks{grid}.count());
  OpenTiles open{Buffer<Quanta>(exec, 2 * passes_a_round * most),
                 Buffer<Quanta>(exec, blocks),
                 Buffer<Quanta>(exec, blocks),
                 Buffer<Quanta>(exec, static_cast<std::size_t>(rounds) * Tally::size),
                 Buffer<Progress>(exec, 1),
                 static_cast<int>(most)};
  open.progress.set_zero();
  return open;
}

/// Whether a block has cells in, or beside, a tile that has been passed over: called for each block.
struct AskAround {
  RoundOfTiles passed;
  Quanta* ask;

  DESERT_HD void operator()(int column, int row) const {
    Quanta any = 0;
    passed.for_each_around(column, row, 1, [&](const Quanta* open) { any |= *open; });
    ask[row * Blocks{passed.grid}.columns() + column] = any;
  }
};

/// Whether a cell's excess (Excess) is over the tolerance, without a division.
struct TooSteep {
  LevelView level;
  float tolerance;

  /// Of cell i, `height` high; the lowest of its straight and of its diagonal neighbours.
  DESERT_HD bool operator()(int i, Quanta height, Quanta straight, Quanta diagonal) const {
    constexpr float guard = 1.0f - 1e-4f;  // what Excess finds over the tolerance is never missed by rounding
    constexpr float far = Neighbours::distance(4);
    const float least = guard * tolerance * level.quanta_per_cell, sand = static_cast<float>(level.sand[i]);
    const float drop = level.repose[i] * level.quanta_per_cell + least;
    return height < wall_height && sand > least &&
           (static_cast<float>(height - straight) > drop ||
            (static_cast<float>(height - diagonal) > far * drop && sand > far * least));
  }
  /// Of a cell that may lack neighbours.
  DESERT_HD bool operator()(int x, int y) const {
    Quanta lowest[2] = {wall_height, wall_height};
    for (int k = 0; k < Neighbours::count; ++k) {
      const int j = neighbour_index(level.grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      const Quanta h = j >= 0 ? level.height(j) : wall_height;
      lowest[k / 4] = h < lowest[k / 4] ? h : lowest[k / 4];
    }
    const int i = level.grid.index(x, y);
    return (*this)(i, level.height(i), lowest[0], lowest[1]);
  }
};

/// Called for strips of cells above each other, which share what they look at.
struct CountSteep {
  static constexpr int strip = 4;
  static_assert(Blocks::side % strip == 0, "then a strip lies in one block");
  TooSteep too_steep;
  const Quanta* ask;  ///< null: everywhere
  Quanta* steep;      ///< all 0

  DESERT_HD Grid strips() const {
    const Grid& g = too_steep.level.grid;
    return {g.width, (g.height + strip - 1) / strip, 1};
  }
  DESERT_HD void operator()(int x, int n) const {
    const Grid& g = too_steep.level.grid;
    const int first = strip * n, block = Blocks{g}.of_cell(x, first);
    if (ask && ask[block] == 0) return;
    Quanta found = 0;
    if (x > 0 && x + 1 < g.width && first > 0 && first + strip < g.height) {
      found = count_inside(g.index(x, first));
    } else {
      for (int y = first; y < first + strip && y < g.height; ++y) found += too_steep(x, y) ? 1 : 0;
    }
    if (found > 0) atomic_add(&steep[block], found);
  }

 private:
  /// Of a strip that begins with cell i and has all neighbours.
  DESERT_HD Quanta count_inside(int i) const {
    const LevelView& level = too_steep.level;
    Quanta middle[strip + 2], beside[strip + 2];  // of the rows from the one before the strip on
    for (int row = 0; row < strip + 2; ++row) {
      const int j = i + (row - 1) * level.grid.width;
      const Quanta west = level.height(j - 1), east = level.height(j + 1);
      middle[row] = level.height(j);
      beside[row] = lower(west, east);
    }
    Quanta found = 0;
    for (int row = 1; row <= strip; ++row)
      found += too_steep(i + (row - 1) * level.grid.width, middle[row],
                         lower(beside[row], lower(middle[row - 1], middle[row + 1])),
                         lower(beside[row - 1], beside[row + 1]))
                   ? 1
                   : 0;
    return found;
  }
  DESERT_HD static Quanta lower(Quanta a, Quanta b) { return a < b ? a : b; }
};

/// Opens the next round's tiles within reach of what is too steep: called for each block.
struct OpenNear {
  const Quanta* steep;
  RoundOfTiles next;  ///< all 0
  Tally tally;        ///< all 0

  DESERT_HD void operator()(int column, int row) const {
    const Quanta cells = steep[row * Blocks{next.grid}.columns() + column];
    if (cells == 0) return;
    tally.add(column + row, cells);
    next.for_each_around(column, row, slides_reach, [](Quanta* open) { raise_flag(open); });
  }
};

/// What follows from what is too steep, as items of one: nothing but the device needs to know it.
struct Look {
  Progress* progress;
  Tally tallies;  ///< `rounds` + 1 that follow each other: before the rounds, and after each
  int max_iterations;
  int rounds, sweeps_a_round;

  DESERT_HD void count(int sweeps) const {
    progress->sweeps += sweeps;
    progress->of_step += sweeps;
  }
  DESERT_HD void decide(bool much) const {
    const bool more = progress->steep > 0 && progress->of_step < max_iterations;
    progress->more_rounds = more && !much;
    progress->more_cycles = more && much;
  }
};
/// Before a step's first cycle.
struct LookAhead : Look {
  DESERT_HD void operator()(int) const { progress->of_step = 0; }
};
/// After a cycle, of `sweeps` fine sweeps.
struct LookAfterCycle : Look {
  int sweeps;
  DESERT_HD void operator()(int) const {
    count(sweeps);
    progress->steep = tallies.total();
    decide(false);
  }
};
/// After rounds; those that found something count. Where they do not halve what is too steep, something large
/// slides, and it takes another cycle.
struct LookAfterRounds : Look {
  DESERT_HD void operator()(int) const {
    long long before = progress->steep;
    const long long half = before / 2;
    for (int round = 1; round <= rounds; ++round) {
      if (before > 0) count(sweeps_a_round);
      before = tallies.after(round).total();
    }
    progress->steep = before;
    decide(before > half);
  }
};

}  // namespace desert_sim::avalanching

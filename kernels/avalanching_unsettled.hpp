#pragma once
/// Which tiles still have to be passed over, when most of the grid is at rest: those within reach of a cell
/// that is too steep. Found and kept on the device, by blocks of 8 × 8 cells:
///
///   tiles of the round's passes --AskAround--> blocks to ask --FindSteep--> blocks with too steep cells
///                                                            --OpenNear--> tiles of the next round
///
/// A cell that was at rest can only have become too steep in or beside a tile that has been passed over
/// since, so that after a round only the blocks around its tiles are asked.

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

/// How far a step has come to rest, kept on the device.
struct Progress {
  long long sweeps;       ///< of the fine grid, of all steps, as if all tiles took as many as planned
  long long of_step;      ///< of these, of this step
  long long more_rounds;  ///< whether there is to be another, 0 or 1
};

struct OpenTiles {
  Buffer<Quanta> ask;              ///< blocks that are to be asked
  Buffer<Quanta> found;            ///< what is found, in one piece, because all of it begins with 0: as below
  Buffer<Progress> progress;       ///< one
  int blocks = 0, most_tiles = 0;  ///< most_tiles: of a pass

  Quanta* any() const { return found.data(); }        ///< whether a cell is too steep, 0 or 1
  Quanta* steep() const { return any() + 1; }         ///< likewise in each block
  Quanta* flags() const { return steep() + blocks; }  ///< of a round's tiles
};

inline OpenTiles make_open_tiles(Exec& exec, const Grid& grid) {
  const int most = Tiles{grid, Tiles::side - 1}.count(), blocks = Blocks{grid}.count();
  const std::size_t of_blocks = static_cast<std::size_t>(blocks),
                    of_tiles = static_cast<std::size_t>(passes_a_round) * static_cast<std::size_t>(most);
  OpenTiles open{Buffer<Quanta>(exec, of_blocks), Buffer<Quanta>(exec, 1 + of_blocks + of_tiles),
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

/// Whether a cell's excess (Excess) is over the tolerance, without a division.
struct TooSteep {
  LevelView level;
  float tolerance;

  /// Of a cell; `straight`, `diagonal`: the lowest of its neighbours.
  DESERT_HD bool operator()(Quanta height, Quanta sand, float repose, Quanta straight,
                            Quanta diagonal) const {
    constexpr float guard = 1.0f - 1e-4f;  // what Excess finds over the tolerance is never missed by rounding
    constexpr float far = Neighbours::distance(4);
    const float least = guard * tolerance * level.quanta_per_cell, available = static_cast<float>(sand);
    const float drop = repose * level.quanta_per_cell + least;
    return height < wall_height && available > least &&
           (static_cast<float>(height - straight) > drop ||
            (static_cast<float>(height - diagonal) > far * drop && available > far * least));
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
    return (*this)(level.height(i), level.sand[i], level.repose[i], lowest[0], lowest[1]);
  }
};

/// Called for squares of cells, which share what they look at.
struct FindSteep {
  static constexpr int side = 4;
  static_assert(Blocks::side % side == 0, "then a square lies in one block");
  TooSteep too_steep;
  const Quanta* ask;  ///< null: everywhere
  Quanta* steep;      ///< all 0

  DESERT_HD Grid squares() const {
    const Grid& g = too_steep.level.grid;
    return {(g.width + side - 1) / side, (g.height + side - 1) / side, 1};
  }
  DESERT_HD void operator()(int column, int row) const {
    const Grid& g = too_steep.level.grid;
    const int west = side * column, south = side * row, block = Blocks{g}.of_cell(west, south);
    if (ask && ask[block] == 0) return;
    if (g.width % side == 0 ? is_any_of_fours(west, south) : is_any(west, south)) raise_flag(&steep[block]);
  }

 private:
  /// A row of a square, with the cells west and east of it.
  struct Row {
    Quanta heights[side + 2];
    Four<Quanta> sand;
    /// The lower one of the two beside the nth cell.
    DESERT_HD Quanta beside(int n) const { return lower(heights[n], heights[n + 2]); }
  };
  /// A place on an axis, or one that is next to the axis: −1 if nothing is there.
  DESERT_HD static int place(int p, int cells, bool periodic) {
    if (p >= 0 && p < cells) return p;
    return periodic ? wrap(p, cells) : -1;
  }
  /// From column x on, between columns `before` and `after`, if these are there; of walls if y is not. Loads
  /// wait for no answer.
  DESERT_HD Row row_at(int before, int x, int after, int y) const {
    const LevelView& level = too_steep.level;
    const int first = level.grid.index(0, y >= 0 ? y : 0);
    Row row;
    row.sand = four_at(static_cast<const Quanta*>(level.sand) + first + x);
    const Four<Quanta> ground = four_at(level.ground + first + x);
    row.heights[0] = level.height(first + (before >= 0 ? before : x));
    row.heights[side + 1] = level.height(first + (after >= 0 ? after : x));
    for (int n = 0; n < side; ++n) {
      const Quanta top = ground.values[n];
      row.heights[n + 1] = level.soil || level.obstacle
                               ? level.height(first + x + n)
                               : (top >= wall_height ? wall_height : top + row.sand.values[n]);
    }
    if (before < 0) row.heights[0] = wall_height;
    if (after < 0) row.heights[side + 1] = wall_height;
    if (y < 0)
      for (Quanta& height : row.heights) height = wall_height;
    return row;
  }
  /// In the square whose south-west corner is (x, y).
  DESERT_HD bool is_any(int west, int south) const {
    const Grid& g = too_steep.level.grid;
    for (int y = south; y < south + side && y < g.height; ++y)
      for (int x = west; x < west + side && x < g.width; ++x)
        if (too_steep(x, y)) return true;
    return false;
  }
  /// Likewise where rows are whole.
  DESERT_HD bool is_any_of_fours(int x, int y) const {
    const LevelView& level = too_steep.level;
    const Grid& g = level.grid;
    const int before = place(x - 1, g.width, g.periodic_x), after = place(x + side, g.width, g.periodic_x);
    const auto row_number = [&](int n) {
      const int there = y + n <= g.height ? place(y + n, g.height, g.periodic_y) : -1;
      return row_at(before, x, after, there);
    };
    bool any = false;
    Row below = row_number(-1), row = row_number(0);
    for (int n = 0; n < side; ++n) {
      if (y + n >= g.height) break;
      const Row above = row_number(n + 1);
      const Four<float> repose = four_at(level.repose + g.index(x, y + n));
      for (int k = 0; k < side; ++k)
        any = any || too_steep(row.heights[k + 1], row.sand.values[k], repose.values[k],
                               lower(row.beside(k), lower(below.heights[k + 1], above.heights[k + 1])),
                               lower(below.beside(k), above.beside(k)));
      below = row;
      row = above;
    }
    return any;
  }
  DESERT_HD static Quanta lower(Quanta a, Quanta b) { return a < b ? a : b; }
};

/// Opens the next round's tiles within reach of what is too steep: called for each block.
struct OpenNear {
  const Quanta* steep;
  RoundOfTiles next;  ///< all 0
  Quanta* any;        ///< 0

  DESERT_HD void operator()(int column, int row) const {
    if (steep[row * Blocks{next.grid}.columns() + column] == 0) return;
    if (is_lowered(any)) raise_flag(any);
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

/// What follows from what is too steep, as an item of one: nothing but the device needs to know it.
struct Look {
  Progress* progress;
  const Quanta* any;
  int max_iterations;
  int sweeps;     ///< done since the look before
  bool is_first;  ///< of this step

  DESERT_HD void operator()(int) const {
    if (is_first) progress->of_step = 0;
    progress->of_step += sweeps;
    progress->sweeps += sweeps;
    progress->more_rounds = *any != 0 && progress->of_step < max_iterations;
  }
};

}  // namespace desert_sim::avalanching

#pragma once
/// Finds the blocks of 8 × 8 cells that have a cell which is too steep. Each call checks a square of 4 × 4
/// cells, which share the heights that they compare: those of six rows of six cells.

#include "kernels/avalanching/laws.hpp"

namespace desert_sim::avalanching {

/// The grid divided into square blocks of cells.
struct Blocks {
  static constexpr int side = 8;
  Grid grid;

  DESERT_HD int columns() const { return (grid.width + side - 1) / side; }
  DESERT_HD int rows() const { return (grid.height + side - 1) / side; }
  DESERT_HD int count() const { return columns() * rows(); }
  DESERT_HD Grid cells() const { return {columns(), rows(), 1}; }
  DESERT_HD int of_cell(int x, int y) const { return y / side * columns() + x / side; }
};

/// Whether a cell's excess (Excess in laws.hpp) is over the tolerance, computed without a division.
struct TooSteep {
  LevelView level;
  float tolerance;

  /// `straight`, `diagonal`: height of the lowest neighbour in a row or column, and of the lowest diagonal
  /// one.
  DESERT_HD bool operator()(Quanta height, Quanta sand, float repose, Quanta straight,
                            Quanta diagonal) const {
    constexpr float guard = 1.0f - 1e-4f;  // rounding must not miss what Excess finds over the tolerance
    constexpr float far = Neighbours::distance(4);
    const float least = guard * tolerance * level.quanta_per_cell, available = static_cast<float>(sand);
    const float drop = repose * level.quanta_per_cell + least;
    return height < wall_height && available > least &&
           (static_cast<float>(height - straight) > drop ||
            (static_cast<float>(height - diagonal) > far * drop && available > far * least));
  }
  /// For a cell of which some neighbours may not exist.
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

/// Flags the blocks that are too steep. Called for each square of 4 × 4 cells.
struct FindSteep {
  static constexpr int side = 4;
  static_assert(Blocks::side % side == 0, "then a square lies in one block");
  TooSteep too_steep;
  const Quanta* blocks_to_check;  ///< flags of the blocks to check; null: all
  Quanta* steep;                  ///< flags of the blocks, all 0 before
  bool by_gradient = false;       ///< by quads, each of which counts where its south-west cell lies

  DESERT_HD Grid squares() const {
    const Grid& g = too_steep.level.grid;
    return {(g.width + side - 1) / side, (g.height + side - 1) / side, 1};
  }
  DESERT_HD void operator()(int column, int row) const {
    const Grid& g = too_steep.level.grid;
    const int west = side * column, south = side * row, block = Blocks{g}.of_cell(west, south);
    if (blocks_to_check && blocks_to_check[block] == 0) return;
    const bool found = by_gradient           ? is_any_quad_too_steep(west, south)
                       : g.width % side == 0 ? is_any_too_steep_by_fours(west, south)
                                             : is_any_too_steep(west, south);
    if (found) set_flag(&steep[block]);
  }

 private:
  /// A row of a square, with the cells west and east of it.
  struct Row {
    Quanta heights[side + 2];
    Vec4<Quanta> sand;
    /// The lower one of the heights west and east of the nth cell.
    DESERT_HD Quanta lower_side(int n) const { return lower(heights[n], heights[n + 2]); }
  };
  /// Index of a place on an axis or next to its ends; −1 where there is no cell.
  DESERT_HD static int index_on_axis(int p, int cells, bool periodic) {
    if (p >= 0 && p < cells) return p;
    return periodic ? wrap(p, cells) : -1;
  }
  /// Row y from column x on, with columns `before` and `after`. An index of −1 stands for a wall: its value
  /// is loaded from another cell and replaced afterwards, so that no load waits for a comparison.
  DESERT_HD Row row_at(int before, int x, int after, int y) const {
    const LevelView& level = too_steep.level;
    const int first = level.grid.index(0, y >= 0 ? y : 0);
    Row row;
    row.sand = load_vec4(static_cast<const Quanta*>(level.sand) + first + x);
    const Vec4<Quanta> ground = load_vec4(level.ground + first + x);
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
  /// Whether a cell is too steep in the square whose south-west corner is (west, south).
  DESERT_HD bool is_any_too_steep(int west, int south) const {
    const Grid& g = too_steep.level.grid;
    for (int y = south; y < south + side && y < g.height; ++y)
      for (int x = west; x < west + side && x < g.width; ++x)
        if (too_steep(x, y)) return true;
    return false;
  }
  DESERT_HD bool is_any_quad_too_steep(int west, int south) const {
    const Grid& g = too_steep.level.grid;
    const QuadExcess excess{too_steep.level};
    for (int y = south; y < south + side && y < g.height; ++y)
      for (int x = west; x < west + side && x < g.width; ++x)
        if (excess(x, y) > too_steep.tolerance) return true;
    return false;
  }
  /// The same for grids whose width is a multiple of four, with loads of four values at a time.
  DESERT_HD bool is_any_too_steep_by_fours(int x, int y) const {
    const LevelView& level = too_steep.level;
    const Grid& g = level.grid;
    const int before = index_on_axis(x - 1, g.width, g.periodic_x),
              after = index_on_axis(x + side, g.width, g.periodic_x);
    const auto load_row = [&](int n) {
      return row_at(before, x, after, index_on_axis(y + n, g.height, g.periodic_y));
    };
    bool any = false;
    Row below = load_row(-1), row = load_row(0);
    for (int n = 0; n < side; ++n) {
      if (y + n >= g.height) break;
      const Row above = load_row(n + 1);
      const Vec4<float> repose = load_vec4(level.repose + g.index(x, y + n));
      for (int k = 0; k < side; ++k)
        any = any || too_steep(row.heights[k + 1], row.sand.values[k], repose.values[k],
                               lower(row.lower_side(k), lower(below.heights[k + 1], above.heights[k + 1])),
                               lower(below.lower_side(k), above.lower_side(k)));
      below = row;
      row = above;
    }
    return any;
  }
  DESERT_HD static Quanta lower(Quanta a, Quanta b) { return a < b ? a : b; }
};

}  // namespace desert_sim::avalanching

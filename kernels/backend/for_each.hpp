#pragma once
/// Loops over cells and tiles, the same call on both backends:
///
///     for_each_cell(exec, grid, law);              // law(x, y)
///     for_each_cell_adding(exec, grid, sums, law); // sums[n] = Σ of what cells send to cell n
///     for_each_tile(exec, tiles, law);             // law(team, column, row): a team works on a tile
///     for_each_item(exec, count, law);             // law(n): items in a row
///     for_each_cell_of_rows(exec, grid, first, rows, law);  // law(x, y): rows first … , over the north edge
///     sum_cells(exec, grid, law) -> long long      // Σ law(x, y), exact
///     max_cells(exec, grid, law) -> float          // max of 0 and law(x, y)
///
/// Cells of for_each_cell() must not depend on each other: a CPU works on several of a row at once.
///
/// A law that sends amounts to other cells has two parts: law.prepare(x, y, parcels, n) fills the n-th of
/// Law::Parcels<count>, which is made of arrays, and law.deliver(x, y, parcels, n, add) sends that, with
/// add(cell, amount), or add.square(…) for four cells beside and above each other. A CPU prepares several
/// cells at once. Neither part reads `sums`.
///
/// The CPU's are in for_each_cpu.hpp, the GPU's in for_each_cuda.cuh; only the backends include them.

#include <type_traits>

#include "kernels/backend/atomics.hpp"
#include "kernels/backend/exec.hpp"
#include "kernels/field/grid.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim {

/// A law for cells at least `margin` cells away from every edge of the grid, and one for the others.
template <class Inside, class Border>
struct Bordered {
  Grid grid;
  int margin;
  Inside inside;
  Border border;

  DESERT_HD bool is_inside(int n, int cells) const { return n >= margin && n < cells - margin; }
  DESERT_HD void operator()(int x, int y) const {
    if (is_inside(x, grid.width) && is_inside(y, grid.height))
      inside(x, y);
    else
      border(x, y);
  }
};

/// A law on a band of rows: it is called for rows that begin with `first`, and go on over the edge.
template <class Law>
struct OnRows {
  Law law;
  int first, height;
  DESERT_HD void operator()(int x, int y) const { law(x, wrap(first + y, height)); }
};
template <class E, class Law>
void for_each_cell_of_rows(E& exec, const Grid& grid, int first, int rows, const Law& law) {
  Grid band = grid;
  band.height = rows;
  for_each_cell(exec, band, OnRows<Law>{law, first, grid.height});
}

/// body(n) for n = 0 … count − 1 as compile-time constants: loops over cells vectorise only around straight
/// code.
template <int count, class Body>
DESERT_HD void unrolled(const Body& body) {
  if constexpr (count > 0) {
    unrolled<count - 1>(body);
    body(std::integral_constant<int, count - 1>());
  }
}

/// Whether a backend works on cells beside each other at once, as vectors: there, what a cell shares with the
/// one above it is not worth a loop.
template <class E>
constexpr bool works_on_rows = std::is_same_v<E, CpuExec>;

/// Square tiles over a grid, shifted by an offset so that the seams of one pass lie inside the tiles of the
/// next.
struct Tiles {
  static constexpr int side = 32;
  Grid grid;
  int offset = 0;  ///< 0 … side−1: the first tile begins at −offset

  /// Along a periodic axis the first tile also has the last cells, `offset` of them.
  DESERT_HD int across(int cells, bool periodic) const {
    return (cells + (periodic ? 0 : offset) + side - 1) / side;
  }
  DESERT_HD int columns() const { return across(grid.width, grid.periodic_x); }
  DESERT_HD int rows() const { return across(grid.height, grid.periodic_y); }
  DESERT_HD int count() const { return columns() * rows(); }
  /// The column, and the row, of the tile that cell (x, y) lies in. Beyond the grid: of the cell that stands
  /// for it.
  DESERT_HD int column_of(int x) const { return along(x, grid.width, grid.periodic_x); }
  DESERT_HD int row_of(int y) const { return along(y, grid.height, grid.periodic_y); }

 private:
  DESERT_HD int along(int n, int cells, bool periodic) const {
    return (periodic ? wrap(n + offset, cells) : clamp_index(n, cells) + offset) / side;
  }
};

}  // namespace desert_sim

#pragma once
/// Material that is carried from a cell and comes down between four: shared among them bilinearly, in whole
/// quanta, of which none is lost. What for_each_cell_adding() works with.

#include "kernels/backend/for_each.hpp"
#include "kernels/field/ledger.hpp"
#include "kernels/field/quanta.hpp"

namespace desert_sim {

/// Of several cells: where each cell's comes down, (x, y) and the next ones to the east and north, and each
/// one's share.
template <int count>
struct Carried {
  int x[count], y[count];
  Quanta amount[count];
  Quanta south_west[count], south_east[count], north_west[count], north_east[count];

  /// From cell (cell_x, cell_y), by (dx, dy) subcells.
  DESERT_HD void set(int n, int cell_x, int cell_y, int dx, int dy, Quanta carried) {
    const int east = dx & 65535, north = dy & 65535, west = subcell_one - east, south = subcell_one - north;
    x[n] = cell_x + (dx >> 16);
    y[n] = cell_y + (dy >> 16);
    amount[n] = carried;
    south_west[n] = bilinear_share(carried, west, south);
    south_east[n] = bilinear_share(carried, east, south);
    north_west[n] = bilinear_share(carried, west, north);
    north_east[n] = bilinear_share(carried, east, north);
    // What rounding leaves, at most three quanta, to the nearest; mirrored, that is the mirrored one.
    const Quanta rest = left(n), eastern = east > west ? rest : 0, western = east < west ? rest : 0;
    south_west[n] += south > north ? western : 0;
    south_east[n] += south > north ? eastern : 0;
    north_west[n] += south < north ? western : 0;
    north_east[n] += south < north ? eastern : 0;
  }
  /// Where none is the nearest, that stays in the cell: then no direction is favoured either.
  DESERT_HD Quanta left(int n) const {
    return amount[n] - south_west[n] - south_east[n] - north_west[n] - north_east[n];
  }
};

/// Where carried material goes; over an open edge, into the books.
struct Landing {
  Grid grid;
  Material material;
  LedgerView ledger;

  template <class Add>
  DESERT_HD void land(int from, int x, int y, Quanta amount, const Add& add) const {
    const int to = neighbour_index(grid, x, y);
    if (to >= 0)
      add(to, amount);
    else
      ledger.book_out(material, from, amount);
  }

  /// What cell (x, y) sends, the nth of `parcels`.
  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const Carried<count>& parcels, int n, const Add& add) const {
    if (parcels.amount[n] == 0) return;
    const int i = grid.index(x, y), at_x = parcels.x[n], at_y = parcels.y[n];
    if (grid.inside(at_x, at_y) && grid.inside(at_x + 1, at_y + 1)) {
      add.square(grid.index(at_x, at_y), grid.width, parcels.south_west[n], parcels.south_east[n],
                 parcels.north_west[n], parcels.north_east[n]);
    } else {
      land(i, at_x, at_y, parcels.south_west[n], add);
      land(i, at_x + 1, at_y, parcels.south_east[n], add);
      land(i, at_x, at_y + 1, parcels.north_west[n], add);
      land(i, at_x + 1, at_y + 1, parcels.north_east[n], add);
    }
    add(i, parcels.left(n));
  }
};

}  // namespace desert_sim

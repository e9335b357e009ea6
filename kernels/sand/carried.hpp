#pragma once
/// Transported material is scattered bilinearly to the four cells around its landing point, in whole quanta,
/// so that mass is conserved exactly. Laws of for_each_cell_scatter() use these parcels.

#include "kernels/backend/for_each.hpp"
#include "kernels/base/quanta.hpp"
#include "kernels/field/ledger.hpp"

namespace desert_sim {

/// Parcels of `count` cells, as a structure of arrays. A landing point lies between cell (x, y) and its
/// neighbours to the east, north and north-east; each of the four gets its share of `amount`.
template <int count>
struct BilinearParcels {
  int x[count], y[count];
  Quanta amount[count];
  Quanta south_west[count], south_east[count], north_west[count], north_east[count];

  /// Fills parcel n, which is carried from cell (cell_x, cell_y) by (dx, dy) [cells, 16.16 fixed point].
  DESERT_HD void set(int n, int cell_x, int cell_y, int dx, int dy, Quanta carried) {
    const int east = dx & 65535, north = dy & 65535, west = fixed_point_one - east,
              south = fixed_point_one - north;
    x[n] = cell_x + (dx >> 16);
    y[n] = cell_y + (dy >> 16);
    amount[n] = carried;
    south_west[n] = bilinear_share(carried, west, south);
    south_east[n] = bilinear_share(carried, east, south);
    north_west[n] = bilinear_share(carried, west, north);
    north_east[n] = bilinear_share(carried, east, north);
    // The remainder of rounding, at most three quanta, goes to the nearest cell. In mirrored terrain that is
    // the mirrored cell.
    const Quanta rest = unshared(n), eastern = east > west ? rest : 0, western = east < west ? rest : 0;
    south_west[n] += south > north ? western : 0;
    south_east[n] += south > north ? eastern : 0;
    north_west[n] += south < north ? western : 0;
    north_east[n] += south < north ? eastern : 0;
  }
  /// What the four shares leave of the amount. After set() it is 0, except where no cell is the nearest: then
  /// the remainder stays in the source cell, so that no direction is favoured.
  DESERT_HD Quanta unshared(int n) const {
    return amount[n] - south_west[n] - south_east[n] - north_west[n] - north_east[n];
  }
};

/// Delivers parcels to their cells; what crosses an open edge is recorded in the ledger as outflow.
struct ParcelDelivery {
  Grid grid;
  Material material;
  LedgerView ledger;

  template <class Add>
  DESERT_HD void add_to_cell(int from, int x, int y, Quanta amount, const Add& add) const {
    const int to = neighbour_index(grid, x, y);
    if (to >= 0)
      add(to, amount);
    else
      ledger.book_out(material, from, amount);
  }

  /// Delivers the n-th of `parcels`, which cell (x, y) sends.
  template <int count, class Add>
  DESERT_HD void deliver(int x, int y, const BilinearParcels<count>& parcels, int n, const Add& add) const {
    if (parcels.amount[n] == 0) return;
    const int i = grid.index(x, y), at_x = parcels.x[n], at_y = parcels.y[n];
    if (grid.inside(at_x, at_y) && grid.inside(at_x + 1, at_y + 1)) {
      add.square(grid.index(at_x, at_y), grid.width, parcels.south_west[n], parcels.south_east[n],
                 parcels.north_west[n], parcels.north_east[n]);
    } else {
      add_to_cell(i, at_x, at_y, parcels.south_west[n], add);
      add_to_cell(i, at_x + 1, at_y, parcels.south_east[n], add);
      add_to_cell(i, at_x, at_y + 1, parcels.north_west[n], add);
      add_to_cell(i, at_x + 1, at_y + 1, parcels.north_east[n], add);
    }
    add(i, parcels.unshared(n));
  }
};

}  // namespace desert_sim

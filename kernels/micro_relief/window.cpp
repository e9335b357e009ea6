/// The laws of window.hpp; compiled once for each backend.
#include "kernels/micro_relief/window.hpp"

#include "kernels/backend/loops.hpp"

namespace desert_sim::micro_relief {

namespace {

struct FillPatches {
  Relief relief;
  SquareBox table;
  RipplePatch* patches;

  DESERT_HD void operator()(int i, int j) const {
    const Lattice& lattice = relief.ripples.lattice;
    patches[j * table.columns + i] =
        relief.ripples.patch(relief.cells, lattice.column_anywhere(table.first_column + i),
                             lattice.row_anywhere(table.first_row + j));
  }
};

struct FillBumps {
  Relief relief;
  SquareBox table;
  Bump* bumps;

  DESERT_HD void operator()(int i, int j) const {
    const Lattice& lattice = relief.bumps.lattice;
    bumps[j * table.columns + i] =
        relief.bumps.bump(relief.cells, relief.ripples, lattice.column_anywhere(table.first_column + i),
                          lattice.row_anywhere(table.first_row + j));
  }
};

struct Offsets {
  Relief relief;
  Points points;
  SquareTable patch_table, bump_table;
  const RipplePatch* patches;
  const Bump* bumps;
  float* to;

  DESERT_HD void operator()(int i, int j) const {
    to[j * points.columns + i] = relief.offset(
        points.x(i), points.y(j), [this](int p, int q) { return patches[patch_table.index(p, q)]; },
        [this](int p, int q) { return bumps[bump_table.index(p, q)]; });
  }
};

Grid grid_of(int columns, int rows) { return {columns, rows, 1.0f, false, false}; }

}  // namespace

template <class E>
void fill_squares(E& exec, const Relief& relief, const SquareBox& patch_box, RipplePatch* patches,
                  const SquareBox& bump_box, Bump* bumps) {
  if (patch_box.size() > 0)
    for_each_cell(exec, grid_of(patch_box.columns, patch_box.rows), FillPatches{relief, patch_box, patches});
  if (bump_box.size() > 0)
    for_each_cell(exec, grid_of(bump_box.columns, bump_box.rows), FillBumps{relief, bump_box, bumps});
}

template <class E>
void offsets(E& exec, const Relief& relief, const Points& points, RipplePatch* patches, Bump* bumps,
             float* to) {
  const SquareTable patch_table(relief.ripples.lattice, points), bump_table(relief.bumps.lattice, points);
  fill_squares(exec, relief, patch_table, patches, bump_table, bumps);
  for_each_cell(exec, grid_of(points.columns, points.rows),
                Offsets{relief, points, patch_table, bump_table, patches, bumps, to});
}

template void fill_squares(Backend&, const Relief&, const SquareBox&, RipplePatch*, const SquareBox&, Bump*);
template void offsets(Backend&, const Relief&, const Points&, RipplePatch*, Bump*, float*);

}  // namespace desert_sim::micro_relief

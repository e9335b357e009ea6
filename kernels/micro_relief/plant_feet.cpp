/// The laws of plant_feet.hpp; compiled once for each backend.
#include "kernels/micro_relief/plant_feet.hpp"

#include "kernels/backend/loops.hpp"

namespace desert_sim::micro_relief {

namespace {

struct ClearSquares {
  FootNumber* widest;
  std::size_t columns;

  DESERT_HD void operator()(int i, int j) const {
    widest[static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i)] = 0;
  }
};

struct FindFeet {
  Lattice lattice;
  Plants plants;
  int first_row, rows;
  FootNumber* widest;

  /// Whether a coordinate is on the terrain, but for its rounding to a float.
  DESERT_HD static bool is_on(const Axis& axis, double metres) {
    const double parts = metres * axis.parts_per_metre;
    return parts > -0.5 && parts < axis.count + 0.5;
  }
  /// Puts a place that was rounded over an edge back into the outermost square.
  DESERT_HD static void keep_inside(const Axis& axis, int& square, float& share) {
    if (square >= 0 && square < axis.count) return;
    share = square < 0 ? 0.0f : 1.0f;
    square = square < 0 ? 0 : axis.count - 1;
  }

  DESERT_HD void operator()(int n) const {
    const double x = plants.x[n], y = plants.y[n];
    const float radius = plants.radius[n];
    if (!(radius > 0.0f && is_on(lattice.x, x) && is_on(lattice.y, y))) return;
    Lattice::Square at = lattice.square(x, y);
    keep_inside(lattice.x, at.i, at.east);
    keep_inside(lattice.y, at.j, at.north);
    const int from = at.j - first_row, row = from < 0 && lattice.y.periodic ? from + lattice.y.count : from;
    if (row < 0 || row >= rows) return;
    atomic_max(widest + static_cast<std::size_t>(row) * static_cast<std::size_t>(lattice.x.count) +
                   static_cast<std::size_t>(at.i),
               Foot::number(at, radius));
  }
};

}  // namespace

template <class E>
void find_feet(E& exec, const Lattice& lattice, const Plants& plants, int first_row, int rows,
               FootNumber* widest) {
  const Grid squares{lattice.x.count, rows, 1.0f, false, false};
  for_each_cell(exec, squares, ClearSquares{widest, static_cast<std::size_t>(lattice.x.count)});
  for_each_item(exec, plants.count, FindFeet{lattice, plants, first_row, rows, widest});
}

template void find_feet(Backend&, const Lattice&, const Plants&, int, int, FootNumber*);

}  // namespace desert_sim::micro_relief

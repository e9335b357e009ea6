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

  /// The square in which a coordinate lies, and where in it; false if it is not on the terrain. One that was
  /// rounded over an edge is in the square beyond, or in the outermost one of an open terrain.
  DESERT_HD static bool find(const Axis& axis, float metres, int& square, float& share) {
    const double parts = metres * axis.parts_per_metre, whole = floor(parts);
    if (!(parts > -0.5 && parts < axis.count + 0.5)) return false;
    square = static_cast<int>(whole);
    share = static_cast<float>(parts - whole);
    if (square >= 0 && square < axis.count) return true;
    if (!axis.periodic) share = square < 0 ? 0.0f : 1.0f;
    square = axis.part(square);
    return true;
  }

  DESERT_HD void operator()(int n) const {
    const float radius = plants.radius[n];
    Lattice::Square at;
    if (!(radius > 0.0f) || !find(lattice.y, plants.y[n], at.j, at.north)) return;
    const int from = at.j - first_row, row = from < 0 && lattice.y.periodic ? from + lattice.y.count : from;
    if (row < 0 || row >= rows || !find(lattice.x, plants.x[n], at.i, at.east)) return;
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

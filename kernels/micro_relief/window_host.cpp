#include <cmath>

#include "kernels/micro_relief/window.hpp"

namespace desert_sim::micro_relief {

SquareTable::SquareTable(const Lattice& lattice, const Points& points) : x(lattice.x), y(lattice.y) {
  const Lattice::Square corner = lattice.square(points.x(0), points.y(0));
  const auto squares = [&points](int count, double per_metre) {
    return static_cast<int>(std::floor(count * points.step * per_metre)) + 4;
  };
  first_column = corner.i - 1;
  first_row = corner.j - 1;
  columns = squares(points.columns, x.parts_per_metre);
  rows = squares(points.rows, y.parts_per_metre);
}

}  // namespace desert_sim::micro_relief

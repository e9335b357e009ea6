/// Laws and step of brush_smooth.hpp; compiled once for each backend.
#include "kernels/edit/brush_smooth.hpp"

#include "kernels/backend/buffer.hpp"
#include "kernels/backend/loops.hpp"
#include "kernels/edit/brush.hpp"

namespace desert_sim::brush {

/// How many of the cells from at − r to at + r exist on an axis of n cells.
DESERT_HD int cells_around(int at, int r, int n, bool periodic) {
  if (periodic) return 2 * r + 1;
  const int low = at - r < 0 ? 0 : at - r, high = at + r >= n ? n - 1 : at + r;
  return high - low + 1;
}

/// Sums along x, for the brush's rows and `radius` more rows on both sides.
struct RowSums {
  Brush b;
  int radius;
  const Quanta* values;
  long long* sums;
  DESERT_HD void operator()(int x, int y) const {
    long long sum = 0;
    for (int d = -radius; d <= radius; ++d) {
      const int i = neighbour_index(b.grid, b.x0 + x + d, b.y0 + y - radius);
      if (i >= 0) sum += values[i];
    }
    sums[y * b.columns + x] = sum;
  }
};

struct Blend {
  Brush b;
  int radius;
  const Quanta* values;
  const long long* sums;
  Quanta* blended;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    if (i < 0) return;
    long long sum = 0;
    for (int d = 0; d <= 2 * radius; ++d) sum += sums[(y + d) * b.columns + x];
    const double cells =
        static_cast<double>(cells_around(b.x0 + x, radius, b.grid.width, b.grid.periodic_x)) *
        cells_around(b.y0 + y, radius, b.grid.height, b.grid.periodic_y);
    const double v = values[i], mean = static_cast<double>(sum) / cells;
    blended[y * b.columns + x] = static_cast<Quanta>(rint(v + b.shape.weight(b.point(x, y)) * (mean - v)));
  }
};

struct CopyBack {
  Brush b;
  const Quanta* blended;
  Quanta* values;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    if (i >= 0) values[i] = blended[y * b.columns + x];
  }
};

struct ComputeChange {
  Brush b;
  const Quanta* values;
  Quanta* change;
  DESERT_HD void operator()(int x, int y) const {
    const int i = b.cell(x, y);
    change[y * b.columns + x] = i < 0 ? 0 : values[i] - b.layer[i];
  }
};

template <class E>
void smooth(E& exec, const Brush& b, int radius, int passes, SmoothWorkspace& work, Quanta* change) {
  const Grid sums{b.columns, b.rows + 2 * radius, 1.0f, false, false};
  exec.copy(work.values.data(), b.layer, static_cast<std::size_t>(b.grid.cells()) * sizeof(Quanta));
  for (int n = 0; n < passes; ++n) {
    for_each_cell(exec, sums, RowSums{b, radius, work.values.data(), work.sums.data()});
    for_each_cell(exec, b.area(), Blend{b, radius, work.values.data(), work.sums.data(), change});
    for_each_cell(exec, b.area(), CopyBack{b, change, work.values.data()});
  }
  for_each_cell(exec, b.area(), ComputeChange{b, work.values.data(), change});
}

template void smooth(Backend&, const Brush&, int, int, SmoothWorkspace&, Quanta*);

}  // namespace desert_sim::brush

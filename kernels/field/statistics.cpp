/// Laws and functions of statistics.hpp; compiled once for each backend.
#include "kernels/field/statistics.hpp"

#include "kernels/backend/loops.hpp"
#include "kernels/base/math.hpp"

namespace desert_sim::statistics {

struct Sum {
  Grid grid;
  const Quanta* layer;
  DESERT_HD long long operator()(int x, int y) const { return layer[grid.index(x, y)]; }
};

/// Steepest slope of sand, as a tangent: the drop to a neighbour, but no more than the depth of the cell's
/// sand, over their distance.
struct SandSlope {
  Grid grid;
  const Quanta *bedrock, *soil, *sand;
  const float* obstacle;
  float quanta_per_cell;
  DESERT_HD Quanta height(int i) const { return bedrock[i] + value_or_zero(soil, i) + sand[i]; }
  DESERT_HD float operator()(int x, int y) const {
    const int i = grid.index(x, y);
    if (sand[i] <= 0 || value_or_zero(obstacle, i) > 0.0f) return 0.0f;
    const Quanta h = height(i);
    float steepest = 0.0f;
    for (int k = 0; k < Neighbours::count; ++k) {
      const int j = neighbour_index(grid, x + Neighbours::dx(k), y + Neighbours::dy(k));
      if (j < 0 || value_or_zero(obstacle, j) > 0.0f) continue;
      const Quanta drop = h - height(j) < sand[i] ? h - height(j) : sand[i];
      steepest = maximum(steepest, static_cast<float>(drop) / (Neighbours::distance(k) * quanta_per_cell));
    }
    return steepest;
  }
};

/// 1 for a cell whose value breaks the contract of its layer; else 0.
struct ContractViolation {
  Grid grid;
  const Quanta* quanta;
  const float* real;
  bool depth;  ///< must not be negative
  DESERT_HD long long operator()(int x, int y) const {
    const int i = grid.index(x, y);
    return (quanta ? breaks_contract(quanta[i], depth) : breaks_contract(real[i])) ? 1 : 0;
  }
};

template <class E>
long long sum(E& exec, const Grid& grid, const Quanta* layer) {
  return layer ? sum_cells(exec, grid, Sum{grid, layer}) : 0;
}

template <class E>
long long count_violations(E& exec, const Grid& grid, const Quanta* quanta, const float* real, bool depth) {
  return sum_cells(exec, grid, ContractViolation{grid, quanta, real, depth});
}

template <class E>
float sand_slope(E& exec, const TerrainView& t) {
  return max_cells(exec, t.grid,
                   SandSlope{t.grid, t.quanta(Layer::bedrock), t.quanta(Layer::soil), t.quanta(Layer::sand),
                             t.real(Layer::obstacle), t.grid.cell_size * t.quanta_per_metre});
}

template long long sum(Backend&, const Grid&, const Quanta*);
template long long count_violations(Backend&, const Grid&, const Quanta*, const float*, bool);
template float sand_slope(Backend&, const TerrainView&);

}  // namespace desert_sim::statistics

/// Laws and the function of residual.hpp; compiled once for each backend.
#include "kernels/avalanching/residual.hpp"

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/laws.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::statistics {

template <class ExcessOf>
struct CountOver {
  ExcessOf excess;
  float threshold;
  DESERT_HD long long operator()(int x, int y) const { return excess(x, y) > threshold ? 1 : 0; }
};

/// Sum of the excesses over 1e-3, in integers of 2⁻³⁰, so that the order of additions does not matter.
template <class ExcessOf>
struct SumExcess {
  ExcessOf excess;
  DESERT_HD long long operator()(int x, int y) const {
    const float e = excess(x, y);
    return e > 1e-3f ? static_cast<long long>(e * 1073741824.0f) : 0;
  }
};

template <class E, class ExcessOf>
Residual residual_of(E& exec, const Grid& grid, const ExcessOf& excess) {
  const long long over = sum_cells(exec, grid, CountOver<ExcessOf>{excess, 1e-3f});
  Residual r;
  r.share_over_1e3 = static_cast<double>(over) / grid.cells();
  r.share_over_1e2 =
      static_cast<double>(sum_cells(exec, grid, CountOver<ExcessOf>{excess, 1e-2f})) / grid.cells();
  r.mean_excess = over ? sum_cells(exec, grid, SumExcess<ExcessOf>{excess}) / 1073741824.0 / over : 0.0;
  r.largest_excess = max_cells(exec, grid, excess);
  return r;
}

template <class E>
Residual residual(E& exec, const TerrainView& t, const float* repose, AvalancheScheme scheme) {
  const avalanching::LevelView level = avalanching::finest_level(t, repose);
  if (scheme == AvalancheScheme::gradient) return residual_of(exec, t.grid, avalanching::QuadExcess{level});
  return residual_of(exec, t.grid, avalanching::Excess{level});
}

template Residual residual(Backend&, const TerrainView&, const float*, AvalancheScheme);

}  // namespace desert_sim::statistics

/// Laws and the function of residual.hpp; compiled once for each backend.
#include "kernels/avalanching/residual.hpp"

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/laws.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::statistics {

struct CountOver {
  avalanching::Excess excess;
  float threshold;
  DESERT_HD long long operator()(int x, int y) const { return excess(x, y) > threshold ? 1 : 0; }
};

/// Sum of the excesses over 1e-3, in integers of 2⁻³⁰, so that the order of additions does not matter.
struct SumExcess {
  avalanching::Excess excess;
  DESERT_HD long long operator()(int x, int y) const {
    const float e = excess(x, y);
    return e > 1e-3f ? static_cast<long long>(e * 1073741824.0f) : 0;
  }
};

template <class E>
Residual residual(E& exec, const TerrainView& t, const float* repose) {
  const avalanching::Excess excess{avalanching::finest_level(t, repose)};
  const long long over = sum_cells(exec, t.grid, CountOver{excess, 1e-3f});
  Residual r;
  r.share_over_1e3 = static_cast<double>(over) / t.grid.cells();
  r.share_over_1e2 = static_cast<double>(sum_cells(exec, t.grid, CountOver{excess, 1e-2f})) / t.grid.cells();
  r.mean_excess = over ? sum_cells(exec, t.grid, SumExcess{excess}) / 1073741824.0 / over : 0.0;
  r.largest_excess = max_cells(exec, t.grid, excess);
  return r;
}

template Residual residual(Backend&, const TerrainView&, const float*);

}  // namespace desert_sim::statistics

#pragma once
/// Sums and figures over the whole terrain. Each reads a result back and so waits for the device; not part of
/// a step.

#include "kernels/backend/exec.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim {

/// What avalanching left undone: share of cells steeper than their own repose by more than 1e-3 and 1e-2
/// (tangent), mean excess over those beyond 1e-3, and the largest. Only sand that could slide counts.
struct Residual {
  double share_over_1e3 = 0, share_over_1e2 = 0, mean_excess = 0, largest_excess = 0;
};

namespace statistics {

template <class E>
long long sum(E& exec, const Grid& grid, const Quanta* layer);

template <class E>
long long broken_cells(E& exec, const Grid& grid, const Quanta* quanta, const float* real, bool depth);

template <class E>
float sand_slope(E& exec, const TerrainView& t);

/// Against the repose tangents of the last step.
template <class E>
Residual residual(E& exec, const TerrainView& t, const float* repose);

}  // namespace statistics
}  // namespace desert_sim

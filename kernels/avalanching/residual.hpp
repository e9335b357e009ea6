#pragma once
/// How much too steep the sand is that avalanching has left.

#include "kernels/avalanching/avalanching_parameters.hpp"
#include "kernels/backend/exec.hpp"
#include "kernels/field/layers.hpp"

namespace desert_sim {

/// Excess that avalanching has left: the share of cells that are steeper than their own angle of repose by
/// more than 1e-3 and by more than 1e-2 (tangent), the mean excess of those beyond 1e-3, and the largest
/// excess. Only sand that could slide counts.
struct Residual {
  double share_over_1e3 = 0, share_over_1e2 = 0, mean_excess = 0, largest_excess = 0;
};

namespace statistics {

/// `repose`: tangents of the angles of repose in the last step. Scheme `gradient` counts quads in place of
/// cells (QuadExcess), all others cells by their neighbours (Excess). Reads results back and so waits for the
/// device; it is no part of a step.
template <class E>
Residual residual(E& exec, const TerrainView& t, const float* repose, AvalancheScheme scheme);

}  // namespace statistics
}  // namespace desert_sim

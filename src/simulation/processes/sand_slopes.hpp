#pragma once
/// How steep the sand lies: what avalanching is there to bound.

#include "kernels/avalanching/residual.hpp"
#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"

namespace desert_sim {

/// What avalanching has left too steep; brings the angles of repose up to date first.
Residual sand_residual(const SimulationState& state, Pipeline& pipeline);
double max_sand_slope_deg(const SimulationState& state);

}  // namespace desert_sim

#include "src/simulation/processes/sand_slopes.hpp"

#include "kernels/field/statistics.hpp"
#include "src/core/elementary.hpp"

namespace desert_sim {

Residual sand_residual(const SimulationState& state, Pipeline& pipeline) {
  pipeline.refresh_derived();
  return with_backend(state.exec(), [&](auto& e) {
    return statistics::residual(e, state.terrain.view(), pipeline.fields().repose.data(),
                                state.scenario.get<AvalanchingParameters>().scheme);
  });
}

double max_sand_slope_deg(const SimulationState& state) {
  const float tangent =
      with_backend(state.exec(), [&](auto& e) { return statistics::sand_slope(e, state.terrain.view()); });
  return elementary::atan_deg(tangent);
}

}  // namespace desert_sim

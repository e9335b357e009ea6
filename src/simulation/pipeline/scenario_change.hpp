#pragma once
/// Another scenario takes the place of the present one, in a simulation that goes on.

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"

namespace desert_sim {

/// `changed` has the grid of the state's scenario. Clocks go on from what they show, plants live by its
/// species, and processes are prepared for it; the wind's regime stays. If it has no live plants, there must
/// be none, and their memory is given back. Throws ConfigError, and has changed nothing, if memory runs out.
void take_scenario(SimulationState& state, Pipeline& pipeline, const Scenario& changed);

}  // namespace desert_sim

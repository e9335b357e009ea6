#include "src/simulation/pipeline/scenario_change.hpp"

namespace desert_sim {

namespace {

/// Plants by the scenario of the state; `before` had others, or none.
void follow_species(SimulationState& state, const Scenario& before) {
  const bool live = state.scenario.get<VegetationParameters>().enabled;
  if (!live)
    state.plants = {};
  else if (!state.plants || !same_species(before, state.scenario))
    state.take_species();
}

}  // namespace

void take_scenario(SimulationState& state, Pipeline& pipeline, const Scenario& changed) {
  state.exec().synchronise();  // memory that steps in flight work with is given back
  const Scenario before = state.scenario;
  const ClockOrigin clock_before = state.clock_origin;
  const bool held_were_known = state.held_layers_known;
  state.keep_time(changed.run, pipeline.parts());
  state.scenario = changed;
  try {
    follow_species(state, before);
    pipeline.prepare();
  } catch (...) {
    state.scenario = before;
    follow_species(state, changed);
    state.clock_origin = clock_before;
    state.held_layers_known = held_were_known;
    pipeline.prepare();
    throw;
  }
}

}  // namespace desert_sim

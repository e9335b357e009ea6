/// The process of continuum transport.
#include "kernels/sand/continuum.hpp"

#include "kernels/sand/saltation.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string continuum_section = register_section<ContinuumParameters>("continuum");

void transport(StepContext& c, ProcessWorkspace* workspace) {
  const Scenario& s = c.scenario();
  const continuum::StepInputs in{s.get<ContinuumParameters>(),
                                 s.get<ShearStressParameters>(),
                                 s.get<AbrasionParameters>(),
                                 s.get<ReposeParameters>(),
                                 s.get<SaltationParameters>(),
                                 s.get<EchoDuneParameters>(),
                                 c.time_step(),
                                 s.run.time_step,
                                 c.wind_above(),
                                 c.fields.heights.cell_heights.data(),
                                 c.fields.impact_strength.data()};
  with_backend(c.exec(), [&](auto& e) {
    continuum::step(e, c.terrain, in, c.dice(), c.state.ledger(),
                    workspace_as<continuum::Workspace>(workspace));
  });
}

float longest_step(const SimulationState& state) {
  const wind::Vector above = state.wind_above();
  return continuum::longest_step(state.scenario.get<ContinuumParameters>(),
                                 state.scenario.get<ShearStressParameters>(), state.terrain.grid(),
                                 hypotenuse(above.x, above.y));
}

}  // namespace

Process continuum_process() {
  Process p;
  p.name = name_of(SandModel::continuum);
  p.parameters = {"saltation", continuum_section, "shear_stress", "abrasion", "echo_dunes"};
  p.source = "Kroy et al. 2002, Andreotti et al. 2010";
  p.header = "kernels/sand/continuum.hpp";
  p.active = [](const Scenario& s) { return has_sand_model(s, SandModel::continuum); };
  p.roles = {Role::sand_transport};
  p.reads_heights = true;
  p.reads = {Layer::wind_x,   Layer::wind_y,   Layer::echo,  Layer::vegetation,
             Layer::obstacle, Layer::moisture, Layer::water, Layer::erosion_resistance};
  p.writes = {Layer::sand, Layer::airborne_sand};
  p.writes_if_in_use = {Layer::bedrock, Layer::soil, Layer::flux_x, Layer::flux_y};
  set_workspace<continuum::Workspace>(p, [](const SimulationState& state) {
    return continuum::make_workspace(state.exec(), state.terrain.grid());
  });
  p.step = transport;
  p.longest_step = longest_step;
  return p;
}

}  // namespace desert_sim

/// The particle model of wind ripples.
#include "src/scenario/particle_inputs.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string particle_section = register_section<ParticleParameters>("particle");

void fly(StepContext& c, ProcessWorkspace* workspace) {
  const particles::StepInputs in =
      particle_inputs(c.scenario(), c.time_step(), c.wind_above(), c.fields.impact_strength.data());
  with_backend(c.exec(), [&](auto& e) {
    particles::step(e, c.terrain, in, c.dice(), c.state.ledger(),
                    workspace_as<particles::Workspace>(workspace));
  });
}

}  // namespace

Process wang_process() {
  Process p;
  p.name = name_of(SandModel::wang);
  p.parameters = {particle_section, "saltation", "repose"};
  p.source = "Wang & Hu 2012, Kok & Renno 2009, Owen 1964";
  p.header = "kernels/particles/wang.hpp";
  p.active = has_flying_grains;
  p.roles = {Role::sand_transport, Role::wind, Role::wind_shadow, Role::sand_flux, Role::reptation};
  p.reads = {Layer::bedrock, Layer::soil, Layer::obstacle, Layer::vegetation, Layer::moisture, Layer::water};
  p.writes = {Layer::sand, Layer::wind_x, Layer::wind_y};
  set_workspace<particles::Workspace>(p, [](const SimulationState& state) {
    return particles::make_workspace(state.exec(), state.terrain.grid());
  });
  p.step = fly;
  p.refresh = [](StepContext& c, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) { particles::blow(e, c.terrain, c.wind_above()); });
  };
  p.longest_step = [](const SimulationState& state) {
    return particles::longest_step(state.scenario.get<ParticleParameters>(), state.terrain.grid(),
                                   state.wind_above());
  };
  return p;
}

}  // namespace desert_sim

/// The process of sand in slabs that random events move.
#include "kernels/sand/desertscape.hpp"

#include "src/simulation/processes/limits.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string desertscape_name = name_of(SandModel::desertscape_2019);
const std::string desertscape_section = register_section<DesertscapeParameters>(desertscape_name);

const DesertscapeParameters& desertscape_parameters(const Scenario& s) {
  return s.get<DesertscapeParameters>();
}

void move_slabs(StepContext& c, ProcessWorkspace* workspace) {
  const Scenario& s = c.scenario();
  const bool creeps = s.get<ReptationParameters>().method != ReptationMethod::off;
  const desertscape::StepInputs in{desertscape_parameters(s),
                                   s.get<SaltationParameters>(),
                                   s.get<AbrasionParameters>(),
                                   s.get<ReposeParameters>(),
                                   s.get<EchoDuneParameters>(),
                                   creeps ? s.get<ReptationParameters>().slab : 0.0f,
                                   c.time_step(),
                                   s.run.time_step,
                                   c.fields.scratch<Quanta>(1)};
  with_backend(c.exec(), [&](auto& e) {
    desertscape::step(e, c.terrain, in, c.dice(), c.state.ledger(),
                      workspace_as<desertscape::Workspace>(workspace));
  });
}

}  // namespace

Process desertscape_process() {
  Process p;
  p.name = desertscape_name;
  p.parameters = {"saltation", desertscape_section, "abrasion", "reptation", "echo_dunes"};
  p.source = "Paris et al. 2019 §5";
  p.header = "kernels/sand/desertscape.hpp";
  p.active = [](const Scenario& s) { return has_sand_model(s, SandModel::desertscape_2019); };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    check_reach(s, "saltation.hop_time", fastest_wind(s) * s.get<SaltationParameters>().hop_time, errors);
    check_step_length(s, "desertscape_2019.slab / (4 saltation.lift)",
                      desertscape::longest_step(desertscape_parameters(s), s.get<SaltationParameters>()),
                      errors);
  };
  p.roles = {Role::sand_transport, Role::reptation};
  p.reads = {Layer::wind_x,   Layer::wind_y,     Layer::wind_shadow,
             Layer::echo,     Layer::vegetation, Layer::obstacle,
             Layer::moisture, Layer::water,      Layer::erosion_resistance};
  p.writes = {Layer::sand, Layer::airborne_sand};
  p.writes_if_in_use = {Layer::bedrock, Layer::soil, Layer::flux_x, Layer::flux_y};
  set_workspace<desertscape::Workspace>(p, [](const SimulationState& state) {
    return desertscape::make_workspace(state.exec(), state.terrain.grid());
  });
  p.step = move_slabs;
  p.longest_step = [](const SimulationState& state) {
    return desertscape::longest_step(desertscape_parameters(state.scenario),
                                     state.scenario.get<SaltationParameters>());
  };
  return p;
}

}  // namespace desert_sim

/// The process of sand in slabs that random events move.
#include "kernels/sand/desertscape.hpp"

#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

constexpr SaltationModel model = SaltationModel::desertscape_2019;
const std::string name = saltation_model_names[static_cast<int>(model)];
const std::string section = register_section<DesertscapeParameters>(name);

const DesertscapeParameters& parameters_of(const Scenario& s) {
  return s.process_sections.get<DesertscapeParameters>(section);
}

void move_slabs(StepContext& c, ProcessWorkspace* workspace) {
  const Scenario& s = c.scenario();
  const bool creeps = s.reptation.method != ReptationMethod::off;
  const desertscape::StepInputs in{parameters_of(s),
                                   s.saltation,
                                   s.abrasion,
                                   s.repose,
                                   creeps ? s.reptation.slab : 0.0f,
                                   c.time_step(),
                                   s.run.time_step,
                                   c.fields.landed.data()};
  with_backend(c.exec(), [&](auto& e) {
    desertscape::step(e, c.terrain, in, c.dice(), c.state.ledger(),
                      workspace_as<desertscape::Workspace>(workspace));
  });
}

}  // namespace

Process desertscape_process() {
  Process p;
  p.name = name;
  p.parameters = {"saltation", section, "abrasion", "reptation"};
  p.source = "Paris et al. 2019 §5";
  p.header = "kernels/sand/desertscape.hpp";
  p.active = [](const Scenario& s) { return s.saltation.enabled && s.saltation.model == model; };
  p.replaces = {"reptation"};
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
    return desertscape::longest_step(parameters_of(state.scenario), state.scenario.saltation);
  };
  return p;
}

}  // namespace desert_sim

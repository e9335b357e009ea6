/// The slab models of dunes and of snow. Each is a row; they share the section slab_model and the step.
#include <cmath>

#include "kernels/sand/saltation.hpp"
#include "kernels/slabs/slab_model.hpp"
#include "src/simulation/processes/limits.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string slab_section = register_section<SlabModelParameters>("slab_model");
const std::string plant_section = register_section<SlabPlantParameters>("slab_plants");
const std::string snow_section = register_section<SlabSnowParameters>("slab_snow");

const SlabModelParameters& slab_parameters(const Scenario& s) { return s.get<SlabModelParameters>(); }

/// Intervals of simulated time that end with the step.
int ending_with_step(const StepContext& c, float interval) {
  const auto ended = [&](double time) { return std::floor(time / static_cast<double>(interval)); };
  return static_cast<int>(ended(c.time_of(c.tick() + 1)) - ended(c.time()));
}

void move_slabs(SlabKind kind, StepContext& c, ProcessWorkspace* workspace) {
  const Scenario& s = c.scenario();
  const auto& plants = s.get<SlabPlantParameters>();
  const SlabSnowParameters& snow = s.get<SlabSnowParameters>();
  const slabs::StepInputs in{kind,
                             slab_parameters(s),
                             plants,
                             snow,
                             s.growth_curves,
                             s.get<SaltationParameters>().influx,
                             c.time_step(),
                             c.wind_above(),
                             ending_with_step(c, plants.growth_time),
                             ending_with_step(c, snow.settling_time)};
  with_backend(c.exec(), [&](auto& e) {
    slabs::step(e, c.terrain, in, c.dice(), c.state.ledger(), workspace_as<slabs::Workspace>(workspace));
  });
}

Process slab_process(SandModel model, SlabKind kind, const std::string& source) {
  Process p;
  p.name = name_of(model);
  p.parameters = {slab_section, "saltation"};
  p.source = source;
  p.header = "kernels/slabs/slab_model.hpp";
  p.active = [model](const Scenario& s) { return has_sand_model(s, model); };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    check_step_length(s, "slab_model.poll_time", slab_parameters(s).poll_time, errors);
  };
  p.roles = {Role::sand_transport, Role::wind,      Role::wind_shadow, Role::sand_flux,
             Role::repose,         Role::reptation, Role::avalanching};
  p.reads = {Layer::bedrock, Layer::soil, Layer::obstacle};
  p.writes = {Layer::sand, Layer::wind_x, Layer::wind_y};
  set_workspace<slabs::Workspace>(p, [kind](const SimulationState& state) {
    return slabs::make_workspace(state.exec(), state.terrain.grid(), has_resistance(kind));
  });
  p.step = [kind](StepContext& c, ProcessWorkspace* workspace) { move_slabs(kind, c, workspace); };
  p.refresh = [](StepContext& c, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) { slabs::blow(e, c.terrain, c.wind_above()); });
  };
  return p;
}

bool never_recorded(const SimulationState&) { return false; }

}  // namespace

Process werner_process() {
  Process p = slab_process(SandModel::werner, SlabKind::werner, "Werner 1995");
  // Forced erosion reads back how many slabs were taken.
  p.can_be_recorded = [](const SimulationState& s) { return !slab_parameters(s.scenario).forced_erosion; };
  return p;
}

Process momiji_process() {
  Process p = slab_process(SandModel::momiji, SlabKind::momiji, "Momiji et al. 2000");
  p.can_be_recorded = never_recorded;  // the mean height is read back
  return p;
}

Process bishop_process() {
  Process p = slab_process(SandModel::bishop, SlabKind::bishop, "Bishop et al. 2002");
  p.can_be_recorded = never_recorded;
  return p;
}

Process nield_baas_process() {
  Process p = slab_process(SandModel::nield_baas, SlabKind::nield_baas, "Nield & Baas 2008");
  p.parameters.push_back(plant_section);
  for (Layer layer : {Layer::grass, Layer::mesquite, Layer::shrub, Layer::burial}) p.writes.push_back(layer);
  p.can_be_recorded = never_recorded;  // plants do not grow in every step
  return p;
}

Process snow_process() {
  Process p =
      slab_process(SandModel::snow, SlabKind::snow, "Werner 1995; Hedstrom & Pomeroy 1998; Anderson 1976");
  p.parameters.push_back(snow_section);
  p.writes.push_back(Layer::snow_density);
  p.begin = [](SimulationState& state, Layer layer) {
    if (layer != Layer::snow_density) return;
    with_backend(state.exec(), [&](auto& e) {
      slabs::lay_fresh_snow(e, state.terrain.view(), state.scenario.get<SlabSnowParameters>());
    });
  };
  p.can_be_recorded = never_recorded;  // it does not settle in every step
  return p;
}

}  // namespace desert_sim

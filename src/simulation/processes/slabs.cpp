/// The slab models of dunes. Each is a row; they share the section slab_model and the step.
#include "kernels/slabs/slab_model.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string section = register_section<SlabModelParameters>("slab_model");

const SlabModelParameters& parameters_of(const Scenario& s) {
  return s.process_sections.get<SlabModelParameters>(section);
}

void move_slabs(StepContext& c, ProcessWorkspace* workspace) {
  const Scenario& s = c.scenario();
  const slabs::StepInputs in{parameters_of(s), s.saltation.influx, c.time_step(), c.wind_above()};
  with_backend(c.exec(), [&](auto& e) {
    slabs::step(e, c.terrain, in, c.dice(), c.state.ledger(), workspace_as<slabs::Workspace>(workspace));
  });
}

Process slab_process(SlabKind kind, const std::string& source) {
  Process p;
  p.name = slab_kind_names[static_cast<int>(kind)];
  p.parameters = {section, "saltation"};
  p.source = source;
  p.header = "kernels/slabs/slab_model.hpp";
  p.active = [kind](const Scenario& s) { return parameters_of(s).kind == kind; };
  p.replaces = {"wind",      "shear_stress", "wind_shadow", "sand_flux",  "saltation",
                "continuum", "repose",       "reptation",   "avalanching"};
  p.reads = {Layer::bedrock, Layer::soil, Layer::obstacle};
  p.writes = {Layer::sand, Layer::wind_x, Layer::wind_y};
  set_workspace<slabs::Workspace>(p, [](const SimulationState& state) {
    return slabs::make_workspace(state.exec(), state.terrain.grid());
  });
  p.step = move_slabs;
  p.refresh = [](StepContext& c, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) { slabs::blow(e, c.terrain, c.wind_above()); });
  };
  return p;
}

}  // namespace

Process werner_process() { return slab_process(SlabKind::werner, "Werner 1995"); }

Process momiji_process() {
  Process p = slab_process(SlabKind::momiji, "Momiji et al. 2000");
  p.can_be_recorded = [](const SimulationState&) { return false; };  // the mean height is read back
  return p;
}

Process bishop_process() {
  Process p = slab_process(SlabKind::bishop, "Bishop et al. 2002");
  p.can_be_recorded = [](const SimulationState&) { return false; };
  return p;
}

}  // namespace desert_sim

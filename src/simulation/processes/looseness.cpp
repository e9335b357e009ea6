/// The processes of loose ground: what moves sand is followed in two parts of a step, before avalanches and
/// after them, by the depth of sand at its beginning.
#include "kernels/sand/looseness.hpp"

#include "kernels/sand/saltation.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string looseness_section = register_section<LoosenessParameters>("looseness");

bool is_loosened(const Scenario& s) { return s.get<LoosenessParameters>().enabled; }

Process row(const char* name) {
  Process p;
  p.name = name;
  p.parameters = {looseness_section};
  p.source = "Bagnold 1941";
  p.header = "kernels/sand/looseness.hpp";
  p.active = is_loosened;
  return p;
}

}  // namespace

Process sand_record_process() {
  Process p = row("sand_record");
  p.needs = {SharedField::sand_before};
  p.reads = {Layer::sand};
  p.step = [](StepContext& c, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) { looseness::record(e, c.terrain, c.fields.sand_before.data()); });
  };
  return p;
}

Process looseness_process() {
  Process p = row("looseness");
  p.needs = {SharedField::sand_before, SharedField::impact_strength};
  p.parameters = {looseness_section, "saltation", "repose"};
  p.reads = {Layer::sand, Layer::soil, Layer::moisture, Layer::wind_shadow};
  p.writes = {Layer::looseness};
  p.begin = [](SimulationState& state, Layer) {
    with_backend(state.exec(), [&](auto& e) {
      looseness::fill(e, state.terrain.view(), state.scenario.get<LoosenessParameters>().initial);
    });
  };
  p.step = [](StepContext& c, ProcessWorkspace*) {
    const Scenario& s = c.scenario();
    with_backend(c.exec(), [&](auto& e) {
      looseness::step(e, c.terrain, s.get<LoosenessParameters>(), s.get<ReposeParameters>(),
                      {c.time_step(), s.get<SaltationParameters>().hop_time, c.fields.impact_strength.data()},
                      c.fields.sand_before.data());
    });
  };
  return p;
}

Process slide_looseness_process() {
  Process p = row("slide_looseness");
  p.parameters = {looseness_section, "repose"};
  p.reads = {Layer::sand, Layer::soil, Layer::moisture, Layer::vegetation};
  p.writes = {Layer::looseness};
  p.step = [](StepContext& c, ProcessWorkspace*) {
    const Scenario& s = c.scenario();
    with_backend(c.exec(), [&](auto& e) {
      looseness::slides(e, c.terrain, s.get<LoosenessParameters>(), s.get<ReposeParameters>(),
                        c.fields.repose.data(), c.fields.sand_before.data());
    });
  };
  return p;
}

}  // namespace desert_sim

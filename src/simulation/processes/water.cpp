/// The processes of water and wet ground: rain, springs and the sea, rivers, their sediment, moisture, soil.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/water/hydraulic_erosion.hpp"
#include "kernels/water/rain.hpp"
#include "kernels/water/shallow_water.hpp"
#include "kernels/water/virtual_pipes.hpp"
#include "kernels/water/water_sources.hpp"
#include "kernels/water/water_velocity.hpp"
#include "src/core/number_text.hpp"
#include "src/scenario/section_with_list.hpp"
#include "src/simulation/processes/limits.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string rain_section = register_section<RainParameters>("rain");
const std::string water_section = register_section<WaterParameters, Spring>("water", "springs", max_springs);
const std::string erosion_section = register_section<HydraulicErosionParameters>("hydraulic_erosion");
const std::string moisture_section = register_section<MoistureParameters>("moisture");
const std::string soil_section = register_section<SoilParameters>("soil");

const std::vector<Spring>& springs_of(const Scenario& s) {
  return list_of<WaterParameters, Spring>(s.sections);
}

}  // namespace

bool has_water(const Scenario& s) {
  return s.get<WaterParameters>().enabled || s.get<RainParameters>().rate > 0 ||
         s.get<HydraulicErosionParameters>().enabled || s.get<MoistureParameters>().enabled ||
         !springs_of(s).empty();
}

void require_sea(const Scenario& s, const HeightScale& scale, const std::string& what) {
  const double highest = scale.datum + load_limit * scale.quantum();
  const WaterParameters& water = s.get<WaterParameters>();
  if (water.sea == Sea::none || water.sea_level <= highest) return;
  throw ConfigError(what + ": water.sea_level: " + std::to_string(water.sea_level) +
                    " m is above the highest elevation that this terrain can represent (allowed: at most " +
                    std::to_string(highest) + " m)");
}

namespace {

/// Up to where heights must reach.
double highest_water(const Scenario& s) {
  const WaterParameters& water = s.get<WaterParameters>();
  return water.sea == Sea::none ? -std::numeric_limits<double>::infinity() : water.sea_level;
}
/// Amounts of water are whole quanta that depend on the step, or on the deepest water, which is read back.
bool cannot_be_recorded(const SimulationState&) { return false; }

/// The level of the sea in quanta above the datum, as far as heights can be counted.
Quanta sea_level(const SimulationState& state) {
  const HeightScale& scale = state.terrain.scale();
  const double quanta = (state.scenario.get<WaterParameters>().sea_level - scale.datum) / scale.quantum();
  constexpr double limit = load_limit;
  return static_cast<Quanta>(std::lrint(std::clamp(quanta, -limit, limit)));
}

void add_water(StepContext& c, ProcessWorkspace*) {
  const SimulationState& state = c.state;
  const Scenario& s = state.scenario;
  with_backend(c.exec(), [&](auto& e) {
    const rain::StepInputs in{c.time_step(), c.time(), s.seed, c.tick(), state.terrain.scale().datum};
    rain::step(e, c.terrain, s.get<RainParameters>(), in, state.ledger());
    for (const Spring& spring : springs_of(s))
      water_sources::add_spring(e, c.terrain, spring, spring.x - s.grid.origin_x, spring.y - s.grid.origin_y,
                                c.time_step(), c.tick(), state.ledger());
  });
}

virtual_pipes::Workspace make_pipes(const SimulationState& state) {
  return {Buffer<float>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()))};
}

/// A step that needed more than most_substeps.
std::string too_few_substeps(const SimulationState& state, const ProcessWorkspace& workspace) {
  const virtual_pipes::Substeps& last =
      static_cast<const WorkspaceHolder<virtual_pipes::Workspace>&>(workspace).work.substeps;
  const int most = state.scenario.get<WaterParameters>().most_substeps;
  if (last.needed <= most) return "";
  return "water " + number_text(last.depth) + " m deep, or a fast stream of " +
         number_text(last.depth / virtual_pipes::stream_depth) + " m, needs " + number_text(last.needed, 6) +
         " sub-steps in a step of " + number_text(last.time_step, 6) + " s, but water.most_substeps allows " +
         std::to_string(most) +
         ": waves on deep water are slower than they should be, and fast streams may break into pulses; "
         "raise "
         "water.most_substeps or lower run.time_step";
}

face_flow::StepInputs flow_inputs(StepContext& c) {
  return {c.time_step(), c.time(),           c.scenario().seed,
          c.tick(),      sea_level(c.state), c.fields.scratch<Quanta>(1)};
}

void move_through_pipes(StepContext& c, ProcessWorkspace* workspace) {
  with_backend(c.exec(), [&](auto& e) {
    virtual_pipes::step(e, c.terrain, c.scenario().get<WaterParameters>(), flow_inputs(c), c.state.ledger(),
                        workspace_as<virtual_pipes::Workspace>(workspace));
  });
}

shallow_water::Workspace make_velocities(const SimulationState& state) {
  return {state.exec(), state.terrain.grid()};
}

void move_with_momentum(StepContext& c, ProcessWorkspace* workspace) {
  with_backend(c.exec(), [&](auto& e) {
    shallow_water::step(e, c.terrain, c.scenario().get<WaterParameters>(), flow_inputs(c), c.state.ledger(),
                        workspace_as<shallow_water::Workspace>(workspace));
  });
}

void find_velocities(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) { water_velocity::step(e, c.terrain); });
}

/// Whether water is simulated, and this is its model.
template <WaterModel model>
bool has_water_model(const Scenario& s) {
  return has_water(s) && s.get<WaterParameters>().model == model;
}

/// What the models of water have in common.
Process water_model(const char* name) {
  Process p;
  p.name = name;
  p.roles = {Role::water_flow};
  p.parameters = {water_section};
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::water, Layer::water_flux_x, Layer::water_flux_y, Layer::water_velocity_x,
              Layer::water_velocity_y};
  p.writes_if_in_use = {Layer::suspended_sediment};
  p.refresh = find_velocities;
  p.highest = highest_water;
  p.can_be_recorded = cannot_be_recorded;
  return p;
}

hydraulic_erosion::Workspace make_capacity(const SimulationState& state) {
  return {Buffer<float>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()))};
}

void erode(StepContext& c, ProcessWorkspace* workspace) {
  with_backend(c.exec(), [&](auto& e) {
    hydraulic_erosion::step(e, c.terrain, c.scenario().get<HydraulicErosionParameters>(), c.time_step(),
                            c.dice(), c.state.ledger(),
                            workspace_as<hydraulic_erosion::Workspace>(workspace));
  });
}

void update_moisture(StepContext& c, ProcessWorkspace*) {
  const Scenario& s = c.scenario();
  with_backend(c.exec(), [&](auto& e) {
    moisture::step(e, c.terrain, s.get<MoistureParameters>(),
                   {c.time_step(), s.get<ReposeParameters>(), c.fields.scratch<Quanta>(1)}, c.dice(),
                   c.state.ledger());
  });
}

void evaporate(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    water_sources::evaporate(e, c.terrain, c.scenario().get<WaterParameters>().evaporation, c.time_step(),
                             c.dice(), c.state.ledger());
  });
}

void update_soil(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    soil::step(e, c.terrain, c.scenario().get<SoilParameters>(), c.scenario().get<ReposeParameters>(),
               c.time_step(), c.dice(), c.state.ledger());
  });
}

}  // namespace

Process rain_process() {
  Process p;
  p.name = "rain";
  p.parameters = {rain_section, water_section};
  p.source = "Nilles 2025 §3.4.3, 3.4.5, eq. 31";
  p.header = "kernels/water/rain.hpp";
  p.active = has_water;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand};
  p.writes = {Layer::water};
  p.step = add_water;
  p.can_be_recorded = cannot_be_recorded;
  return p;
}

Process virtual_pipes_process() {
  Process p = water_model("virtual_pipes");
  p.source = "Mei 2007, Nilles 2025 §3.4";
  p.header = "kernels/water/virtual_pipes.hpp";
  p.active = has_water_model<WaterModel::pipes>;
  set_workspace<virtual_pipes::Workspace>(p, make_pipes);
  p.step = move_through_pipes;
  p.warning = too_few_substeps;
  return p;
}

Process shallow_water_process() {
  Process p = water_model("shallow_water");
  p.source = "Stelling & Duinmeijer 2003";
  p.header = "kernels/water/shallow_water.hpp";
  p.active = has_water_model<WaterModel::shallow_water>;
  set_workspace<shallow_water::Workspace>(p, make_velocities);
  p.step = move_with_momentum;
  return p;
}

Process hydraulic_erosion_process() {
  Process p;
  p.name = "hydraulic_erosion";
  p.parameters = {erosion_section};
  p.source = "Mei 2007, Nilles 2025 §3.4";
  p.header = "kernels/water/hydraulic_erosion.hpp";
  p.active = [](const Scenario& s) { return s.get<HydraulicErosionParameters>().enabled; };
  p.reads = {Layer::water,      Layer::water_velocity_x,   Layer::water_velocity_y,
             Layer::vegetation, Layer::erosion_resistance, Layer::obstacle};
  p.writes = {Layer::bedrock, Layer::sand, Layer::suspended_sediment};
  p.writes_if_in_use = {Layer::soil};
  set_workspace<hydraulic_erosion::Workspace>(p, make_capacity);
  p.step = erode;
  p.can_be_recorded = cannot_be_recorded;
  return p;
}

Process moisture_process() {
  Process p;
  p.name = "moisture";
  p.parameters = {moisture_section, "repose"};
  p.source = "Nilles 2025 §3.4.4";
  p.header = "kernels/soil/moisture.hpp";
  p.active = [](const Scenario& s) { return s.get<MoistureParameters>().enabled; };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    const double diffusion = s.get<MoistureParameters>().diffusion, cell = s.grid.cell_size;
    check_substeps(
        s, {"moisture.diffusion", diffusion, "m^2/s", 4 * diffusion * s.run.time_step / (cell * cell), 64},
        errors);
  };
  p.reads = {Layer::soil, Layer::sand, Layer::vegetation};
  p.writes = {Layer::water, Layer::moisture};
  p.step = update_moisture;
  p.can_be_recorded = cannot_be_recorded;
  return p;
}

Process evaporation_process() {
  Process p;
  p.name = "evaporation";
  p.parameters = {water_section};
  p.source = "Nilles 2025 §3.4.4";
  p.header = "kernels/water/water_sources.hpp";
  p.active = has_water;
  p.writes = {Layer::water};
  p.step = evaporate;
  p.can_be_recorded = cannot_be_recorded;
  return p;
}

Process soil_process() {
  Process p;
  p.name = "soil";
  p.parameters = {soil_section, "repose"};
  p.source = "Nilles 2025 eq. 28–29";
  p.header = "kernels/soil/soil.hpp";
  p.active = [](const Scenario& s) { return s.get<SoilParameters>().enabled; };
  p.reads = {Layer::moisture, Layer::vegetation};
  p.writes = {Layer::soil, Layer::sand};
  p.writes_if_in_use = {Layer::humus};
  p.step = update_soil;
  return p;
}

}  // namespace desert_sim

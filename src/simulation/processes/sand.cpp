/// The processes of sand: saltation with abrasion, angles of repose, reptation, avalanches.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "kernels/avalanching/avalanching.hpp"
#include "kernels/avalanching/soil_and_bedrock.hpp"
#include "kernels/field/statistics.hpp"
#include "kernels/sand/overflow.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/water/hydraulic_erosion.hpp"
#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/simulation/processes/limits.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

void check_influx(const Scenario& s, ValidationErrors& errors) {
  constexpr double most = 100;  // [m a step]; a few hundred of them would leave the range of heights
  const double cell = s.grid.cell_size > 0 ? s.grid.cell_size : 1.0;
  const double influx = s.get<SaltationParameters>().influx;
  const double depth = influx * static_cast<double>(s.run.time_step) / cell;
  if (depth <= most) return;
  std::ostringstream text;
  text << influx << " m^2/s brings " << depth << " m of sand to a cell of the edge in a step of "
       << s.run.time_step << " s (allowed: at most " << most << " m)";
  errors.add("saltation.influx", text.str());
}

const std::string sand_section = register_section<SandParameters>("sand");
const std::string saltation_section = register_section<SaltationParameters>("saltation", check_influx);
const std::string abrasion_section = register_section<AbrasionParameters>("abrasion");
const std::string reptation_section = register_section<ReptationParameters>("reptation");
const std::string repose_section = register_section<ReposeParameters>("repose");
const std::string avalanching_section = register_section<AvalanchingParameters>("avalanching");

}  // namespace

bool has_sand_model(const Scenario& s, SandModel model) {
  return s.get<SandParameters>().model == model &&
         (s.get<SaltationParameters>().enabled || !is_saltation(model));
}

bool wears_ground(const Scenario& s) {
  return s.get<AbrasionParameters>().wears_ground() || s.get<HydraulicErosionParameters>().enabled ||
         s.get<SoilParameters>().enabled;
}

namespace {

/// Whether soil may come to stand too steep: where it is worn, and where it becomes wetter or loses plants.
bool loosens_soil(const Scenario& s) {
  return wears_ground(s) || s.get<MoistureParameters>().enabled || s.get<VegetationParameters>().enabled;
}

// ---- saltation

reptation::Angle angle_of_repose(const StepContext& c) {
  return reptation::Angle(c.scenario().get<ReptationParameters>(), c.scenario().get<ReposeParameters>(),
                          c.fields.repose.data());
}

/// `shadow_law` finds the wind's shadow first; null where the layer wind_shadow has it already.
template <class E>
void lift_and_deposit(E& e, StepContext& c, const wind_shadow::Shadow* shadow_law) {
  const Scenario& s = c.scenario();
  const saltation::StepInputs in{s.get<SaltationParameters>(),
                                 s.get<AbrasionParameters>(),
                                 s.get<ReposeParameters>(),
                                 s.get<EchoDuneParameters>(),
                                 c.time_step(),
                                 s.run.time_step,
                                 c.fields.scratch<Quanta>(1),
                                 {angle_of_repose(c), c.fields.impact_strength.data()},
                                 shadow_law};
  saltation::step(e, c.terrain, in, c.dice(), c.state.ledger());
}

void saltate(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) { lift_and_deposit(e, c, nullptr); });
}

void set_angles(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    reptation::set_angles(e, c.terrain, angle_of_repose(c), c.scenario().get<ReposeParameters>(), nullptr);
  });
}

// ---- reptation

void creep(StepContext& c, ProcessWorkspace*) {
  const Scenario& s = c.scenario();
  with_backend(c.exec(), [&](auto& e) {
    const reptation::StepInputs in{c.time_step(), s.seed, c.tick(), c.fields.impact_strength.data(),
                                   c.fields.scratch<Quanta>(1)};
    reptation::step(e, c.terrain, s.get<ReptationParameters>(), in, c.dice());
  });
}

// ---- avalanching

// Bedrock, or soil and what is below it, was edited and has not come to rest since.
const std::string bedrock_loose = "bedrock_loose", soil_loose = "soil_loose";

bool is_loose(const SimulationState& state) {
  return state.flags.count(bedrock_loose) > 0 || state.flags.count(soil_loose) > 0;
}

void set(ProcessFlags& flags, const std::string& flag, bool on) {
  if (on)
    flags.insert(flag);
  else
    flags.erase(flag);
}

struct AvalancheWork {
  avalanching::Workspace sand;
  avalanching::GroundWorkspace ground;  ///< empty where neither soil nor bedrock can slide

  std::size_t bytes() const { return sand.bytes() + ground.bytes(); }

  /// Only terrains whose rock or soil changes need memory for it.
  void prepare_ground(const SimulationState& state) {
    const AvalanchingParameters& p = state.scenario.get<AvalanchingParameters>();
    const bool changes = loosens_soil(state.scenario) || is_loose(state);
    if (!ground.received && changes && (p.soil || p.bedrock))
      ground = avalanching::make_ground_workspace(state.exec(), state.terrain.grid());
  }
};

AvalancheWork make_avalanche_work(const SimulationState& state) {
  AvalancheWork work{avalanching::make_workspace(state.exec(), state.terrain.grid(),
                                                 state.scenario.get<AvalanchingParameters>()),
                     {}};
  work.prepare_ground(state);
  return work;
}

/// Soil and bedrock slide only where something changes them or their angles of repose: abrasion, water,
/// moisture, plants, or an edit, until all has come to rest.
template <class E>
void slide_ground(E& e, StepContext& c, AvalancheWork& work) {
  SimulationState& state = c.state;
  const AvalanchingParameters& p = state.scenario.get<AvalanchingParameters>();
  const ReposeParameters& repose = state.scenario.get<ReposeParameters>();
  Quanta* const given = c.fields.scratch<Quanta>(1);
  const bool wearing = wears_ground(state.scenario), loosening = loosens_soil(state.scenario);
  const bool has_soil = state.terrain.has(Layer::soil);
  const auto moved = [&] { return statistics::sum(e, c.terrain.grid, given) != 0; };
  const auto is_set = [&](const std::string& flag) { return state.flags.count(flag) > 0; };
  if (p.soil && (loosening || is_set(soil_loose)) && has_soil) {
    avalanching::step_soil(e, c.terrain, p, repose, given, work.ground);
    if (is_set(soil_loose)) set(state.flags, soil_loose, moved());
  }
  if (p.bedrock && (wearing || is_set(bedrock_loose))) {
    avalanching::step_bedrock(e, c.terrain, p, repose, state.ledger(), given, work.ground);
    if (is_set(bedrock_loose)) set(state.flags, bedrock_loose, moved());
  }
  if (!has_soil)
    state.flags.erase(soil_loose);
  else if (is_set(bedrock_loose))
    state.flags.insert(soil_loose);
}

void slide(StepContext& c, ProcessWorkspace* workspace) {
  AvalancheWork& work = workspace_as<AvalancheWork>(workspace);
  with_backend(c.exec(), [&](auto& e) {
    slide_ground(e, c, work);
    avalanching::step(e, c.terrain, c.scenario().get<AvalanchingParameters>(), c.tick(),
                      c.fields.repose.data(), c.leaves_heights ? &c.fields.heights : nullptr, work.sand);
  });
}

/// Whether the host waits for nothing in a step of avalanching.
bool avalanching_can_be_recorded(const SimulationState& state) {
  const AvalanchingParameters& p = state.scenario.get<AvalanchingParameters>();
  const bool needs_no_readback =
      p.quality != AvalancheQuality::converged || (has_levels(p.scheme) && state.exec().can_record_loops());
  return needs_no_readback && !is_loose(state);
}

/// Passes of avalanching read ground, sand and tangents, and write sand. Each coarse level has a quarter of
/// the cells of the one below; it is filled (ground, sand twice, tangents), passed over, and read again
/// (sand, before and after). The fine grid is read for the first in passing. The last pass writes the
/// heights. Of quality `converged` this counts the first cycle.
MemoryTraffic avalanche_traffic(const Scenario& s, const Grid& grid) {
  constexpr double layer = 4, heights = 1, restriction = 4, prolongation = 2;
  const avalanching::Schedule plan = avalanching::schedule(s.get<AvalanchingParameters>(), grid);
  const int fine = plan.fine_passes();
  double coarse = 0, cells = 1;
  for (std::size_t n = 1; n < 16; ++n) {
    cells /= 4;
    coarse += cells * (restriction + 4 * plan.coarse_passes(n) + prolongation);
  }
  const std::string times = fine == 1 ? "" : " x " + std::to_string(fine);
  return {layer * (4 * fine + coarse + heights), "(bedrock, sand, tangents)" + times + "; levels",
          "sand" + times + "; levels; heights"};
}

}  // namespace

namespace {
/// Longest part of a step in which hops move sand [s]: the wind's shadow and avalanches follow what a part
/// moves. No parameter: steps of a second are what saltation's parameters were chosen for, and run.time_step
/// makes parts shorter.
constexpr float longest_saltation = 1.0f;
}  // namespace

/// Begins the flux that the hops of a step add to.
Process sand_flux_process() {
  Process p;
  p.name = "sand_flux";
  p.parameters = {saltation_section};
  p.source = "Paris 2019 §5.2";
  p.header = "kernels/sand/saltation.hpp";
  p.roles = {Role::sand_flux};
  p.gives_way = true;
  p.active = [](const Scenario& s) {
    return s.get<SaltationParameters>().enabled && s.get<SaltationParameters>().flux;
  };
  p.writes = {Layer::flux_x, Layer::flux_y};
  p.step = [](StepContext& c, ProcessWorkspace*) {
    if (c.part == 0) with_backend(c.exec(), [&](auto& e) { saltation::clear_flux(e, c.terrain); });
  };
  p.can_be_recorded = [](const SimulationState&) { return false; };  // parts of a step differ
  return p;
}

Process saltation_process() {
  Process p;
  p.name = "saltation";
  p.parameters = {saltation_section, abrasion_section, reptation_section, repose_section, "echo_dunes"};
  p.source = "Nilles 2024 §3.6, Paris 2019 §5.2";
  p.header = "kernels/sand/saltation.hpp";
  p.roles = {Role::sand_transport, Role::repose};  // the deposit sets the angles in its own pass
  p.active = [](const Scenario& s) { return has_sand_model(s, SandModel::hops); };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    check_reach(s, "saltation.hop_time", fastest_wind(s) * s.get<SaltationParameters>().hop_time, errors);
    check_step_length(s, "saltation.hop_time", s.get<SaltationParameters>().hop_time, errors);
  };
  p.reads = {Layer::wind_x,   Layer::wind_y,     Layer::wind_shadow,
             Layer::echo,     Layer::vegetation, Layer::obstacle,
             Layer::moisture, Layer::water,      Layer::erosion_resistance};
  p.writes = {Layer::sand, Layer::airborne_sand};
  p.writes_if_in_use = {Layer::bedrock, Layer::soil, Layer::flux_x, Layer::flux_y};
  p.step = saltate;
  p.longest_step = [](const SimulationState&) { return longest_saltation; };
  p.refresh = set_angles;  // the angles of repose that a step sets with the deposit
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{13 * 4, "sand, airborne, wind (2), shadow; landed, sand, shadow",
                         "sand, landed; sand, airborne, tangents"};
  };
  return p;
}

Process repose_process() {
  Process p;
  p.name = "repose";
  p.parameters = {repose_section, reptation_section};
  p.source = "Nilles 2024 §3.7";
  p.header = "kernels/sand/repose.hpp";
  p.roles = {Role::repose};
  p.gives_way = true;
  p.active = [](const Scenario&) { return true; };
  p.reads = {Layer::wind_x,   Layer::wind_y, Layer::wind_shadow, Layer::vegetation,
             Layer::moisture, Layer::soil,   Layer::sand};
  p.step = p.refresh = set_angles;
  return p;
}

Process reptation_process() {
  Process p;
  p.name = "reptation";
  p.needs = {SharedField::impact_strength};
  p.parameters = {reptation_section};
  p.source = "Nilles 2024 §3.7, Paris 2019 §5.1";
  p.header = "kernels/sand/reptation.hpp";
  p.roles = {Role::reptation};
  p.gives_way = true;
  p.active = [](const Scenario& s) { return reptation::moves_sand(s.get<ReptationParameters>()); };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    const ReptationParameters& r = s.get<ReptationParameters>();
    if (r.method != ReptationMethod::smoothing) return;
    const double lengths = s.run.time_step / s.grid.cell_size * fastest_wind(s);  // the shelter is at most 1
    check_substeps(
        s,
        {"reptation.strength", r.strength, "s/m^2", 2 * (r.strength + r.smoothing_strength) * lengths, 256},
        errors);
  };
  p.reads = {Layer::bedrock, Layer::soil, Layer::wind_x, Layer::wind_y, Layer::obstacle};
  p.writes = {Layer::sand};
  p.step = creep;
  // The number of sub-steps of `smoothing` is read back, and events of `steepest` are drawn by the step.
  p.can_be_recorded = [](const SimulationState& state) {
    const ReptationMethod method = state.scenario.get<ReptationParameters>().method;
    return method != ReptationMethod::smoothing && method != ReptationMethod::steepest;
  };
  return p;
}

Process avalanching_process() {
  Process p;
  p.name = "avalanching";
  p.parameters = {avalanching_section, repose_section};
  p.source = "Nilles 2024 eq. 9–11, Taylor & Keyser 2023";
  p.header = "kernels/avalanching/avalanching.hpp";
  p.roles = {Role::avalanching};
  p.gives_way = true;
  p.active = [](const Scenario& s) { return s.get<AvalanchingParameters>().enabled; };
  p.reads = {Layer::obstacle, Layer::vegetation, Layer::moisture};
  p.writes = {Layer::sand};
  p.writes_if_in_use = {Layer::bedrock, Layer::soil};
  set_workspace<AvalancheWork>(p, make_avalanche_work);
  p.step = slide;
  p.adapt = [](const SimulationState& state, ProcessWorkspace* workspace) {
    workspace_as<AvalancheWork>(workspace).prepare_ground(state);
  };
  p.flags = {bedrock_loose, soil_loose};
  p.edited = [](SimulationState& state, Layer layer) {
    if (layer == Layer::bedrock) state.flags.insert(bedrock_loose);
    // Of bedrock, too: soil may come into use before the next step.
    if (layer == Layer::bedrock || layer == Layer::soil) state.flags.insert(soil_loose);
  };
  p.counter = avalanche_iterations;
  p.counted = [](const ProcessWorkspace& workspace) {
    return static_cast<std::uint64_t>(
        static_cast<const WorkspaceHolder<AvalancheWork>&>(workspace).work.sand.counted_iterations());
  };
  p.after_step = [](StepContext& c, ProcessWorkspace* workspace) {
    c.state.counts[avalanche_iterations] +=
        static_cast<std::uint64_t>(workspace_as<AvalancheWork>(workspace).sand.iterations);
  };
  p.can_leave_heights = true;
  p.can_be_recorded = avalanching_can_be_recorded;
  p.recording_key = [](const StepContext& c) { return c.tick() % avalanching::seam_period; };
  p.traffic = avalanche_traffic;
  return p;
}

namespace {

/// Steps from one look at full cells to the next: meanwhile no cell of an edge gets more than a sixteenth of
/// the room above fill_limit.
std::uint64_t steps_between_overflows(const SimulationState& state) {
  const Scenario& s = state.scenario;
  const double a_step =
      static_cast<double>(s.get<SaltationParameters>().influx) * s.run.time_step / s.grid.cell_size;
  const double room = (wall_height - fill_limit) * state.terrain.scale().quantum() / 16;
  return static_cast<std::uint64_t>(std::clamp(std::floor(room / a_step), 1.0, 4096.0));
}

bool takes_overflow(const SimulationState& state) {
  return state.steps % steps_between_overflows(state) == 0;
}

}  // namespace

Process sand_overflow_process() {
  Process p;
  p.name = "sand_overflow";
  p.parameters = {saltation_section};
  p.source = "conservation of mass, in whole quanta";
  p.header = "kernels/sand/overflow.hpp";
  p.active = [](const Scenario& s) {
    return s.get<SaltationParameters>().influx > 0 && s.grid.boundary == Boundary::open;
  };
  p.reads = {Layer::bedrock, Layer::soil, Layer::water};
  p.writes = {Layer::sand};
  p.step = [](StepContext& c, ProcessWorkspace*) {
    if (c.part == 0 && takes_overflow(c.state))
      with_backend(c.exec(), [&](auto& e) { overflow::take_overflow(e, c.terrain, c.state.ledger()); });
  };
  p.can_be_recorded = [](const SimulationState& state) { return !takes_overflow(state); };
  return p;
}

/// Where starting passes is what takes time, each step finds the wind's shadow, and nothing but saltation
/// asks for it before sand is lifted, the pass that lifts sand finds it.
FusedProcesses fused_wind_shadow_and_saltation() {
  FusedProcesses f;
  f.name = "shadow found in passing";
  f.first = "wind_shadow";
  f.second = "saltation";
  f.applies = [](const SimulationState& state) {
    constexpr int max_cells = 1 << 19;
    const bool on_gpu = state.exec().device() == Device::cuda;  // nor where memory is only planned
    return on_gpu && state.scenario.run.time_step >= state.scenario.run.hold_time &&
           state.terrain.grid().cells() <= max_cells && !state.scenario.get<WindShadowParameters>().curved &&
           !state.scenario.get<EchoDuneParameters>().enabled &&
           !state.scenario.get<SaltationParameters>().flux;
  };
  f.step = [](StepContext& c, ProcessWorkspace* shadow, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) {
      const wind_shadow::Shadow shadow_law = wind_shadow::straight_shadow(
          e, c.terrain, c.scenario().get<WindShadowParameters>(), obstructing_heights(c),
          workspace_as<wind_shadow::Workspace>(shadow), nullptr);
      lift_and_deposit(e, c, &shadow_law);
    });
  };
  return f;
}

}  // namespace desert_sim

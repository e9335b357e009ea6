/// The processes of the wind: the wind at the surface, or its shear stress, its shadow in the lee, and the
/// eddies before cliffs.
#include "kernels/wind/wind.hpp"

#include <string>

#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/shear_stress.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/core/elementary.hpp"
#include "src/simulation/processes/limits.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

void check_angles(const Scenario& s, ValidationErrors& errors) {
  const WindShadowParameters& shadow = s.get<WindShadowParameters>();
  if (shadow.full_deg < shadow.start_deg) errors.add("wind_shadow.full_deg", "must not be below start_deg");
}

void check_reaches(const Scenario& s, ValidationErrors& errors) {
  const EchoDuneParameters& echo = s.get<EchoDuneParameters>();
  if (echo.sticky_reach < echo.erosion_reach)
    errors.add("echo_dunes.sticky_reach", "must not be below erosion_reach");
}

const std::string stress_section = register_section<ShearStressParameters>("shear_stress");
const std::string shadow_section = register_section<WindShadowParameters>("wind_shadow", check_angles);
const std::string echo_section = register_section<EchoDuneParameters>("echo_dunes", check_reaches);

}  // namespace

const surface::Heights& obstructing_heights(const StepContext& c) {
  const bool canopy = c.state.plants && c.scenario().get<VegetationParameters>().canopy_shadow;
  return canopy ? c.state.plants.tops : c.fields.heights;
}

namespace {

/// The local features of the wind on the device.
struct LocalWind {
  std::vector<WindFeature> given;  ///< as the scenario has them
  std::vector<wind_features::Prepared> prepared;
  Buffer<wind_features::Prepared> features;      ///< `prepared` on the device
  Buffer<float> perturbation_x, perturbation_y;  ///< of the features [m/s]; empty where there are none

  std::size_t bytes() const { return features.bytes() + perturbation_x.bytes() + perturbation_y.bytes(); }

  void set_features(const SimulationState& state) {
    const Scenario& s = state.scenario;
    given = s.wind_features;
    prepared.clear();
    if (given.empty()) {
      features = {};
      for (Buffer<float>* buffer : {&perturbation_x, &perturbation_y}) *buffer = {};
      return;
    }
    for (const WindFeature& feature : given)
      prepared.push_back(wind_features::prepare(feature, unit_vector(feature.direction_deg),
                                                state.terrain.grid(), s.grid.origin_x, s.grid.origin_y,
                                                state.time()));
    features = Buffer<wind_features::Prepared>(state.exec(), prepared.size());
    features.upload(prepared);
    if (perturbation_x) return;
    for (Buffer<float>* buffer : {&perturbation_x, &perturbation_y})
      *buffer = Buffer<float>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()));
  }
  /// The perturbation at the time of a step.
  void update(StepContext& c) {
    if (!features) return;
    const GridParameters& grid = c.scenario().grid;
    for (std::size_t n = 0; n < prepared.size(); ++n)
      wind_features::set_time(prepared[n], given[n], c.terrain.grid, grid.origin_x, grid.origin_y, c.time());
    features.upload(prepared);
    with_backend(c.exec(), [&](auto& e) {
      wind_features::step(e, c.terrain.grid, features, c.fields.scratch<float>(0), perturbation_x.data(),
                          perturbation_y.data());
    });
  }
};

/// What finds the wind over the ground (Flow: wind::Workspace or shear_stress::Workspace), and its local
/// features.
template <class Flow>
struct WindWork {
  Flow flow;
  LocalWind local;

  std::size_t bytes() const { return flow.bytes() + local.bytes(); }
};
using TurnedWindWork = WindWork<wind::Workspace>;
using ShearStressWork = WindWork<shear_stress::Workspace>;

template <class Flow>
WindWork<Flow> with_features(const SimulationState& state, Flow flow) {
  WindWork<Flow> work{std::move(flow), {}};
  work.local.set_features(state);
  return work;
}

wind::FlowInputs flow_inputs(const StepContext& c, const LocalWind& local) {
  return {c.wind_above(), c.fields.heights, c.state.wind_reference, local.perturbation_x.data(),
          local.perturbation_y.data()};
}

void update_wind(StepContext& c, ProcessWorkspace* workspace) {
  auto& work = workspace_as<TurnedWindWork>(workspace);
  work.local.update(c);
  with_backend(c.exec(), [&](auto& e) {
    wind::step(e, c.terrain, c.scenario().wind, flow_inputs(c, work.local),
               {c.fields.scratch<float>(1), c.fields.scratch<float>(0)}, work.flow);
  });
}

void update_shear_stress(StepContext& c, ProcessWorkspace* workspace) {
  auto& work = workspace_as<ShearStressWork>(workspace);
  work.local.update(c);
  with_backend(c.exec(), [&](auto& e) {
    shear_stress::step(e, c.terrain, c.scenario().get<ShearStressParameters>(), flow_inputs(c, work.local),
                       work.flow);
  });
}

/// Where the method of its transforms has another hash on each machine: method_of_states().
template <class Flow>
std::string warning_of_transform(const SimulationState&, const ProcessWorkspace& workspace) {
  const Flow& flow = static_cast<const WorkspaceHolder<WindWork<Flow>>&>(workspace).work.flow;
  const int width = flow.coarse.width, height = flow.coarse.height;
  const bool transforms = flow.spectrum.bytes() > 0;
  if (!transforms || method_of_states(width, height, FftMethod::rows_first) != FftMethod::library) return "";
  return "its grid of " + std::to_string(width) + " x " + std::to_string(height) + " values is longer than " +
         std::to_string(longest_line) +
         " and is transformed by FFTW on a CPU and cuFFT on a GPU, so that the state hash depends on the "
         "machine; a larger wind.coarsening or shear_stress.stress_cell makes it coarser";
}

/// What the wind over the ground depends on, whichever way it is found.
Process surface_wind(const char* name) {
  Process p;
  p.name = name;
  p.parameters = {name};
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand};
  p.writes = {Layer::wind_x, Layer::wind_y};
  // The perturbation by local features depends on the time.
  p.can_be_recorded = [](const SimulationState& state) { return state.scenario.wind_features.empty(); };
  return p;
}

void check_transform(const Scenario& s, ValidationErrors& errors) {
  if (!s.wind.warping && !s.wind.projection) return;
  const wind::CoarseGrid coarse = wind::coarse_grid(s.make_grid(), s.wind);
  const long long values = static_cast<long long>(coarse.width) * coarse.height;
  if (values > max_grid_cells)
    errors.add("grid", "of " + std::to_string(s.grid.width) + " x " + std::to_string(s.grid.height) +
                           " cells would need a transform of " + std::to_string(values) +
                           " values for its wind, which cannot be indexed (allowed: at most " +
                           std::to_string(max_grid_cells) + "; wind.coarsening makes it smaller)");
}

void update_wind_shadow(StepContext& c, ProcessWorkspace* workspace) {
  if (!c.renews_held_layers()) return;
  with_backend(c.exec(), [&](auto& e) {
    wind_shadow::step(e, c.terrain, c.scenario().get<WindShadowParameters>(), obstructing_heights(c),
                      workspace_as<wind_shadow::Workspace>(workspace));
  });
}

void update_echo(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    echo_dunes::step(e, c.terrain, c.scenario().get<EchoDuneParameters>(), c.fields.heights,
                     c.fields.scratch<float>(0));
  });
}

}  // namespace

Process wind_process() {
  Process p = surface_wind("wind");
  p.roles = {Role::wind};
  p.gives_way = true;
  p.source = "Paris 2019 §4, Nilles 2024 §3.3";
  p.header = "kernels/wind/wind.hpp";
  p.active = [](const Scenario&) { return true; };
  p.check = check_transform;
  set_workspace<TurnedWindWork>(p, [](const SimulationState& state) {
    return with_features(state,
                         wind::make_workspace(state.exec(), state.terrain.grid(), state.scenario.wind));
  });
  p.step = p.refresh = update_wind;
  p.warning = warning_of_transform<wind::Workspace>;
  p.adapt = [](const SimulationState& state, ProcessWorkspace* workspace) {
    workspace_as<TurnedWindWork>(workspace).local.set_features(state);
  };
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{4 * 4, "heights; heights", "wind (2)"};
  };
  return p;
}

Process shear_stress_process() {
  Process p = surface_wind("shear_stress");
  p.roles = {Role::wind, Role::wind_shadow};  // its bubbles are the shadow
  p.source = "Kroy et al. 2002, Durán & Moore 2013";
  p.header = "kernels/wind/shear_stress.hpp";
  p.active = [](const Scenario& s) { return has_sand_model(s, SandModel::continuum); };
  set_workspace<ShearStressWork>(p, [](const SimulationState& state) {
    return with_features(state, shear_stress::make_workspace(state.exec(), state.terrain.grid(),
                                                             state.scenario.get<ShearStressParameters>()));
  });
  p.step = p.refresh = update_shear_stress;
  p.warning = warning_of_transform<shear_stress::Workspace>;
  p.adapt = [](const SimulationState& state, ProcessWorkspace* workspace) {
    workspace_as<ShearStressWork>(workspace).local.set_features(state);
  };
  return p;
}

Process wind_shadow_process() {
  Process p;
  p.name = "wind_shadow";
  p.parameters = {shadow_section};
  p.source = "Nilles 2024 eq. 4";
  p.header = "kernels/wind/wind_shadow.hpp";
  p.roles = {Role::wind_shadow};
  p.gives_way = true;
  p.active = [](const Scenario& s) { return s.get<WindShadowParameters>().enabled; };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    check_reach(s, "wind_shadow.distance", s.get<WindShadowParameters>().distance, errors);
  };
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::canopy_height, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::wind_shadow};
  set_workspace<wind_shadow::Workspace>(p, [](const SimulationState& state) {
    return wind_shadow::make_workspace(state.exec(), state.terrain.grid(),
                                       state.scenario.get<WindShadowParameters>());
  });
  p.step = p.refresh = update_wind_shadow;
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{3 * 4, "heights, wind (2) of every other row", "shadow"};
  };
  return p;
}

Process echo_dune_process() {
  Process p;
  p.name = "echo_dunes";
  p.parameters = {echo_section};
  p.source = "Tsoar 1983, Taylor & Keyser 2023";
  p.header = "kernels/wind/echo_dunes.hpp";
  p.active = [](const Scenario& s) { return s.get<EchoDuneParameters>().enabled; };
  p.check = [](const Scenario& s, ValidationErrors& errors) {
    const EchoDuneParameters& echo = s.get<EchoDuneParameters>();
    check_reach(s, "echo_dunes.sticky_reach", static_cast<double>(echo.sticky_reach) * echo.highest, errors);
    const double steepness = elementary::tan_deg(echo.cliff_deg);  // from the top of a cliff to its foot
    check_reach(s, "echo_dunes.highest", echo.highest / steepness, errors);
  };
  p.reads_heights = true;
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::echo};
  p.step = p.refresh = update_echo;
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{6 * 4, "heights, wind (2); cliffs", "cliffs; echo"};
  };
  return p;
}

}  // namespace desert_sim

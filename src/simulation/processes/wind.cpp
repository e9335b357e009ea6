/// The processes of the wind: the wind at the surface, its shadow in the lee, and the eddies before cliffs.
#include "kernels/wind/wind.hpp"

#include "kernels/wind/echo_dunes.hpp"
#include "kernels/wind/wind_features.hpp"
#include "kernels/wind/wind_shadow.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

const surface::Heights& obstructing_heights(const StepContext& c) {
  const bool canopy = c.state.plants && c.scenario().vegetation.canopy_shadow;
  return canopy ? c.state.plants.tops : c.fields.heights;
}

namespace {

/// The wind's coarse grid, and its local features on the device.
struct WindWork {
  wind::Workspace coarse;
  std::vector<wind_features::Prepared> prepared;
  Buffer<wind_features::Prepared> features;      ///< `prepared` on the device
  Buffer<float> perturbation_x, perturbation_y;  ///< of the features [m/s]; empty where there are none

  std::size_t bytes() const {
    return coarse.bytes() + features.bytes() + perturbation_x.bytes() + perturbation_y.bytes();
  }

  void set_features(const SimulationState& state) {
    const Scenario& s = state.scenario;
    prepared.clear();
    if (s.wind_features.empty()) {
      features = {};
      for (Buffer<float>* buffer : {&perturbation_x, &perturbation_y}) *buffer = {};
      return;
    }
    for (const WindFeature& feature : s.wind_features)
      prepared.push_back(wind_features::prepare(feature, unit_vector(feature.direction_deg),
                                                state.terrain.grid(), s.grid.origin_x, s.grid.origin_y,
                                                state.time()));
    features = Buffer<wind_features::Prepared>(state.exec(), prepared.size());
    features.upload(prepared);
    if (perturbation_x) return;
    for (Buffer<float>* buffer : {&perturbation_x, &perturbation_y})
      *buffer = Buffer<float>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()));
  }
  void set_time(double time) {
    for (wind_features::Prepared& feature : prepared) wind_features::set_time(feature, time);
    features.upload(prepared);
  }
};

WindWork make_wind_work(const SimulationState& state) {
  WindWork work{
      wind::make_workspace(state.exec(), state.terrain.grid(), state.scenario.wind), {}, {}, {}, {}};
  work.set_features(state);
  return work;
}

void update_wind(StepContext& c, ProcessWorkspace* workspace) {
  WindWork& work = workspace_as<WindWork>(workspace);
  const SimulationState& s = c.state;
  if (work.features) work.set_time(c.time());
  with_backend(c.exec(), [&](auto& e) {
    if (c.fields.heights_stale) surface::compute_heights(e, c.terrain, c.fields.heights);
    if (work.features)
      wind_features::step(e, c.terrain.grid, work.features, c.fields.repose.data(),
                          work.perturbation_x.data(), work.perturbation_y.data());
    wind::step(e, c.terrain, s.scenario.wind, c.wind_above(), c.fields.heights, s.wind_reference,
               work.perturbation_x.data(), work.perturbation_y.data(),
               {reinterpret_cast<float*>(c.fields.landed.data()), c.fields.repose.data()}, work.coarse);
  });
}

void update_wind_shadow(StepContext& c, ProcessWorkspace* workspace) {
  if (!c.renews_shelter()) return;
  with_backend(c.exec(), [&](auto& e) {
    wind_shadow::step(e, c.terrain, c.scenario().wind_shadow, obstructing_heights(c),
                      workspace_as<wind_shadow::Workspace>(workspace));
  });
}

void update_echo(StepContext& c, ProcessWorkspace*) {
  with_backend(c.exec(), [&](auto& e) {
    echo_dunes::step(e, c.terrain, c.scenario().echo_dunes, c.fields.heights, c.fields.repose.data());
  });
}

}  // namespace

Process wind_process() {
  Process p;
  p.name = "wind";
  p.parameters = {"wind"};
  p.source = "Paris 2019 §4, Nilles 2024 §3.3";
  p.header = "kernels/wind/wind.hpp";
  p.active = [](const Scenario&) { return true; };
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand};
  p.writes = {Layer::wind_x, Layer::wind_y};
  set_workspace<WindWork>(p, make_wind_work);
  p.step = p.refresh = update_wind;
  p.adapt = [](const SimulationState& state, ProcessWorkspace* workspace) {
    workspace_as<WindWork>(workspace).set_features(state);
  };
  // The perturbation by local features depends on the time.
  p.can_be_recorded = [](const SimulationState& state) { return state.scenario.wind_features.empty(); };
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{4 * 4, "heights; heights", "wind (2)"};
  };
  return p;
}

Process wind_shadow_process() {
  Process p;
  p.name = "wind_shadow";
  p.parameters = {"wind_shadow"};
  p.source = "Nilles 2024 eq. 4";
  p.header = "kernels/wind/wind_shadow.hpp";
  p.active = [](const Scenario& s) { return s.wind_shadow.enabled; };
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::canopy_height, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::wind_shadow};
  set_workspace<wind_shadow::Workspace>(p, [](const SimulationState& state) {
    return wind_shadow::make_workspace(state.exec(), state.terrain.grid(), state.scenario.wind_shadow);
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
  p.parameters = {"echo_dunes"};
  p.source = "Tsoar 1983, Taylor & Keyser 2023";
  p.header = "kernels/wind/echo_dunes.hpp";
  p.active = [](const Scenario& s) { return s.echo_dunes.enabled; };
  p.reads = {Layer::bedrock, Layer::soil, Layer::sand, Layer::wind_x, Layer::wind_y};
  p.writes = {Layer::echo};
  p.step = p.refresh = update_echo;
  p.traffic = [](const Scenario&, const Grid&) {
    return MemoryTraffic{6 * 4, "heights, wind (2); cliffs", "cliffs; echo"};
  };
  return p;
}

}  // namespace desert_sim

#include "src/simulation/start.hpp"

#include <set>

#include "src/scenario/live_parameters.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/simulation/checkpoint.hpp"

namespace desert_sim {

namespace {

/// What differs between the state of a checkpoint and the scenario that begins with it.
struct Differences {
  Settings settings;  ///< of parameters that can change while a simulation runs
  bool wind_regime = false;
};

/// Throws ConfigError for what cannot change.
Differences differences(const Scenario& state, const Scenario& wanted, const std::string& path) {
  std::set<std::string> of_regime{"wind.segments"};
  visit_parameters(state.wind_regime, [&](const ParameterRow& row, ConstParameterValue) {
    of_regime.insert("wind." + std::string(row.name));
  });
  // Those of a run are of the scenario alone, and features are taken as they are.
  const std::set<std::string> own{"run.steps", "run.duration",     "run.timeline", "run.start_from",
                                  "terrain",   "grid.from_raster", "wind.features"};
  Differences found;
  ValidationErrors errors(wanted.name + ": run.start_from: " + path);
  for (const auto& [key, value] : changed_parameters(state, wanted)) {
    if (own.count(key) > 0) continue;
    const char* reason = fixed_reason(key);
    if (reason && key != "wind.segments")
      errors.add(key, value + " is not what the checkpoint has: " + reason);
    else if (of_regime.count(key) > 0)
      found.wind_regime = true;
    else
      found.settings.push_back(key + "=" + value);
  }
  errors.throw_if_any();
  return found;
}

void put_under(Simulation& simulation, Scenario scenario, const std::string& path) {
  SimulationState& state = simulation.state();
  scenario.wind_series = state.scenario.wind_series;
  scenario.projection = state.scenario.projection;
  const Differences different = differences(state.present_scenario(), scenario, path);
  if (!different.settings.empty()) simulation.commands().apply(command::SetParameters{different.settings});
  if (different.wind_regime)
    state.set_wind_regime({scenario.wind_regime, scenario.wind_segments, scenario.wind_series});
  state.scenario = state.start = scenario;
  simulation.commands().read_timeline();
  simulation.pipeline().adapt();  // features need memory
}

}  // namespace

std::unique_ptr<Simulation> simulation_at_start(Exec& exec, const Scenario& scenario,
                                                const RasterLoader& load_raster, const std::string& folder) {
  if (scenario.run.start_from.empty()) return std::make_unique<Simulation>(exec, scenario, load_raster);
  const std::string path = raster_path(scenario, scenario.run.start_from);
  std::unique_ptr<Simulation> simulation = load_checkpoint(path, exec, folder);
  put_under(*simulation, scenario, path);
  return simulation;
}

}  // namespace desert_sim

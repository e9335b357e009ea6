#include "src/simulation/simulation.hpp"

#include <algorithm>

#include "src/core/error.hpp"
#include "src/simulation/memory/memory.hpp"

namespace desert_sim {

namespace {

HeightScale scale_for(const HostLayers& layers, const Scenario& scenario, const ProcessTable& table) {
  const std::vector<double>&bedrock = layers.at(Layer::bedrock), &sand = layers.at(Layer::sand);
  const auto soil = layers.find(Layer::soil);
  double lowest = bedrock[0], highest = bedrock[0];
  for (std::size_t i = 0; i < bedrock.size(); ++i) {
    lowest = std::min(lowest, bedrock[i]);
    highest = std::max(highest, bedrock[i] + sand[i] + (soil == layers.end() ? 0.0 : soil->second[i]));
  }
  for (const Process& process : table.processes)
    if (process.highest && table.is_active(process, scenario))
      highest = std::max(highest, process.highest(scenario));
  for (const auto& [layer, values] : layers)
    if (info(layer).storage == Storage::quanta && layer != Layer::bedrock)
      highest = std::max(highest, lowest + *std::max_element(values.begin(), values.end()));
  return HeightScale::covering(lowest, highest);
}

Terrain build(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster,
              const ProcessTable& table) {
  table.require_runnable(scenario);
  if (!scenario.run.start_from.empty())
    throw Error(scenario.name + ": run.start_from: simulation_at_start() begins with a checkpoint");
  if (scenario.wind_regime.regime == WindRegimeKind::series && !scenario.wind_series)
    throw ConfigError(scenario.name + ": wind.series_file: has not been read");
  require_memory(exec, scenario, bytes_to_build(scenario));
  const HostLayers layers = build_terrain(scenario, load_raster);
  Terrain terrain(exec, scenario.make_grid(), scale_for(layers, scenario, table));
  for (const auto& [layer, values] : layers) terrain.set_values(layer, values);
  return terrain;
}

}  // namespace

Simulation::Simulation(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster,
                       const ProcessTable& table)
    : Simulation(scenario, build(exec, scenario, load_raster, table), table) {
  state_.wind_regime = WindRegime{scenario.wind_regime, scenario.wind_segments, scenario.wind_series};
  state_.ripple_wind = RippleWind::settled(state_.wind_above());
  state_.begin_balance();
}

Simulation::Simulation(const Scenario& scenario, Terrain terrain, const ProcessTable& table)
    : state_(scenario, std::move(terrain)),
      pipeline_(state_, table),
      commands_(state_, pipeline_),
      views_(state_, pipeline_) {}

void Simulation::step() {
  if (steps() >= max_simulation_steps)
    throw StateError(std::to_string(max_simulation_steps) +
                     " steps are done, which is as far as the clock counts");
  commands_.apply_timeline();
  const double before = time();
  const wind::Vector wind = state_.wind_above();
  pipeline_.step();
  state_.ripple_wind.advance(wind, time() - before, scenario().get<MicroReliefParameters>());
}

std::vector<MemoryPart> Simulation::memory() const { return memory_of(state_, pipeline_, views_); }

}  // namespace desert_sim

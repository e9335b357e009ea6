#include "src/tools/terrain_series.hpp"

#include "src/core/error.hpp"
#if DESERT_WITH_IO
#include "src/io/netcdf_file.hpp"
#endif

namespace desert_sim {

#if DESERT_WITH_IO

namespace {

std::shared_ptr<const Snapshot> snapshot_of(Simulation& simulation) {
  std::vector<Layer> layers = simulation.state().layers_in_use();
  if (simulation.views().shows(Layer::plants)) layers.push_back(Layer::plants);
  return simulation.views().snapshot(layers);
}

}  // namespace

TerrainSeries::TerrainSeries(const std::string& path, Simulation& simulation)
    : last_step_(simulation.steps()) {
  const Scenario& scenario = simulation.scenario();
  NetcdfHead head{scenario.name, scenario.projection, {}};
  if (scenario.wind_series) head.date = scenario.wind_series->date;
  const auto first = snapshot_of(simulation);
  file_ = std::make_unique<NetcdfWriter>(path, head, *first);
  file_->add(*first);
}

TerrainSeries::~TerrainSeries() = default;

void TerrainSeries::add(Simulation& simulation) {
  if (simulation.steps() == last_step_) return;
  file_->add(*snapshot_of(simulation));
  last_step_ = simulation.steps();
}

#else

class NetcdfWriter {};
TerrainSeries::TerrainSeries(const std::string& path, Simulation&) {
  throw ConfigError(path + ": this build knows no NetCDF (it was built without GDAL and OpenCV)");
}
TerrainSeries::~TerrainSeries() = default;
void TerrainSeries::add(Simulation&) {}

#endif

}  // namespace desert_sim

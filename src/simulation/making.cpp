/// Making a simulation: its terrain, the memory that its processes work with, its books.
#include <algorithm>
#include <cmath>

#include "src/core/error.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/pipeline/memory.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

namespace {

HeightScale scale_for(const HostLayers& layers, const Scenario& scenario) {
  const std::vector<double>&bedrock = layers.at(Layer::bedrock), &sand = layers.at(Layer::sand);
  const auto soil = layers.find(Layer::soil);
  double lowest = bedrock[0], highest = bedrock[0];
  for (std::size_t i = 0; i < bedrock.size(); ++i) {
    lowest = std::min(lowest, bedrock[i]);
    highest = std::max(highest, bedrock[i] + sand[i] + (soil == layers.end() ? 0.0 : soil->second[i]));
  }
  if (scenario.has_water() && scenario.water.sea != Sea::none)
    highest = std::max(highest, static_cast<double>(scenario.water.sea_level));
  for (const auto& [layer, values] : layers)
    if (info(layer).storage == Storage::quanta && layer != Layer::bedrock)
      highest = std::max(highest, lowest + *std::max_element(values.begin(), values.end()));
  return HeightScale::covering(lowest, highest);
}

}  // namespace

void require_reach(const Scenario& s) {
  Faults faults(s.name);
  const auto check = [&](const char* key, double metres) {
    const double cells = metres / s.grid.cell_size;
    if (cells > longest_reach)
      faults.add(key, "reaches over " + std::to_string(static_cast<long long>(cells)) + " cells of " +
                          std::to_string(s.grid.cell_size) + " m (allowed: " + std::to_string(longest_reach) +
                          ")");
  };
  check("wind_shadow.distance", s.wind_shadow.distance);
  check("echo_dunes.sticky_reach", static_cast<double>(s.echo_dunes.sticky_reach) * s.echo_dunes.highest);
  const double steepness = std::tan(s.echo_dunes.cliff_deg * 3.14159265358979 / 180.0);
  if (s.echo_dunes.enabled)  // from the top of a cliff to its foot
    check("echo_dunes.highest", s.echo_dunes.highest / steepness);
  double fastest = s.wind_regime.speed;
  for (const WindSegment& segment : s.wind_segments)
    fastest = std::max(fastest, static_cast<double>(segment.speed));
  check("run.time_step", fastest * s.wind.speedup_highest * s.run.time_step);
  faults.throw_if_any();
}

namespace {

HostLayers build_if_it_fits(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster) {
  require_reach(scenario);
  require_memory(exec, scenario, bytes_to_build(scenario));
  return build_terrain(scenario, load_raster);
}

}  // namespace

Simulation::Simulation(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster)
    : Simulation(exec, scenario, build_if_it_fits(exec, scenario, load_raster)) {}

Simulation::Simulation(Exec& exec, const Scenario& scenario, const HostLayers& layers)
    : Simulation(scenario, Terrain(exec, scenario.make_grid(), scale_for(layers, scenario))) {
  for (const auto& [layer, values] : layers) terrain_.set_values(layer, values);
  regime_ = WindRegime{scenario.wind_regime, scenario.wind_segments};
  start_books();
}

Simulation::Simulation(const Scenario& scenario, Terrain terrain)
    : start_(scenario), scenario_(scenario), terrain_(std::move(terrain)) {
  allocate_work();
}

void Simulation::allocate_work() {
  Exec& e = exec();
  const Grid& grid = terrain_.grid();
  const std::size_t cells = static_cast<std::size_t>(grid.cells());
  ledger_ = Buffer<long long>(e, LedgerView::words);
  ledger_.set_zero();
  landed_ = Buffer<Quanta>(e, cells);
  repose_ = Buffer<float>(e, cells);
  heights_ = surface::make_heights(e, grid);
  repose_.set_zero();
  prepare_processes();
  make_plants();
  upload_wind_features();
}

void Simulation::make_plants() {
  const Scenario& s = scenario_;
  if (!s.vegetation.enabled) return;
  for (Layer layer : {Layer::vegetation, Layer::humus, Layer::canopy_height, Layer::illumination,
                      Layer::illumination_canopy})
    terrain_.require(layer);
  std::vector<SpeciesTraits> traits;
  for (const Species& species : s.species) traits.push_back(species.traits);
  const int most = s.vegetation.max_plants;
  plants_ = plants::make_workspace(exec(), terrain_.grid(), most > 0 ? most : terrain_.grid().cells(), traits,
                                   s.competition);
}

void Simulation::set_plants(const std::vector<std::uint32_t>& words) {
  const std::size_t count = words.size() / plants::column_count,
                    room = static_cast<std::size_t>(plants_.capacity);
  if (count > room)
    throw ConfigError(std::to_string(count) + " plants are more than there is room for, " +
                      std::to_string(room));
  for (std::size_t c = 0; c < plants::column_count && count > 0; ++c)
    exec().upload(plants_.next.data() + c * room, words.data() + c * count, count * sizeof(std::uint32_t));
  with_backend(exec(), [&](auto& e) { plants::order(e, static_cast<int>(count), 0, plants_); });
}

void Simulation::prepare_processes() {
  recordings_.forget();
  Exec& e = exec();
  const Grid& grid = terrain_.grid();
  const Scenario& s = scenario_;
  // A layer is there only while its process is on: others take its absence for "no shadow", "no echo".
  terrain_.use(Layer::wind_shadow, s.wind_shadow.enabled);
  terrain_.use(Layer::echo, s.echo_dunes.enabled);
  reptation_strength_ = {};
  if (reptation::moves_sand(s.reptation)) {
    reptation_strength_ = Buffer<float>(e, static_cast<std::size_t>(grid.cells()));
    reptation_strength_.set_zero();  // without grains there are no impacts
  }
  wind_work_ = wind::make_workspace(e, grid, s.wind);
  shadow_work_ = wind_shadow::make_workspace(e, grid, s.wind_shadow);
  avalanching::Workspace avalanches = avalanching::make_workspace(e, grid, s.avalanching);
  avalanche_iterations_ = avalanche_iterations();
  avalanche_work_ = std::move(avalanches);
  prepare_water();
  if (wears_ground(s) || bedrock_loose_ || soil_loose_) prepare_ground_avalanches();
}

/// What lies in layers stays there when its process is switched off.
void Simulation::prepare_water() {
  const Scenario& s = scenario_;
  const std::size_t cells = static_cast<std::size_t>(terrain_.grid().cells());
  if (s.has_water())
    for (Layer layer : {Layer::water, Layer::water_flux_x, Layer::water_flux_y}) terrain_.require(layer);
  for (Layer layer : {Layer::water_velocity_x, Layer::water_velocity_y}) terrain_.use(layer, s.has_water());
  if (s.hydraulic_erosion.enabled) terrain_.require(Layer::suspended_sediment);
  if (s.moisture.enabled) terrain_.require(Layer::moisture);
  if (s.soil.enabled) terrain_.require(Layer::soil);
  pipes_work_.held = s.has_water() ? Buffer<float>(exec(), cells) : Buffer<float>();
  erosion_work_.capacity = s.hydraulic_erosion.enabled ? Buffer<float>(exec(), cells) : Buffer<float>();
}

bool wears_ground(const Scenario& s) {
  return s.abrasion.rate > 0 || s.hydraulic_erosion.enabled || s.soil.enabled;
}

void Simulation::prepare_ground_avalanches() {
  const AvalanchingParameters& p = scenario_.avalanching;
  if (!ground_work_.received && p.enabled && (p.soil || p.bedrock))
    ground_work_ = avalanching::make_ground_workspace(exec(), terrain_.grid());
}

void Simulation::upload_wind_features() {
  const Scenario& s = scenario_;
  if (s.wind_features.empty()) {
    features_ = {};
    for (Buffer<float>* buffer : {&perturbation_x_, &perturbation_y_}) *buffer = {};
    return;
  }
  std::vector<wind_features::Prepared> prepared;
  for (const WindFeature& feature : s.wind_features) {
    const wind::Vector direction = unit_vector(feature.direction_deg);
    prepared.push_back({feature, direction.x, direction.y});
    prepared.back().feature.x -= static_cast<float>(s.grid.origin_x);
    prepared.back().feature.y -= static_cast<float>(s.grid.origin_y);
  }
  features_ = Buffer<wind_features::Prepared>(exec(), prepared.size());
  features_.upload(prepared);
  if (perturbation_x_) return;
  for (Buffer<float>* buffer : {&perturbation_x_, &perturbation_y_})
    *buffer = Buffer<float>(exec(), static_cast<std::size_t>(terrain_.grid().cells()));
}

void Simulation::start_books() {
  with_backend(exec(), [this](auto& e) { surface::fill_elevation(e, terrain_.view()); });
  const std::vector<std::uint32_t> surface = terrain_.words(Layer::elevation);
  Quanta lowest = wall_height;
  for (std::uint32_t word : surface) lowest = std::min(lowest, static_cast<Quanta>(word));
  wind_reference_ = lowest;
  for (int m = 0; m < material_count; ++m)
    initial_[static_cast<std::size_t>(m)] = material_now(static_cast<Material>(m));
}

}  // namespace desert_sim

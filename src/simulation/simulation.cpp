#include "desert_sim/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "desert_sim/core/error.hpp"
#include "desert_sim/scenario/yaml_parameters.hpp"
#include "desert_sim/simulation/memory.hpp"

namespace desert_sim {

// ---- one step

template <class E>
void Simulation::run_processes(E& exec) {
  const Scenario& s = scenario_;
  const TerrainView view = terrain_.view();
  const float dt = s.run.time_step;

  // Wind at the surface: speed-up, deflection by the terrain, divergence-free, local features (A1–A5).
  run(exec, "wind", {Layer::wind_x, Layer::wind_y}, [&] { update_wind(exec, view); });

  // Shelter in the lee of what is higher upwind (A6). Where starting passes is what takes time, and nothing
  // else asks for it before sand is lifted, that pass finds it.
  constexpr int few_cells = 1 << 19;
  const bool shade_in_passing = !works_on_rows<E> && view.grid.cells() <= few_cells && shadow_can_wait();
  if (s.wind_shadow.enabled && !shade_in_passing)
    run(exec, "wind_shadow", {Layer::wind_shadow},
        [&] { wind_shadow::step(exec, view, s.wind_shadow, heights_, shadow_work_); });

  // The eddy before cliffs, which holds sand off and piles it up ahead (A7).
  if (s.echo_dunes.enabled)
    run(exec, "echo_dunes", {Layer::echo},
        [&] { echo_dunes::step(exec, view, s.echo_dunes, heights_, repose_.data()); });

  // Sand is lifted, carried a hop, deposited or bounced on; bouncing sand wears rock (B1–B4).
  // Impacts loosen what they hit, which sets its angle of repose (B5, B7).
  const reptation::Angle angle(view, s.reptation, s.repose, repose_.data());
  if (s.saltation.enabled)
    run(exec, "saltation", {Layer::sand, Layer::airborne_sand, Layer::bedrock}, [&] {
      std::optional<wind_shadow::Shadow> shade;
      if (shade_in_passing)
        shade = wind_shadow::straight_shadow(exec, view, s.wind_shadow, heights_, shadow_work_);
      saltation::step(exec, view, s.saltation, s.abrasion, s.repose, dt, ledger(), landed_.data(),
                      {angle, reptation_strength_.data()}, shade ? &*shade : nullptr);
    });
  else
    reptation::set_angles(exec, view, angle, s.repose, nullptr);

  // Or they creep sand down the slope (B5).
  if (reptation::moves_sand(s.reptation))
    run(exec, "reptation", {Layer::sand}, [&] {
      reptation::step(exec, view, s.reptation, dt, s.seed, steps_, reptation_strength_.data(),
                      landed_.data());
    });

  // What is too steep slides: rock and soil where they changed, then sand (B6).
  if (s.avalanching.enabled)
    run(exec, "avalanching", {Layer::sand, Layer::bedrock}, [&] {
      slide_ground(exec, view);
      avalanching::step(exec, view, s.avalanching, steps_, repose_.data(), avalanche_work_);
    });
}

/// Soil and bedrock slide only where something changes them: abrasion, or an edit, until all has come to
/// rest.
template <class E>
void Simulation::slide_ground(E& exec, const TerrainView& view) {
  const AvalanchingParameters& p = scenario_.avalanching;
  const bool wearing = scenario_.abrasion.rate > 0;
  const auto moved = [&] { return statistics::sum(exec, view.grid, landed_.data()) != 0; };
  if (p.soil && (wearing || soil_loose_) && terrain_.has(Layer::soil)) {
    avalanching::step_soil(exec, view, p, scenario_.repose, landed_.data(), ground_work_);
    if (soil_loose_) soil_loose_ = moved();
  }
  if (p.bedrock && (wearing || bedrock_loose_)) {
    avalanching::step_bedrock(exec, view, p, scenario_.repose, ledger(), landed_.data(), ground_work_);
    if (bedrock_loose_) bedrock_loose_ = moved();
  }
  soil_loose_ = soil_loose_ || (bedrock_loose_ && terrain_.has(Layer::soil));
}

template <class E>
void Simulation::update_wind(E& exec, const TerrainView& view) {
  surface::measure(exec, view, heights_);
  if (features_)
    wind_features::step(exec, view.grid, features_, static_cast<float>(time()), repose_.data(),
                        perturbation_x_.data(), perturbation_y_.data());
  wind::step(exec, view, scenario_.wind, wind_above(), heights_, wind_reference_, perturbation_x_.data(),
             perturbation_y_.data(), wind_work_);
}

template <class E, class Process>
void Simulation::run(E& exec, const char* name, std::initializer_list<Layer> writes, Process&& process) {
  const auto start = std::chrono::steady_clock::now();
  process();
  if (checks_layers())
    for (Layer layer : writes) check(exec, name, layer);
  if (!timing_) return;
  exec.synchronise();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  for (ProcessTime& t : process_times_)
    if (t.process == name) {
      t.milliseconds += elapsed.count();
      return;
    }
  process_times_.push_back({name, elapsed.count()});
}

template <class E>
void Simulation::check(E& exec, const char* process, Layer layer) {
  const LayerInfo& row = info(layer);
  const TerrainView view = terrain_.view();
  const bool quanta = row.storage == Storage::quanta;
  const long long broken = statistics::broken_cells(exec, view.grid, quanta ? view.quanta(layer) : nullptr,
                                                    quanta ? nullptr : view.real(layer), row.lowest == 0);
  if (broken == 0) return;
  const std::vector<float> values = terrain_.values(layer);
  std::size_t cell = 0;
  while (cell + 1 < values.size() && std::isfinite(values[cell]) && !(row.lowest == 0 && values[cell] < 0))
    ++cell;
  throw StateError("step " + std::to_string(steps_) + ": " + process + ": layer " + row.name +
                   " is broken in " + std::to_string(broken) + " cells, first (" +
                   std::to_string(cell % view.grid.width) + ", " + std::to_string(cell / view.grid.width) +
                   ") = " + std::to_string(values[cell]));
}

/// Whether nothing but saltation needs the wind's shadow, neither a process nor who checks or times them.
bool Simulation::shadow_can_wait() const {
  const Scenario& s = scenario_;
  return s.wind_shadow.enabled && !s.wind_shadow.curved && s.saltation.enabled && !s.echo_dunes.enabled &&
         !timing_ && !checks_layers();
}

bool Simulation::checks_layers() const {
  const int every = scenario_.run.check_every;
  return every > 0 && (steps_ + 1) % static_cast<std::uint64_t>(every) == 0;
}

bool Simulation::recordable() const {
  const Scenario& s = scenario_;
  const bool steady_reptation =
      s.reptation.method == ReptationMethod::off || s.reptation.method == ReptationMethod::adaptive_repose;
  const bool fixed_sweeps = !s.avalanching.enabled || s.avalanching.quality != AvalancheQuality::converged;
  return exec().records() && !timing_ && !checks_layers() && s.wind_features.empty() && steady_reptation &&
         fixed_sweeps && !bedrock_loose_ && !soil_loose_;
}

void Simulation::step() {
  const auto work = [this] { with_backend(exec(), [this](auto& e) { run_processes(e); }); };
  if (recordable())
    recordings_.run(exec(), {wind_above(), steps_ % avalanching::turns, terrain_.view()}, work);
  else
    work();
  if (scenario_.avalanching.enabled)
    avalanche_iterations_ += static_cast<std::uint64_t>(avalanche_work_.iterations);
  ++steps_;
  derived_ready_ = true;
}

void Simulation::refresh_derived() {
  if (derived_ready_) return;
  const Scenario& s = scenario_;
  with_backend(exec(), [&](auto& e) {
    const TerrainView view = terrain_.view();
    update_wind(e, view);
    if (s.wind_shadow.enabled) wind_shadow::step(e, view, s.wind_shadow, heights_, shadow_work_);
    if (s.echo_dunes.enabled) echo_dunes::step(e, view, s.echo_dunes, heights_, repose_.data());
    reptation::set_angles(e, view, reptation::Angle(view, s.reptation, s.repose, repose_.data()), s.repose,
                          nullptr);
  });
  derived_ready_ = true;
}

// ---- making

namespace {

HeightScale scale_for(const HostLayers& layers) {
  const std::vector<double>&bedrock = layers.at(Layer::bedrock), &sand = layers.at(Layer::sand);
  const auto soil = layers.find(Layer::soil);
  double lowest = bedrock[0], highest = bedrock[0];
  for (std::size_t i = 0; i < bedrock.size(); ++i) {
    lowest = std::min(lowest, bedrock[i]);
    highest = std::max(highest, bedrock[i] + sand[i] + (soil == layers.end() ? 0.0 : soil->second[i]));
  }
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
    : Simulation(scenario, Terrain(exec, scenario.make_grid(), scale_for(layers))) {
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
  upload_wind_features();
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
  avalanche_work_ = avalanching::make_workspace(e, grid, s.avalanching);
  if (s.abrasion.rate > 0 || bedrock_loose_ || soil_loose_) prepare_ground_avalanches();
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

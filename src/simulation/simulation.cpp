#include "src/simulation/simulation.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "src/core/error.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/pipeline/memory.hpp"

namespace desert_sim {

template <class E>
void Simulation::run_processes(E& exec) {
  const Scenario& s = scenario_;
  const TerrainView view = terrain_.view();
  const float dt = s.run.time_step;

  // Wind at the surface: speed-up, deflection by the terrain, divergence-free, local features (A1–A5).
  run(exec, "wind", {Layer::wind_x, Layer::wind_y}, [&] { update_wind(exec, view); });

  // Plants cover the ground, and shade each other (D).
  if (plants_) {
    run(exec, "plant_cover", {Layer::vegetation, Layer::humus, Layer::canopy_height},
        [&] { plants::cover(exec, view, s.vegetation, dt, heights_, true, plants_); });
    run(exec, "illumination", {Layer::illumination, Layer::illumination_canopy},
        [&] { plants::illuminate(exec, view, s.vegetation, heights_, plants_); });
  }

  // Shelter in the lee of what is higher upwind (A6). Where starting passes is what takes time, and nothing
  // else asks for it before sand is lifted, that pass finds it.
  constexpr int few_cells = 1 << 19;
  const bool shade_in_passing = !works_on_rows<E> && view.grid.cells() <= few_cells && shadow_can_wait();
  if (s.wind_shadow.enabled && !shade_in_passing)
    run(exec, "wind_shadow", {Layer::wind_shadow},
        [&] { wind_shadow::step(exec, view, s.wind_shadow, obstructing_heights(), shadow_work_); });

  // The eddy before cliffs, which holds sand off and piles it up ahead (A7).
  if (s.echo_dunes.enabled)
    run(exec, "echo_dunes", {Layer::echo},
        [&] { echo_dunes::step(exec, view, s.echo_dunes, heights_, repose_.data()); });

  // Sand is lifted, carried a hop, deposited or bounced on; bouncing sand wears rock (B1–B4).
  // Impacts loosen what they hit, which sets its angle of repose (B5, B7).
  const reptation::Angle angle(s.reptation, s.repose, repose_.data());
  if (s.saltation.enabled)
    run(exec, "saltation", {Layer::sand, Layer::airborne_sand, Layer::bedrock}, [&] {
      std::optional<wind_shadow::Shadow> shade;
      if (shade_in_passing)
        shade = wind_shadow::straight_shadow(exec, view, s.wind_shadow, obstructing_heights(), shadow_work_,
                                             nullptr);
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
      avalanching::step(exec, view, s.avalanching, steps_, repose_.data(),
                        avalanches_end_the_step() ? &heights_ : nullptr, avalanche_work_);
    });
}

const surface::Heights& Simulation::obstructing_heights() const {
  return plants_ && scenario_.vegetation.canopy_shadow ? plants_.tops : heights_;
}

template <class E>
void Simulation::run_water(E& exec) {
  const Scenario& s = scenario_;
  const TerrainView view = terrain_.view();
  const float dt = s.run.time_step;

  // It rains, springs run, the sea keeps its level (C1).
  run(exec, "rain", {Layer::water}, [&] {
    rain::step(exec, view, s.rain, dt, s.seed, steps_, terrain_.scale().datum, ledger());
    for (const Spring& spring : s.springs)
      water_sources::pour(exec, view, spring, spring.x - s.grid.origin_x, spring.y - s.grid.origin_y, dt,
                          steps_, ledger());
    water_sources::fill_sea(exec, view, s.water.sea, sea_level(), ledger());
  });

  // Water runs from high to low, and waves over it (C2).
  run(exec, "virtual_pipes",
      {Layer::water, Layer::water_flux_x, Layer::water_flux_y, Layer::suspended_sediment}, [&] {
        virtual_pipes::step(exec, view, s.water, dt, time(), sea_level(), ledger(), landed_.data(),
                            pipes_work_);
      });

  // It takes ground up, and lets it fall where it slows down (C3).
  if (s.hydraulic_erosion.enabled)
    run(exec, "hydraulic_erosion", {Layer::bedrock, Layer::soil, Layer::sand, Layer::suspended_sediment},
        [&] { hydraulic_erosion::step(exec, view, s.hydraulic_erosion, dt, ledger(), erosion_work_); });

  // It seeps into the ground, spreads there, and dries, as what stands on the ground does (C4).
  run(exec, "moisture", {Layer::water, Layer::moisture}, [&] {
    if (s.moisture.enabled)
      moisture::step(exec, view, s.moisture, s.repose.moisture_capacity, dt, ledger(), landed_.data());
    water_sources::evaporate(exec, view, s.water.evaporation, dt, ledger());
  });
}

/// Soil and bedrock slide only where something changes them: abrasion, water, or an edit, until all has come
/// to rest.
template <class E>
void Simulation::slide_ground(E& exec, const TerrainView& view) {
  const AvalanchingParameters& p = scenario_.avalanching;
  const bool wearing = wears_ground(scenario_);
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
  if (heights_stale_) surface::measure(exec, view, heights_);
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
  if (!terrain_.has(layer)) return;
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

bool Simulation::avalanches_end_the_step() const {
  return scenario_.avalanching.enabled && !scenario_.has_water() && !scenario_.soil.enabled;
}

bool Simulation::checks_layers() const {
  const int every = scenario_.run.check_every;
  return every > 0 && (steps_ + 1) % static_cast<std::uint64_t>(every) == 0;
}

bool Simulation::recordable() const {
  const Scenario& s = scenario_;
  const bool steady_reptation =
      s.reptation.method == ReptationMethod::off || s.reptation.method == ReptationMethod::adaptive_repose;
  const bool without_host = !s.avalanching.enabled || s.avalanching.quality != AvalancheQuality::converged ||
                            (s.avalanching.scheme == AvalancheScheme::multilevel && exec().records_repeats());
  return exec().records() && !timing_ && !checks_layers() && s.wind_features.empty() && steady_reptation &&
         without_host && !bedrock_loose_ && !soil_loose_;
}

Quanta Simulation::sea_level() const {
  const HeightScale& scale = terrain_.scale();
  const double quanta = (scenario_.water.sea_level - scale.datum) / scale.quantum();
  constexpr double limit = load_limit;
  return static_cast<Quanta>(std::lrint(std::clamp(quanta, -limit, limit)));
}

void Simulation::step() {
  follow_timeline();
  const auto work = [this] { with_backend(exec(), [this](auto& e) { run_processes(e); }); };
  if (recordable())
    recordings_.run(exec(), {wind_above(), steps_ % avalanching::turns, heights_stale_, terrain_.view()},
                    work);
  else
    work();
  heights_stale_ = !avalanches_end_the_step();
  if (scenario_.has_water()) with_backend(exec(), [this](auto& e) { run_water(e); });
  // Soil dries to sand, and becomes soil again (C5).
  if (scenario_.soil.enabled)
    with_backend(exec(), [this](auto& e) {
      run(e, "soil", {Layer::soil, Layer::sand}, [&] {
        soil::step(e, terrain_.view(), scenario_.soil, scenario_.repose, scenario_.run.time_step, ledger());
      });
    });
  // Plants drink, grow, suffer and die, and new ones come up (D).
  if (plants_)
    with_backend(exec(), [this](auto& e) {
      run(e, "vegetation", {Layer::moisture, Layer::humus}, [&] {
        plants::live(e, terrain_.view(), scenario_.vegetation, scenario_.repose, heights_,
                     scenario_.run.time_step, scenario_.seed, steps_, ledger(), plants_);
      });
    });
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
    if (plants_) {
      plants::cover(e, view, s.vegetation, 0.0f, heights_, false, plants_);
      plants::illuminate(e, view, s.vegetation, heights_, plants_);
    }
    if (s.wind_shadow.enabled) wind_shadow::step(e, view, s.wind_shadow, obstructing_heights(), shadow_work_);
    if (s.echo_dunes.enabled) echo_dunes::step(e, view, s.echo_dunes, heights_, repose_.data());
    reptation::set_angles(e, view, reptation::Angle(s.reptation, s.repose, repose_.data()), s.repose,
                          nullptr);
  });
  derived_ready_ = true;
}

}  // namespace desert_sim

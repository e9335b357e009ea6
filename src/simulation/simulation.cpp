#include "src/simulation/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "kernels/field/statistics.hpp"
#include "kernels/particles/particle_parameters.hpp"
#include "kernels/sand/desertscape.hpp"
#include "kernels/slabs/slab_parameters.hpp"
#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/detail_section.hpp"
#include "src/simulation/pipeline/memory.hpp"

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

Terrain build(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster) {
  require_reach(scenario);
  if (scenario.wind_regime.regime == WindRegimeKind::series && !scenario.wind_series)
    throw ConfigError(scenario.name + ": wind.series_file: has not been read");
  require_memory(exec, scenario, bytes_to_build(scenario));
  const HostLayers layers = build_terrain(scenario, load_raster);
  Terrain terrain(exec, scenario.make_grid(), scale_for(layers, scenario));
  for (const auto& [layer, values] : layers) terrain.set_values(layer, values);
  return terrain;
}

/// The fastest wind that the regime and the speed-up over hills can bring [m/s].
double fastest_wind(const Scenario& s) {
  double fastest = s.wind_regime.speed;
  for (const WindSegment& segment : s.wind_segments)
    fastest = std::max(fastest, static_cast<double>(segment.speed));
  if (s.wind_series) fastest = std::max(fastest, s.wind_series->fastest());
  return fastest * static_cast<double>(std::max(s.wind.speedup_highest, s.wind.response_highest));
}

/// Whether the process of this name is active, and no other takes its place.
bool takes_part(const std::string& name, const Scenario& s) {
  const ProcessTable& table = process_table();
  return std::any_of(table.processes.begin(), table.processes.end(),
                     [&](const Process& p) { return p.name == name && table.is_active(p, s); });
}

/// One model moves the sand: of two, one would be ignored, or both would move it.
void require_one_sand_model(const Scenario& s) {
  ValidationErrors errors(s.name);
  const auto& slabs = s.process_sections.get<SlabModelParameters>("slab_model");
  const auto& particles = s.process_sections.get<ParticleParameters>("particle");
  const std::string slab = slab_kind_names[static_cast<int>(slabs.kind)];
  const std::string particle = particle_kind_names[static_cast<int>(particles.kind)];
  const std::string model = saltation_model_names[static_cast<int>(s.saltation.model)];
  const bool has_slabs = slabs.kind != SlabKind::none, has_particles = particles.kind != ParticleKind::none;
  if (has_slabs && has_particles)
    errors.add("particle.kind", "= " + particle + " beside slab_model.kind = " + slab +
                                    " (allowed: one model that moves the sand; the other is none)");
  if ((has_slabs || has_particles) && s.saltation.enabled && s.saltation.model != SaltationModel::hops)
    errors.add("saltation.model",
               "= " + model + " beside " +
                   (has_slabs ? "slab_model.kind = " + slab : "particle.kind = " + particle) +
                   ", which moves the sand instead (allowed: hops, or kind: none)");
  errors.throw_if_any();
}

/// Sub-steps that follow from other parameters are bounded, so that a step cannot take for ever.
void require_bounded_cost(const Scenario& s) {
  ValidationErrors errors(s.name);
  const double step = s.run.time_step, cell = s.grid.cell_size;
  const auto check = [&](const char* key, double value, const char* unit, double substeps, int most) {
    if (substeps <= most) return;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "= %g %s needs %.0f sub-steps a step with cells of %g m and steps of %g s (allowed: at most %d, "
        "which %g %s needs)",
        value, unit, std::ceil(substeps), cell, step, most, value * most / substeps, unit);
    errors.add(key, text);
  };
  if (s.moisture.enabled)
    check("moisture.diffusion", s.moisture.diffusion, "m^2/s",
          4 * s.moisture.diffusion * step / (cell * cell), 64);
  if (s.reptation.method == ReptationMethod::smoothing &&
      takes_part("reptation", s))  // the shelter is at most 1
    check("reptation.strength", s.reptation.strength, "s/m^2",
          2 * (s.reptation.strength + s.reptation.smoothing_strength) * step / cell * fastest_wind(s), 256);
  const auto check_step = [&](const char* key, double interval) {
    constexpr int most = 256;
    if (step <= most * interval) return;
    char text[200];
    std::snprintf(text, sizeof text, "= %g s is %g times %s = %g s (allowed: at most %d times, %g s)", step,
                  step / interval, key, interval, most, most * interval);
    errors.add("run.time_step", text);
  };
  if (takes_part("saltation", s)) check_step("saltation.hop_time", s.saltation.hop_time);
  const auto& slabs = s.process_sections.get<SlabModelParameters>("slab_model");
  if (slabs.kind != SlabKind::none) check_step("slab_model.poll_time", slabs.poll_time);
  const std::string events = saltation_model_names[static_cast<int>(SaltationModel::desertscape_2019)];
  if (takes_part(events, s))
    check_step("desertscape_2019.slab / (4 saltation.lift)",
               desertscape::longest_step(s.process_sections.get<DesertscapeParameters>(events), s.saltation));
  const double shortest =
      s.wind_series ? s.wind_series->shortest_interval() : std::numeric_limits<double>::infinity();
  if (step > max_parts_of_step * shortest) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "= %g s is %g times the shortest time between rows of wind.series_file, %g s (allowed: at "
                  "most %d times, %g s)",
                  step, step / shortest, shortest, max_parts_of_step, max_parts_of_step * shortest);
    errors.add("run.time_step", text);
  }
  const double acceleration = s.run.acceleration, rate = acceleration / step;
  if (acceleration > 0 && (rate > max_accelerated_rate || acceleration < min_acceleration)) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "= %g needs %g steps of %g s per second (allowed: 0, or %g to %g, which is %g steps per second)",
        acceleration, rate, step, min_acceleration, max_accelerated_rate * step, max_accelerated_rate);
    errors.add("run.acceleration", text);
  }
  errors.throw_if_any();
}

}  // namespace

void require_reach(const Scenario& s) {
  require_one_sand_model(s);
  require_bounded_cost(s);
  ValidationErrors errors(s.name);
  const auto check = [&](const char* key, double metres) {
    const double cells = metres / s.grid.cell_size;
    if (cells > max_displacement)
      errors.add(key, "reaches across " + std::to_string(static_cast<long long>(cells)) + " cells of " +
                          std::to_string(s.grid.cell_size) +
                          " m (allowed: " + std::to_string(max_displacement) + ")");
  };
  check("wind_shadow.distance", s.wind_shadow.distance);
  check("echo_dunes.sticky_reach", static_cast<double>(s.echo_dunes.sticky_reach) * s.echo_dunes.highest);
  const double steepness = std::tan(s.echo_dunes.cliff_deg * pi / 180.0);
  if (s.echo_dunes.enabled)  // from the top of a cliff to its foot
    check("echo_dunes.highest", s.echo_dunes.highest / steepness);
  check("saltation.hop_time", fastest_wind(s) * s.saltation.hop_time);
  errors.throw_if_any();
}

void require_sea(const Scenario& s, const HeightScale& scale, const std::string& what) {
  const double highest = scale.datum + load_limit * scale.quantum();
  if (s.water.sea == Sea::none || s.water.sea_level <= highest) return;
  throw ConfigError(what + ": water.sea_level: = " + std::to_string(s.water.sea_level) +
                    " m is above the highest elevation that this terrain can represent (allowed: at most " +
                    std::to_string(highest) + " m)");
}

Simulation::Simulation(Exec& exec, const Scenario& scenario, const RasterLoader& load_raster,
                       const ProcessTable& table)
    : Simulation(scenario, build(exec, scenario, load_raster), table) {
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
  const wind::Vector wind = wind_above();
  pipeline_.step();
  state_.ripple_wind.advance(wind, time() - before, detail_parameters(scenario()));
}

std::vector<MemoryPart> Simulation::memory() const {
  std::vector<MemoryPart> parts;
  const std::size_t layer_bytes = static_cast<std::size_t>(terrain().grid().cells()) * sizeof(std::uint32_t);
  for (Layer layer : layers_in_use()) parts.push_back({info(layer).name, layer_bytes});
  for (MemoryPart& part : pipeline_.memory()) parts.push_back(std::move(part));
  if (state_.plants) parts.push_back({"plants", state_.plants.bytes()});
  parts.push_back({"ledger", state_.ledger_words.bytes()});
  for (MemoryPart& part : views_.memory()) parts.push_back(std::move(part));
  return parts;
}

Residual Simulation::residual() {
  pipeline_.refresh_derived();
  return with_backend(exec(), [this](auto& e) {
    return statistics::residual(e, terrain().view(), pipeline_.fields().repose.data());
  });
}

double Simulation::max_sand_slope_deg() const {
  const float tangent =
      with_backend(exec(), [this](auto& e) { return statistics::sand_slope(e, terrain().view()); });
  return std::atan(tangent) * 180 / pi;
}

double Simulation::mean_avalanche_iterations() const {
  return steps() ? static_cast<double>(pipeline_.avalanche_iterations()) / static_cast<double>(steps()) : 0.0;
}

}  // namespace desert_sim

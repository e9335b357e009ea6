/// Commands that a simulation carries out between steps.
#include <algorithm>

#include "src/core/error.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_checks.hpp"
#include "src/simulation/commands/plant_edit.hpp"
#include "src/simulation/commands/terrain_edit.hpp"
#include "src/simulation/pipeline/memory.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

void Simulation::set_regime(WindRegime regime) {
  regime.from = wind_above();
  regime.start_time = time();
  regime_ = std::move(regime);
}

Scenario Simulation::present_scenario() const {
  Scenario scenario = scenario_;
  scenario.wind_regime = regime_;
  scenario.wind_segments = regime_.segments;
  return scenario;
}

namespace {

/// What heights are counted in cannot change any more: a sea above them could not be counted. One below them
/// is no sea, whatever its level.
void require_sea(const Scenario& s, const HeightScale& scale) {
  const double highest = scale.datum + load_limit * scale.quantum();
  if (s.water.sea == Sea::none || s.water.sea_level <= highest) return;
  throw ConfigError("set_parameters: water.sea_level: = " + std::to_string(s.water.sea_level) +
                    " m is above what this terrain's heights can be (allowed: up to " +
                    std::to_string(highest) + " m)");
}

}  // namespace

CommandResult Simulation::apply(const command::SetParameters& command) {
  if (!(command.ramp >= 0 && command.ramp <= command.longest_ramp))
    throw ConfigError("set_parameters: ramp: = " + std::to_string(command.ramp) + " is not in [0, 1e+12] s");
  const Scenario present = present_scenario(), wanted = with_live_settings(present, command.settings);
  require_sea(wanted, terrain_.scale());
  require_more_memory(*this, wanted);  // also of what comes at the end of a ramp
  std::vector<std::string> settings = command.settings;
  const std::vector<Ramp> before = ramps_;
  begin_ramps(settings, command.ramp);
  try {
    set_parameters(settings);
  } catch (...) {
    ramps_ = before;
    throw;
  }
  return {};
}

void Simulation::set_parameters(const std::vector<std::string>& settings) {
  if (settings.empty()) return;
  const Scenario before = scenario_, present = present_scenario(),
                 changed = with_live_settings(present, settings);
  require_reach(changed);
  require_sea(changed, terrain_.scale());
  require_more_memory(*this, changed);
  exec().synchronise();  // memory that steps in flight work with is given back
  scenario_ = changed;
  try {
    prepare_processes();
  } catch (...) {
    scenario_ = before;
    prepare_processes();
    throw;
  }
  derived_ready_ = false;
  heights_stale_ = true;
  const auto regime = [](const Scenario& s) {
    YAML::Emitter out;
    yaml::keep_all_bits(out);
    out << YAML::BeginMap;
    yaml::emit_parameters(out, s.wind_regime);
    return std::string(out.c_str());
  };
  if (regime(changed) != regime(present)) set_regime({changed.wind_regime, changed.wind_segments});
}

CommandResult Simulation::apply(const command::SetWind& command) {
  check_ranges(command, "set_wind");
  WindRegime regime;
  regime.direction_deg = command.direction_deg;
  regime.speed = command.speed;
  regime.ramp = command.ramp;
  set_regime(regime);
  return {};
}

CommandResult Simulation::apply(const command::SetWindSchedule& command) {
  const WindRegime& r = command.regime;
  Faults faults("set_wind_schedule");
  if (r.regime == WindRegimeKind::constant) faults.add("kind", "must be timeline or rose");
  if (r.segments.empty()) faults.add("segments", "there must be at least one");
  if (!(r.hold_time >= 1e-3f && r.hold_time <= 1e12f))
    faults.add("hold_time", "= " + std::to_string(r.hold_time) + " is not in [0.001, 1e+12] s");
  double probability = 0;
  for (std::size_t n = 0; n < r.segments.size(); ++n) {
    check_ranges(r.segments[n], "set_wind_schedule: segment " + std::to_string(n));
    if (r.segments[n].ramp > r.segments[n].duration)
      faults.add("segment " + std::to_string(n) + ": ramp", "is longer than the segment's duration");
    probability += r.segments[n].probability;
  }
  if (r.regime == WindRegimeKind::rose && !(probability > 0))
    faults.add("segments", "the probabilities must not all be 0");
  faults.throw_if_any();
  set_regime(r);
  return {};
}

CommandResult Simulation::apply(const command::EditWind& command) {
  const int id = command.feature.id;
  std::vector<WindFeature>& features = scenario_.wind_features;
  if (command.operation == WindEdit::clear) {
    features.clear();
    upload_wind_features();
    return {};
  }
  if (id < 1) throw ConfigError("edit_wind: id: = " + std::to_string(id) + " must be 1 or more");
  const auto found =
      std::find_if(features.begin(), features.end(), [id](const WindFeature& f) { return f.id == id; });
  const bool known = found != features.end();
  if (known == (command.operation == WindEdit::add))
    throw ConfigError("edit_wind: id: = " + std::to_string(id) +
                      (known ? " is another feature's already" : " is no feature's"));
  if (command.operation == WindEdit::remove) {
    features.erase(found);
  } else {
    check_ranges(command.feature, "edit_wind");
    if (known)
      *found = command.feature;
    else if (features.size() < most_wind_features)
      features.push_back(command.feature);
    else
      throw ConfigError("edit_wind: there are " + std::to_string(most_wind_features) +
                        " features already, and no more are allowed");
  }
  upload_wind_features();
  return {};
}

CommandResult Simulation::apply(const command::EditTerrain& command, bool with_change) {
  heights_stale_ = true;
  TerrainEdit edit(command, terrain_, scenario_.grid, ledger());
  const bool bedrock = edit.material() == Material::bedrock, soil = edit.material() == Material::soil;
  if (bedrock || soil) prepare_ground_avalanches();
  const CommandResult result = edit.book(with_change);
  bedrock_loose_ = bedrock_loose_ || bedrock;
  soil_loose_ = soil_loose_ || soil || (bedrock && terrain_.has(Layer::soil));
  return result;
}

CommandResult Simulation::apply(const command::EditPlants& command) {
  check_plant_edit(command, scenario_);
  const int before = plants_.count;
  set_plants(edited_plants(command, scenario_, terrain_, steps_, plants_.capacity, plants::words(plants_)));
  // Who looks before the next step sees them.
  with_backend(exec(), [this](auto& e) {
    surface::measure(e, terrain_.view(), heights_);
    plants::cover(e, terrain_.view(), scenario_.vegetation, 0.0f, heights_, true, plants_);
  });
  derived_ready_ = false;
  CommandResult result;
  result.plants = plants_.count - before;
  return result;
}

}  // namespace desert_sim

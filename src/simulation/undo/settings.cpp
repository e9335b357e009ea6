#include "src/simulation/undo/settings.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"
#include "src/core/validation_errors.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/wind_feature_lists.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/pipeline/scenario_change.hpp"

namespace desert_sim {

namespace {

constexpr const char* wind_key = "wind";
constexpr const char* features_key = "wind.features.";
constexpr const char* scenario_wind_key = "#wind of the scenario";  // what the regime was made from
constexpr const char* order_key = "#order of wind.features";
constexpr const char* clock_key = "#clock";
constexpr const char* ramp_key = "#ramp of ";

bool begins_with(const std::string& text, const std::string& beginning) {
  return text.compare(0, beginning.size(), beginning) == 0;
}

/// One line of YAML that `emit` writes into a map.
template <class Emit>
std::string text_of(const Emit& emit) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << YAML::BeginMap;
  emit(out);
  out << YAML::EndMap;
  std::string text = out.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string text_of_wind(const WindRegime& regime) {
  return text_of([&](YAML::Emitter& out) { emit_regime(out, regime); });
}

/// `key` of each feature in turn. Those without an id (0), which only `clear` takes away, are counted.
std::vector<std::string> feature_keys(const std::vector<WindFeature>& features) {
  std::vector<std::string> keys;
  keys.reserve(features.size());
  int without_id = 0;
  for (const WindFeature& feature : features)
    keys.push_back(features_key +
                   (feature.id > 0 ? std::to_string(feature.id) : "0." + std::to_string(without_id++)));
  return keys;
}

void add_features(const SimulationState& state, SettingTexts& texts) {
  const std::vector<WindFeature>& features = state.scenario.wind_features;
  const std::vector<std::string> keys = feature_keys(features);
  std::string& order = texts[order_key];
  for (std::size_t n = 0; n < keys.size(); ++n) {
    texts[keys[n]] = text_of([&](YAML::Emitter& out) { emit_wind_features(out, {features[n]}); });
    order += keys[n] + " ";
  }
}

/// Only while no step is made can it be brought back; else clocks go on from what they show.
void add_clock(const SimulationState& state, SettingTexts& texts) {
  texts[clock_key] = text_of([&](YAML::Emitter& out) {
    out << YAML::Key << "steps" << YAML::Value << state.steps;
    out << YAML::Key << "origin" << YAML::Value << YAML::BeginMap;
    yaml::emit_parameters(out, state.clock_origin);
    out << YAML::EndMap;
  });
}

void add_parameters(const SimulationState& state, SettingTexts& texts) {
  Scenario plain = state.scenario;
  plain.wind_regime = {};
  plain.wind_segments.clear();
  plain.wind_features.clear();
  for (auto& [path, text] : parameter_texts(plain)) texts[path] = text;
  for (const Ramp& ramp : state.ramps)
    texts[ramp_key + ramp.path] = text_of([&](YAML::Emitter& out) { yaml::emit_parameters(out, ramp); });
}

}  // namespace

SettingTexts settings_of(const SimulationState& state, SettingScope scope) {
  SettingTexts texts;
  if (scope != SettingScope::features) texts[wind_key] = text_of_wind(state.wind_regime);
  if (scope != SettingScope::wind) add_features(state, texts);
  if (scope != SettingScope::all) return texts;
  add_parameters(state, texts);
  add_clock(state, texts);
  texts[scenario_wind_key] =
      text_of_wind(WindRegime{state.scenario.wind_regime, state.scenario.wind_segments, nullptr, 0, {}});
  return texts;
}

std::vector<std::string> describe_settings(const SettingChanges& changes) {
  std::vector<std::string> lines;
  for (const auto& [key, text] : changes)
    if (key[0] != '#') lines.push_back(key + (text ? "=" + *text : " removed"));
  return lines;
}

std::vector<ChangedSetting> changed_settings(const SettingTexts& before, const SettingTexts& after) {
  const auto text_in = [](const SettingTexts& texts, const std::string& key) {
    const auto at = texts.find(key);
    return at == texts.end() ? std::optional<std::string>() : at->second;
  };
  std::set<std::string> changed;
  for (const SettingTexts* texts : {&before, &after})
    for (const auto& entry : *texts) {
      const std::string& key = entry.first;
      if (text_in(before, key) == text_in(after, key)) continue;
      changed.insert(key);
      if (begins_with(key, ramp_key)) changed.insert(key.substr(std::string(ramp_key).size()));
    }
  std::vector<ChangedSetting> settings;
  settings.reserve(changed.size());
  for (const std::string& key : changed)
    settings.push_back({key, text_in(before, key), text_in(after, key), 0});
  return settings;
}

// ---- setting them

namespace {

/// What a text holds, which text_of() wrote.
template <class T, class Read>
T read(const std::string& text, const Read& read_into) {
  ValidationErrors errors("a setting of the history");
  T value{};
  read_into(YAML::Load(text), errors, value);
  errors.throw_if_any();
  return value;
}

WindFeature feature_of(const std::string& text) {
  return read<std::vector<WindFeature>>(text,
                                        [](const YAML::Node& node, ValidationErrors& errors, auto& list) {
                                          read_wind_features(node["features"], features_key, errors, list);
                                        })
      .at(0);
}

/// Those that stay keep their order, unless the changes have one for them.
void change_features(const SettingChanges& changes, std::vector<WindFeature>& features) {
  std::map<std::string, WindFeature> by_key;
  std::vector<std::string> order = feature_keys(features);
  for (std::size_t n = 0; n < order.size(); ++n) by_key[order[n]] = features[n];
  for (const auto& [key, text] : changes) {
    if (!begins_with(key, features_key)) continue;
    by_key.erase(key);
    if (text) by_key[key] = feature_of(*text);
    if (std::count(order.begin(), order.end(), key) == 0) order.push_back(key);
  }
  if (const auto at = changes.find(order_key); at != changes.end() && at->second) {
    std::vector<std::string> wanted;
    for (std::size_t begin = 0, end; (end = at->second->find(' ', begin)) != std::string::npos;
         begin = end + 1)
      wanted.push_back(at->second->substr(begin, end - begin));
    for (const std::string& key : order)
      if (std::count(wanted.begin(), wanted.end(), key) == 0) wanted.push_back(key);
    order = wanted;
  }
  features.clear();
  for (const std::string& key : order)
    if (const auto at = by_key.find(key); at != by_key.end()) features.push_back(at->second);
}

void change_ramp(const std::string& path, const std::optional<std::string>& text, std::vector<Ramp>& ramps) {
  ramps.erase(std::remove_if(ramps.begin(), ramps.end(), [&](const Ramp& ramp) { return ramp.path == path; }),
              ramps.end());
  if (!text) return;
  ramps.push_back(read<Ramp>(*text, [](const YAML::Node& node, ValidationErrors& errors, Ramp& ramp) {
    yaml::read_section(node, "ramp", errors, ramp);
  }));
  sort_by_path(ramps);
}

/// Plants refer to their species by its place.
void require_plants_kept(const SimulationState& state, const Scenario& wanted,
                         const std::vector<int>& leaving, const std::string& what) {
  if (state.plants.count == 0) return;
  const std::vector<PlantCount> counts = state.plant_counts();
  for (std::size_t n = 0; n < counts.size(); ++n) {
    const int staying = counts[n].plants - (n < leaving.size() ? leaving[n] : 0);
    if (staying == 0) continue;
    const std::string plants =
        std::to_string(staying) + " plants of " + in_quotes(counts[n].species) + " live";
    if (!wanted.get<VegetationParameters>().enabled)
      throw ConfigError(what + ": vegetation.enabled: " + plants +
                        " (allowed: none; edit_plants can clear them)");
    if (n >= wanted.species.size() || wanted.species[n].name != counts[n].species)
      throw ConfigError(what + ": species." + std::to_string(n) + ": " + plants +
                        ", which would have no species (allowed: none; edit_plants can clear them)");
  }
}

}  // namespace

SettingsReturn::SettingsReturn(SimulationState& state, Pipeline& pipeline, const SettingChanges& changes,
                               const ScenarioCheck& check, const std::vector<int>& leaving,
                               const std::string& what)
    : state_(state),
      pipeline_(pipeline),
      before_{state.scenario, state.wind_regime, state.ramps, state.clock_origin, state.held_layers_known},
      wanted_(before_) {
  SettingChanges parameters;
  for (const auto& [key, text] : changes) {
    if (key == wind_key) {
      wanted_.wind = read_regime(YAML::Load(*text), wind_key);
      wanted_.wind.series = state.scenario.wind_series;
    } else if (key == scenario_wind_key) {
      const WindRegime regime = read_regime(YAML::Load(*text), scenario_wind_key);
      wanted_.scenario.wind_regime = regime;
      wanted_.scenario.wind_segments = regime.segments;
    } else if (begins_with(key, ramp_key)) {
      change_ramp(key.substr(std::string(ramp_key).size()), text, wanted_.ramps);
    } else if (key == clock_key) {
      const YAML::Node node = YAML::Load(*text);
      if (node["steps"].as<std::uint64_t>() != state.steps) continue;
      clock_ =
          read<ClockOrigin>(*text, [](const YAML::Node& whole, ValidationErrors& errors, ClockOrigin& at) {
            yaml::read_section(whole["origin"], "clock", errors, at);
          });
    } else if (key[0] != '#' && !begins_with(key, features_key)) {
      parameters[key] = text;
    }
  }
  change_features(changes, wanted_.scenario.wind_features);
  if (!parameters.empty()) wanted_.scenario = with_parameter_texts(wanted_.scenario, parameters, what);
  const auto is_regime = [](const auto& change) { return change.first == wind_key; };
  other_scenario_ = !std::all_of(changes.begin(), changes.end(), is_regime);
  if (other_scenario_) {
    require_plants_kept(state, wanted_.scenario, leaving, what);
    check(wanted_.scenario, what);
  }
}

void SettingsReturn::set() {
  set(wanted_);
  if (clock_) state_.clock_origin = *clock_;
}

void SettingsReturn::set(const Present& wanted) {
  if (other_scenario_) take_scenario(state_, pipeline_, wanted.scenario);
  state_.wind_regime = wanted.wind;
  state_.ramps = wanted.ramps;
}

void SettingsReturn::roll_back() {
  set(before_);
  state_.clock_origin = before_.clock;
  state_.held_layers_known = before_.held_layers_known;
}

}  // namespace desert_sim

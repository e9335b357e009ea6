#include "src/simulation/checkpoint_header.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "src/core/quoted.hpp"
#include "src/scenario/former_keys.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"

namespace desert_sim {

// ---- writing

namespace {

template <class T>
void entry(YAML::Emitter& out, const char* key, const T& value) {
  out << YAML::Key << key << YAML::Value << value;
}

void emit_ramps(YAML::Emitter& out, const std::vector<Ramp>& ramps) {
  out << YAML::Key << "ramps" << YAML::Value << YAML::BeginSeq;
  for (const Ramp& ramp : ramps) {
    out << YAML::Flow << YAML::BeginMap;
    yaml::emit_parameters(out, ramp);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

template <class Numbers>
void emit_quanta(YAML::Emitter& out, const char* key, const Numbers& numbers) {
  out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (long long quanta : numbers) out << quanta;
  out << YAML::EndSeq;
}

}  // namespace

CheckpointHeader header_of(const Simulation& simulation) {
  const SimulationState& s = simulation.state();
  CheckpointHeader header;
  header.start = s.start;
  header.scenario = s.scenario;
  header.numbers = {s.steps, s.terrain.scale().datum, s.terrain.scale().exponent, s.wind_reference,
                    static_cast<std::uint64_t>(s.plants.count)};
  header.timeline_time = s.timeline_time;
  header.flags = s.flags;
  for (const Process& process : process_table().processes)
    if (!process.counter.empty())
      header.counts[process.counter] = simulation.pipeline().count(process.counter);
  header.clock = s.clock_origin;
  header.ramps = s.ramps;
  header.initial = s.initial;
  header.ledger = s.read_ledger();
  header.wind = s.wind_regime;
  header.ripple_wind = s.ripple_wind;
  for (const LayerInfo& row : layer_table)
    if (s.is_part(row.layer)) header.layers.push_back(row.layer);
  return header;
}

std::string header_text(const CheckpointHeader& header) {
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  entry(out, "name", header.scenario.name);
  entry(out, "folder", header.scenario.folder);
  entry(out, "projection", header.scenario.projection);
  entry(out, "start", dump_scenario(header.start));
  entry(out, "scenario", dump_scenario(header.scenario));
  yaml::emit_parameters(out, header.numbers);
  entry(out, "timeline_time", header.timeline_time);
  for (const Process& process : process_table().processes) {
    for (const std::string& flag : process.flags) entry(out, flag.c_str(), header.flags.count(flag) > 0);
    if (const std::string& counter = process.counter; !counter.empty())
      entry(out, counter.c_str(), header.counts.at(counter));
  }
  if (!(header.clock == ClockOrigin())) {
    out << YAML::Key << "clock" << YAML::Value << YAML::BeginMap;
    yaml::emit_parameters(out, header.clock);
    out << YAML::EndMap;
  }
  emit_ramps(out, header.ramps);
  emit_quanta(out, "initial", header.initial);
  emit_quanta(out, "ledger", header.ledger);
  out << YAML::Key << "wind" << YAML::Value << YAML::BeginMap;
  emit_regime(out, header.wind);
  out << YAML::EndMap;
  if (header.ripple_wind) {
    out << YAML::Key << "ripple_wind" << YAML::Value << YAML::BeginMap;
    yaml::emit_parameters(out, *header.ripple_wind);
    out << YAML::EndMap;
  }
  if (header.scenario.wind_series) entry(out, "wind_series", header.scenario.wind_series->text());
  out << YAML::Key << "layers" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (Layer layer : header.layers) out << info(layer).name;
  out << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

// ---- reading

namespace {

std::string text_at(const YAML::Node& header, const char* key, const std::string& path) {
  if (!header[key].IsScalar())
    throw ConfigError(path + ": " + key + ": " + yaml::node_text(header[key]) + " is not text");
  return header[key].Scalar();
}

/// A scenario whose grid is resolved, as that of a simulation is.
Scenario read_scenario(const YAML::Node& header, const char* key, const std::string& path) {
  const std::string source = path + ": " + key;
  const YAML::Node root = without_former_keys(YAML::Load(text_at(header, key, path)), source);
  Scenario scenario = parse_scenario(root, source, text_at(header, "folder", path));
  scenario.name = text_at(header, "name", path);
  scenario.projection = text_at(header, "projection", path);
  const GridParameters& grid = scenario.grid;
  if (grid.width < 1 || grid.height < 1 || !(grid.cell_size > 0))
    throw ConfigError(source + ": grid: width, height and cell_size must be given");
  return scenario;
}

/// A list of as many whole numbers as `numbers` has, none further from 0 than `limit`.
template <class Numbers>
void read_quanta(const YAML::Node& header, const char* key, long long limit, ValidationErrors& errors,
                 Numbers& numbers) {
  const YAML::Node list = header[key];
  if (!list.IsSequence() || list.size() != numbers.size())
    return errors.add(key, "must be a list of " + std::to_string(numbers.size()) + " whole numbers");
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const std::string item = std::string(key) + "." + std::to_string(n);
    long long value = 0;
    if (!list[n].IsScalar() || !YAML::convert<long long>::decode(list[n], value))
      errors.add(item, yaml::node_text(list[n]) + " is not a whole number");
    else if (value < -limit || value > limit)
      errors.add(item, std::to_string(value) + " is not in [" + std::to_string(-limit) + ", " +
                           std::to_string(limit) + "] quanta");
    else
      numbers[n] = value;
  }
}

/// What processes keep. Adds the names to `known`.
void read_what_processes_keep(const YAML::Node& node, ValidationErrors& errors, CheckpointHeader& header,
                              std::set<std::string>& known) {
  for (const Process& process : process_table().processes) {
    for (const std::string& flag : process.flags) {
      known.insert(flag);
      bool on = false;
      if (node[flag] && !YAML::convert<bool>::decode(node[flag], on))
        errors.add(flag, yaml::node_text(node[flag]) + " is not true or false");
      if (on) header.flags.insert(flag);
    }
    if (const std::string& counter = process.counter; !counter.empty()) {
      known.insert(counter);
      if (node[counter] && !YAML::convert<std::uint64_t>::decode(node[counter], header.counts[counter]))
        errors.add(counter, yaml::node_text(node[counter]) + " is not a whole number");
    }
  }
}

/// Checkpoints have it if run.time_step or run.acceleration has changed.
void read_clock(const YAML::Node& node, ValidationErrors& errors, CheckpointHeader& header) {
  ClockOrigin clock;
  yaml::read_section(node, "clock", errors, clock);
  if (clock.step > header.numbers.steps) {
    errors.add("clock.step",
               std::to_string(clock.step) + " is not in [0, " + std::to_string(header.numbers.steps) + "]");
    return;
  }
  header.clock = clock;
  if (!(clock.accelerated_at <= header.time()))
    errors.add("clock.accelerated_at", std::to_string(clock.accelerated_at) +
                                           " s is later than the present time, " +
                                           std::to_string(header.time()) + " s");
}

/// Checkpoints of former versions have the number of entries that are done in its place: of those at one
/// time, all or none are.
void read_timeline_time(const YAML::Node& node, ValidationErrors& errors, CheckpointHeader& header) {
  const std::vector<TimelineEntry>& timeline = header.scenario.timeline;
  const std::string former = "next_timeline_entry";
  if (node["timeline_time"]) {
    double& time = header.timeline_time;
    if (!yaml::decode_number(node["timeline_time"], "s", time) || !(time >= -1 && time <= header.time()))
      errors.add("timeline_time", yaml::node_text(node["timeline_time"]) + " is not in [-1, " +
                                      std::to_string(header.time()) + "] s");
  } else if (std::size_t done = 0; !node[former]) {
    errors.add("timeline_time", "is missing");
  } else if (!YAML::convert<std::size_t>::decode(node[former], done) || done > timeline.size()) {
    errors.add(former,
               yaml::node_text(node[former]) + " is not in [0, " + std::to_string(timeline.size()) + "]");
  } else if (done > 0) {
    header.timeline_time = timeline[done - 1].time;
  }
}

void read_ramps(const YAML::Node& list, ValidationErrors& errors, CheckpointHeader& header) {
  if (!list.IsSequence()) return errors.add("ramps", yaml::node_text(list) + " is not a list");
  const double time = header.time();
  for (std::size_t n = 0; n < list.size(); ++n) {
    const std::string key = "ramps." + std::to_string(n);
    Ramp ramp;
    yaml::read_section(list[n], key, errors, ramp);
    check_ramp(header.scenario, ramp, time, key, errors);
    header.ramps.push_back(ramp);
  }
}

WindRegime read_wind(const CheckpointHeader& header, const YAML::Node& node, const std::string& path) {
  const WindRegime wind = read_regime(node, path + ": wind");
  ValidationErrors errors(path + ": wind");
  const double time = header.time();
  if (!(wind.start_time >= -1e30 && wind.start_time <= time))
    errors.add("start_time",
               std::to_string(wind.start_time) + " is not in [-1e+30, " + std::to_string(time) + "] s");
  constexpr float fastest = 101;  // a speed of 100 m/s, with what rounding may add
  for (const float v : {wind.initial_wind.x, wind.initial_wind.y})
    if (!(std::abs(v) <= fastest)) errors.add("from", std::to_string(v) + " is not in [-101, 101] m/s");
  errors.throw_if_any();
  return wind;
}

/// Checkpoints have it if their scenario names a file with it.
void read_series(const YAML::Node& node, const std::string& path, CheckpointHeader& header) {
  const std::string& file = header.scenario.wind_regime.series_file;
  const bool needed = header.wind.regime == WindRegimeKind::series ||
                      header.scenario.wind_regime.regime == WindRegimeKind::series ||
                      header.start.wind_regime.regime == WindRegimeKind::series;
  if (!node["wind_series"]) {
    if (needed)
      throw ConfigError(path + ": wind_series: is missing, which has the rows of " + in_quotes(file));
    return;
  }
  header.wind.series = header.scenario.wind_series = header.start.wind_series =
      std::make_shared<const WindSeries>(
          WindSeries::from_text(text_at(node, "wind_series", path), path + ": wind_series"));
}

bool is_written(Layer layer, const Scenario& scenario) {
  const std::vector<Process>& all = process_table().processes;
  return std::any_of(all.begin(), all.end(), [&](const Process& process) {
    return std::count(process.writes.begin(), process.writes.end(), layer) > 0 &&
           process_table().is_active(process, scenario);
  });
}

/// Layers that a simulation of the scenario has from its start.
std::vector<Layer> needed_layers(const Scenario& scenario) {
  std::vector<Layer> needed{Layer::bedrock, Layer::sand, Layer::airborne_sand};
  for (const Process& process : process_table().processes)
    if (process_table().is_active(process, scenario))
      for (Layer layer : process.writes)
        if (info(layer).lifetime == Lifetime::persistent) needed.push_back(layer);
  return needed;
}

void read_layers(const YAML::Node& list, ValidationErrors& errors, CheckpointHeader& header) {
  if (!list.IsSequence()) return errors.add("layers", yaml::node_text(list) + " is not a list");
  std::size_t next = 0;  // layers follow each other as in the table
  for (std::size_t n = 0; n < list.size(); ++n) {
    const std::string name = list[n].IsScalar() ? list[n].Scalar() : yaml::node_text(list[n]);
    const auto row = std::find_if(layer_table.begin(), layer_table.end(),
                                  [&](const LayerInfo& layer) { return name == layer.name; });
    const std::string key = "layers." + std::to_string(n);
    const auto is_held = [&] {
      return row->lifetime == Lifetime::held &&
             header.scenario.run.time_step < header.scenario.run.hold_time &&
             is_written(row->layer, header.scenario);
    };
    if (row == layer_table.end() || (row->lifetime != Lifetime::persistent && !is_held()))
      return errors.add(key, in_quotes(name) + " is not a layer that checkpoints hold");
    const auto place = static_cast<std::size_t>(row - layer_table.begin());
    if (place < next)
      return errors.add(key, in_quotes(name) + " is given twice, or not in the order of layers");
    next = place + 1;
    header.layers.push_back(row->layer);
  }
  for (Layer layer : needed_layers(header.scenario))
    if (std::count(header.layers.begin(), header.layers.end(), layer) == 0)
      errors.add("layers", std::string(info(layer).name) + " is missing, which this scenario needs");
}

/// What no single number tells.
void check_together(const CheckpointHeader& header, ValidationErrors& errors) {
  const GridParameters &now = header.scenario.grid, &start = header.start.grid;
  if (now.width != start.width || now.height != start.height || now.cell_size != start.cell_size ||
      now.boundary != start.boundary)
    errors.add("start", "its grid is not that of scenario");
  const VegetationParameters& vegetation = header.scenario.get<VegetationParameters>();
  const auto room = static_cast<std::uint64_t>(!vegetation.enabled ? 0
                                               : vegetation.max_plants > 0
                                                   ? vegetation.max_plants
                                                   : static_cast<long long>(now.width) * now.height);
  if (header.numbers.plants > room)
    errors.add("plants",
               std::to_string(header.numbers.plants) + " is not in [0, " + std::to_string(room) + "]");
}

CheckpointHeader read_header(const YAML::Node& node, const std::string& path) {
  ValidationErrors errors(path);
  CheckpointHeader header;
  std::set<std::string> known{"name",  "folder",  "projection", "start", "scenario",
                              "ramps", "initial", "ledger",     "wind",  "layers"};
  yaml::read_parameters(node, "", errors, header.numbers, known);
  if (node.IsMap()) read_what_processes_keep(node, errors, header, known);
  std::set<std::string> allowed = known;
  allowed.insert({"clock", "ripple_wind", "wind_series", "timeline_time", "next_timeline_entry"});
  yaml::reject_unknown_keys(node, "", allowed, errors);
  if (node.IsMap())
    for (const std::string& key : known)
      if (!node[key]) errors.add(key, "is missing");
  errors.throw_if_any();
  header.start = read_scenario(node, "start", path);
  header.scenario = read_scenario(node, "scenario", path);
  check_together(header, errors);
  if (node["clock"]) read_clock(node["clock"], errors, header);
  read_timeline_time(node, errors, header);
  if (node["ripple_wind"])
    yaml::read_section(node["ripple_wind"], "ripple_wind", errors, header.ripple_wind.emplace());
  read_ramps(node["ramps"], errors, header);
  // No sum of all that is booked overflows.
  read_quanta(node, "initial", 1LL << 61, errors, header.initial);
  header.ledger.resize(material_count * 2);
  read_quanta(node, "ledger", 1LL << 60, errors, header.ledger);
  read_layers(node["layers"], errors, header);
  errors.throw_if_any();
  header.wind = read_wind(header, node["wind"], path);
  read_series(node, path, header);
  process_table().require_runnable(header.scenario);
  if (has_water(header.scenario)) require_sea(header.scenario, header.scale(), path + ": scenario");
  return header;
}

}  // namespace

CheckpointHeader read_header(const std::string& text, const std::string& path) {
  try {
    return read_header(YAML::Load(text), path);
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": its header cannot be read: " + e.msg);
  }
}

}  // namespace desert_sim

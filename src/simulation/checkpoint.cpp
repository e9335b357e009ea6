#include "src/simulation/checkpoint.hpp"

#include <xxhash.h>
#include <yaml-cpp/yaml.h>

#include <cstring>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/input_file.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/pipeline/memory.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

namespace {

const std::string magic = "desert_sim checkpoint\n";
constexpr std::uint32_t version = 3;

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T read_value(const std::string& from, std::size_t& at, const std::string& path) {
  T value;
  if (from.size() - at < sizeof value) throw ConfigError(path + ": is truncated");
  std::memcpy(&value, from.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

/// The bytes of a checkpoint. What is no checkpoint, or does not fit, is refused before it is read.
std::string read_checked(const std::string& path, const std::string& folder) {
  const InputFile file(path, folder);
  std::string start(magic.size(), '\0');
  if (file.read(0, start.data(), start.size()) < start.size() || start != magic)
    throw ConfigError(path + ": is not a checkpoint");
  if (file.size() > host_memory_available())
    throw ConfigError(path + ": has " + std::to_string(file.size()) +
                      " bytes; memory that is available: " + std::to_string(host_memory_available()));
  std::string bytes = file.read_all();
  std::size_t at = magic.size();
  const auto found = read_value<std::uint32_t>(bytes, at, path);
  if (found != version)
    throw ConfigError(path + ": is a checkpoint of version " + std::to_string(found) +
                      "; this program reads version " + std::to_string(version));
  if (bytes.size() < at + sizeof(std::uint64_t) * 2) throw ConfigError(path + ": is truncated");
  std::size_t end = bytes.size() - sizeof(std::uint64_t);
  const std::size_t body = end;
  if (read_value<std::uint64_t>(bytes, end, path) != XXH3_64bits(bytes.data(), body))
    throw ConfigError(path + ": is truncated or corrupt (its checksum does not match)");
  return bytes;
}

}  // namespace

namespace {

std::vector<Layer> saved_layers(const Terrain& terrain) {
  std::vector<Layer> layers;
  for (const LayerInfo& row : layer_table)
    if (row.lifetime == Lifetime::persistent && terrain.has(row.layer)) layers.push_back(row.layer);
  return layers;
}

template <class T>
void entry(YAML::Emitter& out, const char* key, const T& value) {
  out << YAML::Key << key << YAML::Value << value;
}

void emit_ramps(YAML::Emitter& out, const std::vector<Ramp>& ramps) {
  out << YAML::Key << "ramps" << YAML::Value << YAML::BeginSeq;
  for (const Ramp& r : ramps) {
    out << YAML::Flow << YAML::BeginMap;
    entry(out, "path", r.path);
    entry(out, "from", r.from);
    entry(out, "to", r.to);
    entry(out, "start", r.start);
    entry(out, "duration", r.duration);
    entry(out, "stair", r.step_index);
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

std::string header_of(const Simulation& simulation) {
  const SimulationState& s = simulation.state();
  YAML::Emitter out;
  yaml::set_full_precision(out);
  out << YAML::BeginMap;
  entry(out, "name", s.scenario.name);
  entry(out, "folder", s.scenario.folder);
  entry(out, "projection", s.scenario.projection);
  entry(out, "start", dump_scenario(s.start));
  entry(out, "scenario", dump_scenario(s.scenario));
  entry(out, "steps", s.steps);
  entry(out, "datum", s.terrain.scale().datum);
  entry(out, "exponent", s.terrain.scale().exponent);
  entry(out, "wind_reference", s.wind_reference);
  entry(out, "bedrock_loose", s.bedrock_loose);
  entry(out, "soil_loose", s.soil_loose);
  entry(out, "avalanche_iterations", simulation.pipeline().avalanche_iterations());
  entry(out, "plants", s.plants.count);
  entry(out, "next_timeline_entry", s.next_timeline_entry);
  emit_ramps(out, s.ramps);
  emit_quanta(out, "initial", s.initial);
  emit_quanta(out, "ledger", s.read_ledger());
  out << YAML::Key << "wind" << YAML::Value << YAML::BeginMap;
  emit_regime(out, s.wind_regime);
  out << YAML::EndMap << YAML::Key << "layers" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (Layer layer : saved_layers(s.terrain)) out << info(layer).name;
  out << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

Scenario read_scenario(const YAML::Node& header, const char* key, const std::string& path) {
  Scenario scenario =
      parse_scenario(YAML::Load(header[key].as<std::string>()), path, header["folder"].as<std::string>());
  scenario.name = header["name"].as<std::string>();
  scenario.projection = header["projection"].as<std::string>();
  return scenario;
}

/// A simulation with all of its state but the layers and plants.
std::unique_ptr<Simulation> simulation_of(const YAML::Node& header, Exec& exec, const std::string& path) {
  const Scenario scenario = read_scenario(header, "scenario", path);
  HeightScale scale;
  scale.datum = header["datum"].as<double>();
  scale.exponent = header["exponent"].as<int>();
  require_memory(exec, scenario, sizeof(std::uint32_t));
  auto simulation = std::make_unique<Simulation>(scenario, Terrain(exec, scenario.make_grid(), scale));
  SimulationState& s = simulation->state();
  s.start = read_scenario(header, "start", path);
  s.steps = header["steps"].as<std::uint64_t>();
  s.wind_reference = header["wind_reference"].as<Quanta>();
  s.bedrock_loose = header["bedrock_loose"].as<bool>();
  s.soil_loose = header["soil_loose"].as<bool>();
  s.avalanche_iterations = header["avalanche_iterations"].as<std::uint64_t>();
  s.next_timeline_entry = header["next_timeline_entry"].as<std::size_t>();
  for (const YAML::Node& node : header["ramps"]) {
    Ramp r;
    r.path = node["path"].as<std::string>();
    r.from = node["from"].as<double>();
    r.to = node["to"].as<double>();
    r.start = node["start"].as<double>();
    r.duration = node["duration"].as<double>();
    r.step_index = node["stair"].as<int>();
    s.ramps.push_back(r);
  }
  for (std::size_t m = 0; m < s.initial.size(); ++m) s.initial[m] = header["initial"][m].as<long long>();
  std::vector<long long> accounts;
  for (std::size_t account = 0; account < material_count * 2; ++account)
    accounts.push_back(header["ledger"][account].as<long long>());
  s.write_ledger(accounts);
  s.wind_regime = read_regime(header["wind"], path + ": wind");
  simulation->pipeline().adapt();  // ground that is loose needs memory
  return simulation;
}

}  // namespace

std::string checkpoint_bytes(const Simulation& simulation) {
  const SimulationState& state = simulation.state();
  const std::string header = header_of(simulation);
  const std::vector<Layer> layers = saved_layers(state.terrain);
  const std::vector<std::uint32_t> plants = plants::words(state.plants);
  const std::size_t layer_bytes =
      static_cast<std::size_t>(state.terrain.grid().cells()) * sizeof(std::uint32_t);
  std::string bytes;
  // Growing could take three times as much memory.
  bytes.reserve(header.size() + 256 + layers.size() * layer_bytes + plants.size() * sizeof(std::uint32_t));
  bytes = magic;
  append(bytes, version);
  append(bytes, static_cast<std::uint64_t>(header.size()));
  bytes += header;
  const auto append_words = [&bytes](const std::vector<std::uint32_t>& words) {
    bytes.append(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t));
  };
  for (Layer layer : layers) append_words(state.terrain.raw_words(layer));
  append_words(plants);
  append(bytes, static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  return bytes;
}

void save_checkpoint(const std::string& path, const Simulation& simulation) {
  write_file(path, checkpoint_bytes(simulation));
}

std::unique_ptr<Simulation> load_checkpoint(const std::string& path, Exec& exec, const std::string& folder) {
  const std::string bytes = read_checked(path, folder);
  std::size_t at = magic.size() + sizeof version;
  const auto length = read_value<std::uint64_t>(bytes, at, path);
  if (length > bytes.size() - at) throw ConfigError(path + ": is truncated");
  try {
    const YAML::Node header = YAML::Load(bytes.substr(at, length));
    at += length;
    std::unique_ptr<Simulation> simulation = simulation_of(header, exec, path);
    SimulationState& state = simulation->state();
    const std::size_t cells = static_cast<std::size_t>(state.terrain.grid().cells());
    const auto next_words = [&](std::size_t count) {
      std::vector<std::uint32_t> words(count);
      if ((bytes.size() - at) / sizeof(std::uint32_t) < count) throw ConfigError(path + ": is truncated");
      if (count > 0) std::memcpy(words.data(), bytes.data() + at, count * sizeof(std::uint32_t));
      at += count * sizeof(std::uint32_t);
      return words;
    };
    for (const YAML::Node& name : header["layers"])
      state.terrain.set_raw_words(layer_by_name(name.as<std::string>()), next_words(cells));
    const std::vector<std::uint32_t> plants =
        next_words(header["plants"].as<std::size_t>() * plants::column_count);
    if (state.plants) state.set_plants(plants);
    return simulation;
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": its header cannot be read: " + e.msg);
  }
}

}  // namespace desert_sim

#include "src/simulation/checkpoint.hpp"

#include <xxhash.h>

#include <cstring>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/host_memory.hpp"
#include "src/core/input_file.hpp"
#include "src/simulation/checkpoint_header.hpp"
#include "src/simulation/checkpoint_words.hpp"
#include "src/simulation/memory/memory.hpp"

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

/// The bytes of a file that begins as a checkpoint does. What does not, or does not fit, is refused before it
/// is read.
std::string read_checkpoint(const std::string& path, const std::string& folder) {
  const InputFile file(path, folder);
  std::string start(magic.size(), '\0');
  if (file.read(0, start.data(), start.size()) < start.size() || start != magic)
    throw ConfigError(path + ": is not a checkpoint");
  if (file.size() > host_memory_available())
    throw ConfigError(path + ": has " + std::to_string(file.size()) +
                      " bytes; memory that is available: " + std::to_string(host_memory_available()));
  return file.read_all();
}

/// Throws ConfigError unless the bytes are those of a whole checkpoint, as far as its checksum tells.
void check_bytes(const std::string& bytes, const std::string& path) {
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
}

/// A simulation with all of the header's state.
std::unique_ptr<Simulation> simulation_of(const CheckpointHeader& header, Exec& exec) {
  require_memory(exec, header.scenario, sizeof(std::uint32_t));
  auto simulation = std::make_unique<Simulation>(header.scenario,
                                                 Terrain(exec, header.scenario.make_grid(), header.scale()));
  SimulationState& s = simulation->state();
  s.start = header.start;
  s.steps = header.numbers.steps;
  s.clock_origin = header.clock;
  s.wind_reference = header.numbers.wind_reference;
  s.flags = header.flags;
  s.counts = header.counts;
  s.timeline_time = header.timeline_time;
  s.ramps = header.ramps;
  s.initial = header.initial;
  s.write_ledger(header.ledger);
  s.wind_regime = header.wind;
  s.ripple_wind = header.ripple_wind.value_or(RippleWind::settled(s.wind_above()));
  simulation->pipeline().adapt();  // ground that is loose needs memory
  return simulation;
}

/// Throws ConfigError unless what was there, came and went accounts for what is there of each material.
void require_balance(const SimulationState& state, const std::string& path) {
  const std::array<MaterialBalance, material_count> balance = state.balance();
  for (std::size_t m = 0; m < balance.size(); ++m)
    if (balance[m].residual() != 0)
      throw ConfigError(path + ": its accounts of " + material_names[m] + " are not those of its layers: " +
                        std::to_string(balance[m].final) + " quanta are there, and by initial and ledger " +
                        std::to_string(balance[m].final - balance[m].residual()) + " should be");
}

}  // namespace

std::string checkpoint_bytes(const Simulation& simulation) {
  const SimulationState& state = simulation.state();
  const CheckpointHeader header = header_of(simulation);
  const std::string text = header_text(header);
  const std::vector<std::uint32_t> plants = plants::words(state.plants);
  const std::size_t layer_bytes =
      static_cast<std::size_t>(state.terrain.grid().cells()) * sizeof(std::uint32_t);
  std::string bytes;
  // Growing could take three times as much memory.
  bytes.reserve(text.size() + 256 + header.layers.size() * layer_bytes +
                plants.size() * sizeof(std::uint32_t));
  bytes = magic;
  append(bytes, version);
  append(bytes, static_cast<std::uint64_t>(text.size()));
  bytes += text;
  const auto append_words = [&bytes](const std::vector<std::uint32_t>& words) {
    bytes.append(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t));
  };
  for (Layer layer : header.layers) append_words(state.terrain.raw_words(layer));
  append_words(plants);
  append(bytes, static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  return bytes;
}

void save_checkpoint(const std::string& path, const Simulation& simulation) {
  write_file(path, checkpoint_bytes(simulation));
}

std::unique_ptr<Simulation> load_checkpoint(const std::string& path, Exec& exec, const std::string& folder) {
  return simulation_from_bytes(read_checkpoint(path, folder), exec, path);
}

std::unique_ptr<Simulation> simulation_from_bytes(const std::string& bytes, Exec& exec,
                                                  const std::string& path) {
  check_bytes(bytes, path);
  std::size_t at = magic.size() + sizeof version;
  const auto length = read_value<std::uint64_t>(bytes, at, path);
  const std::size_t end = bytes.size() - sizeof(std::uint64_t);
  if (length > end - at) throw ConfigError(path + ": is truncated");
  const CheckpointHeader header = read_header(bytes.substr(at, length), path);
  at += length;
  const CheckpointWords words = divide_words(header, bytes.data() + at, end - at, path);
  check_words(header, words, path);
  std::unique_ptr<Simulation> simulation = simulation_of(header, exec);
  SimulationState& state = simulation->state();
  for (std::size_t n = 0; n < header.layers.size(); ++n) {
    state.terrain.set_raw_words(header.layers[n], words.layers[n].copy());
    if (info(header.layers[n]).lifetime == Lifetime::held) state.held_layers_known = true;
  }
  if (state.plants) state.set_plants(words.plants.copy());
  require_balance(state, path);
  return simulation;
}

}  // namespace desert_sim

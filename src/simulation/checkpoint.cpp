#include "src/simulation/checkpoint.hpp"

#include <fcntl.h>
#include <unistd.h>
#include <xxhash.h>
#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <cstring>

#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/simulation/commands/command_yaml.hpp"
#include "src/simulation/pipeline/memory.hpp"

namespace desert_sim {

namespace {

const std::string magic = "desert_sim checkpoint\n";
constexpr std::uint32_t version = 3;

template <class T>
void append(std::string& to, const T& value) {
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
T take_from(const std::string& from, std::size_t& at, const std::string& path) {
  T value;
  if (from.size() - at < sizeof value) throw ConfigError(path + ": is cut off");
  std::memcpy(&value, from.data() + at, sizeof value);
  at += sizeof value;
  return value;
}

std::string read_whole(const std::string& path) {
  std::string bytes = read_file(path);
  if (bytes.compare(0, magic.size(), magic) != 0) throw ConfigError(path + ": is not a checkpoint");
  std::size_t at = magic.size();
  const auto found = take_from<std::uint32_t>(bytes, at, path);
  if (found != version)
    throw ConfigError(path + ": is a checkpoint of version " + std::to_string(found) +
                      "; this program reads version " + std::to_string(version));
  if (bytes.size() < at + sizeof(std::uint64_t) * 2) throw ConfigError(path + ": is cut off");
  std::size_t end = bytes.size() - sizeof(std::uint64_t);
  const std::size_t body = end;
  if (take_from<std::uint64_t>(bytes, end, path) != XXH3_64bits(bytes.data(), body))
    throw ConfigError(path + ": is cut off or corrupt (its checksum is wrong)");
  return bytes;
}

}  // namespace

/// Reads and writes what Simulation keeps to itself.
class CheckpointAccess {
 public:
  static std::string header(const Simulation& s) {
    YAML::Emitter out;
    yaml::keep_all_bits(out);
    const auto entry = [&](const char* key, const auto& value) {
      out << YAML::Key << key << YAML::Value << value;
    };
    out << YAML::BeginMap;
    entry("name", s.scenario_.name);
    entry("folder", s.scenario_.folder);
    entry("projection", s.scenario_.projection);
    entry("start", dump_scenario(s.start_));
    entry("scenario", dump_scenario(s.scenario_));
    entry("steps", s.steps_);
    entry("datum", s.terrain_.scale().datum);
    entry("exponent", s.terrain_.scale().exponent);
    entry("wind_reference", s.wind_reference_);
    entry("bedrock_loose", s.bedrock_loose_);
    entry("soil_loose", s.soil_loose_);
    entry("avalanche_iterations", s.avalanche_iterations());
    entry("plants", s.plants_.count);
    entry("next_timeline_entry", s.next_entry_);
    out << YAML::Key << "ramps" << YAML::Value << YAML::BeginSeq;
    for (const Ramp& r : s.ramps_) {
      out << YAML::Flow << YAML::BeginMap;
      entry("path", r.path);
      entry("from", r.from);
      entry("to", r.to);
      entry("start", r.start);
      entry("duration", r.duration);
      entry("stair", r.stair);
      out << YAML::EndMap;
    }
    out << YAML::EndSeq << YAML::Key << "initial" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (long long quanta : s.initial_) out << quanta;
    out << YAML::EndSeq << YAML::Key << "ledger" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (long long quanta : s.read_ledger()) out << quanta;
    out << YAML::EndSeq << YAML::Key << "wind" << YAML::Value << YAML::BeginMap;
    emit_regime(out, s.regime_);
    out << YAML::EndMap << YAML::Key << "layers" << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const LayerInfo& row : layer_table)
      if (row.lifetime == Lifetime::persistent && s.terrain_.has(row.layer)) out << row.name;
    out << YAML::EndSeq << YAML::EndMap;
    return out.c_str();
  }

  static std::unique_ptr<Simulation> make(const YAML::Node& header, Exec& exec, const std::string& path) {
    const Scenario scenario = read_scenario(header, "scenario", path);
    HeightScale scale;
    scale.datum = header["datum"].as<double>();
    scale.exponent = header["exponent"].as<int>();
    require_memory(exec, scenario, sizeof(std::uint32_t));
    std::unique_ptr<Simulation> s(new Simulation(scenario, Terrain(exec, scenario.make_grid(), scale)));
    s->start_ = read_scenario(header, "start", path);
    s->steps_ = header["steps"].as<std::uint64_t>();
    s->wind_reference_ = header["wind_reference"].as<Quanta>();
    s->bedrock_loose_ = header["bedrock_loose"].as<bool>();
    s->soil_loose_ = header["soil_loose"].as<bool>();
    if (s->bedrock_loose_ || s->soil_loose_) s->prepare_ground_avalanches();
    s->avalanche_iterations_ = header["avalanche_iterations"].as<std::uint64_t>();
    s->next_entry_ = header["next_timeline_entry"].as<std::size_t>();
    for (const YAML::Node& r : header["ramps"])
      s->ramps_.push_back({r["path"].as<std::string>(), r["from"].as<double>(), r["to"].as<double>(),
                           r["start"].as<double>(), r["duration"].as<double>(), r["stair"].as<int>()});
    for (std::size_t m = 0; m < s->initial_.size(); ++m)
      s->initial_[m] = header["initial"][m].as<long long>();
    std::vector<long long> words(LedgerView::words, 0);
    for (std::size_t account = 0; account < material_count * 2; ++account)
      words[account * LedgerView::stripes] = header["ledger"][account].as<long long>();
    s->ledger_.upload(words);
    s->regime_ = read_regime(header["wind"], path + ": wind");
    return s;
  }

  static Terrain& terrain(Simulation& s) { return s.terrain_; }
  static void set_plants(Simulation& s, const std::vector<std::uint32_t>& words) {
    if (s.plants_) s.set_plants(words);
  }

 private:
  static Scenario read_scenario(const YAML::Node& header, const char* key, const std::string& path) {
    Scenario scenario =
        parse_scenario(YAML::Load(header[key].as<std::string>()), path, header["folder"].as<std::string>());
    scenario.name = header["name"].as<std::string>();
    scenario.projection = header["projection"].as<std::string>();
    return scenario;
  }
};

/// To a temporary file first, which gets its name when it is durable.
void write_checkpoint(const std::string& path, const std::string& bytes) {
  const std::string temporary = path + ".part";
  const auto fail = [&](const char* what) {
    const std::string reason = std::strerror(errno);
    unlink(temporary.c_str());
    throw ConfigError(path + ": " + what + ": " + reason);
  };
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) fail("cannot be written");
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = write(file, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      const int error = errno;
      close(file);
      errno = error;
      fail("writing");
    }
    done += static_cast<std::size_t>(n);
  }
  if (fsync(file) != 0 || close(file) != 0) fail("making it durable");
  if (rename(temporary.c_str(), path.c_str()) != 0) fail("renaming");
  const std::size_t slash = path.rfind('/');
  const int folder =
      open(slash == std::string::npos ? "." : path.substr(0, slash + 1).c_str(), O_RDONLY | O_CLOEXEC);
  if (folder >= 0) {
    fsync(folder);  // the name itself; a file system that cannot do this still has the data
    close(folder);
  }
}

std::string checkpoint_bytes(const Simulation& simulation) {
  const std::string header = CheckpointAccess::header(simulation);
  std::string bytes;
  std::size_t length = header.size() + 256;
  for (const LayerInfo& row : layer_table)
    if (row.lifetime == Lifetime::persistent && simulation.terrain().has(row.layer))
      length += static_cast<std::size_t>(simulation.terrain().grid().cells()) * sizeof(std::uint32_t);
  length +=
      static_cast<std::size_t>(simulation.plants().count) * plants::column_count * sizeof(std::uint32_t);
  bytes.reserve(length);  // growing could take three times as much
  bytes = magic;
  append(bytes, version);
  append(bytes, static_cast<std::uint64_t>(header.size()));
  bytes += header;
  for (const LayerInfo& row : layer_table) {
    if (row.lifetime != Lifetime::persistent || !simulation.terrain().has(row.layer)) continue;
    const std::vector<std::uint32_t> words = simulation.terrain().words(row.layer);
    bytes.append(reinterpret_cast<const char*>(words.data()), words.size() * sizeof(std::uint32_t));
  }
  const std::vector<std::uint32_t> plants = plants::words(simulation.plants());
  bytes.append(reinterpret_cast<const char*>(plants.data()), plants.size() * sizeof(std::uint32_t));
  append(bytes, static_cast<std::uint64_t>(XXH3_64bits(bytes.data(), bytes.size())));
  return bytes;
}

void save_checkpoint(const std::string& path, const Simulation& simulation) {
  write_checkpoint(path, checkpoint_bytes(simulation));
}

std::unique_ptr<Simulation> load_checkpoint(const std::string& path, Exec& exec) {
  const std::string bytes = read_whole(path);
  std::size_t at = magic.size() + sizeof version;
  const auto length = take_from<std::uint64_t>(bytes, at, path);
  if (length > bytes.size() - at) throw ConfigError(path + ": is cut off");
  try {
    const YAML::Node header = YAML::Load(bytes.substr(at, length));
    at += length;
    std::unique_ptr<Simulation> simulation = CheckpointAccess::make(header, exec, path);
    const std::size_t cells = static_cast<std::size_t>(simulation->terrain().grid().cells());
    const auto next_words = [&](std::size_t count) {
      std::vector<std::uint32_t> words(count);
      if ((bytes.size() - at) / sizeof(std::uint32_t) < count) throw ConfigError(path + ": is cut off");
      if (count > 0) std::memcpy(words.data(), bytes.data() + at, count * sizeof(std::uint32_t));
      at += count * sizeof(std::uint32_t);
      return words;
    };
    for (const YAML::Node& name : header["layers"])
      CheckpointAccess::terrain(*simulation)
          .set_words(layer_by_name(name.as<std::string>()), next_words(cells));
    CheckpointAccess::set_plants(*simulation,
                                 next_words(header["plants"].as<std::size_t>() * plants::column_count));
    return simulation;
  } catch (const YAML::Exception& e) {
    throw ConfigError(path + ": its header cannot be read: " + e.msg);
  }
}

}  // namespace desert_sim

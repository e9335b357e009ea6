#include "src/tools/certificate.hpp"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/core/joined.hpp"
#include "src/scenario/scenario_file.hpp"
#include "src/tools/json.hpp"

namespace desert_sim {

namespace {

constexpr int most_cells = 65536;                              // along an axis
constexpr std::uint64_t most_certified_steps = 1'000'000'000;  // of a run
constexpr int usual_cells = 256;                               // along an axis, of a scenario that is new
constexpr std::uint64_t usual_steps = 200;

/// The object of a run, whose keys are asked for one by one.
class RunReader {
 public:
  RunReader(const Json& object, const std::string& where) : object_(object), where_(where) {
    if (!object.is_object()) throw ConfigError(where + ": is not an object");
    if (const Json* name = find("name"); name && name->is_string())
      where_ += " (" + name->get<std::string>() + ")";
  }
  /// Null if the key is not there.
  const Json* find(const std::string& key) {
    known_.push_back(key);
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  const Json& get(const std::string& key) {
    const Json* value = find(key);
    if (!value) throw ConfigError(where_ + ": " + key + ": is missing");
    return *value;
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
    throw ConfigError(where_ + ": " + key + ": " + shortened(object_.at(key).dump()) +
                      " (allowed: " + allowed + ")");
  }
  std::string text(const std::string& key) {
    const Json& value = get(key);
    if (!value.is_string() || value.get<std::string>().empty()) refuse(key, "a text");
    return value.get<std::string>();
  }
  std::string text_or_none(const std::string& key) { return find(key) ? text(key) : ""; }
  bool is_integer(const Json& value, std::uint64_t lowest, std::uint64_t highest) const {
    if (!value.is_number_unsigned()) return false;
    const auto number = value.get<std::uint64_t>();
    return number >= lowest && number <= highest;
  }
  void refuse_other_keys() const {
    for (const auto& [key, value] : object_.items())
      if (std::find(known_.begin(), known_.end(), key) == known_.end())
        throw ConfigError(where_ + ": " + not_one_of(key, joined(known_)));
  }

 private:
  const Json& object_;
  std::string where_;
  std::vector<std::string> known_;
};

CertifiedResult read_result(RunReader& reader) {
  const std::string text = reader.text("result");
  const auto found = std::find(std::begin(certified_results), std::end(certified_results), text);
  if (found == std::end(certified_results)) reader.refuse("result", joined(certified_results));
  return static_cast<CertifiedResult>(found - std::begin(certified_results));
}

std::optional<std::uint64_t> read_hash(RunReader& reader) {
  const Json& value = reader.get("hash");
  if (value.is_null()) return std::nullopt;
  const std::string text = value.is_string() ? value.get<std::string>() : "";
  std::uint64_t hash = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), hash, 16);
  if (text.size() != 16 || read.ptr != text.data() + text.size() || hash_text(hash) != text)
    reader.refuse("hash", "16 digits of 0123456789abcdef, or null");
  return hash;
}

CertifiedRun read_run(const Json& object, const std::string& where) {
  RunReader reader(object, where);
  CertifiedRun run;
  run.name = reader.text("name");
  run.result = read_result(reader);
  run.scenario = reader.text_or_none("scenario");
  run.file = reader.text_or_none("file");
  run.rover = reader.text_or_none("rover");
  if (const Json* size = reader.find("size")) {
    const auto fits = [&](const Json& cells) { return reader.is_integer(cells, 1, most_cells); };
    if (!size->is_array() || size->size() != 2 || !std::all_of(size->begin(), size->end(), fits))
      reader.refuse("size", "width and height, 1 ... " + std::to_string(most_cells) + " cells");
    run.width = size->at(0).get<int>(), run.height = size->at(1).get<int>();
  }
  if (const Json* settings = reader.find("settings")) {
    const auto is_text = [](const Json& setting) { return setting.is_string(); };
    if (!settings->is_array() || !std::all_of(settings->begin(), settings->end(), is_text))
      reader.refuse("settings", "a list of texts, KEY=VALUE");
    run.settings = settings->get<Settings>();
  }
  const bool has_steps = run.result != CertifiedResult::journal;
  if (has_steps && !reader.is_integer(reader.get("steps"), 1, most_certified_steps))
    reader.refuse("steps", "1 ... " + std::to_string(most_certified_steps));
  if (has_steps) run.steps = reader.get("steps").get<std::uint64_t>();
  run.hash = read_hash(reader);
  reader.refuse_other_keys();
  const auto require = [&](bool needed, const char* key) {
    if (needed) reader.text(key);
  };
  require(run.result != CertifiedResult::checkpoint, "scenario");
  require(run.result == CertifiedResult::checkpoint || run.result == CertifiedResult::journal, "file");
  require(run.result == CertifiedResult::rover, "rover");
  return run;
}

/// In JSON.
std::string quoted(const std::string& text) { return Json(text).dump(); }

std::string line_of(const CertifiedRun& run) {
  std::string line = "{\"name\": " + quoted(run.name) +
                     ", \"result\": " + quoted(certified_results[static_cast<int>(run.result)]);
  const auto add = [&line](const char* key, const std::string& value) {
    line += std::string(", \"") + key + "\": " + value;
  };
  if (!run.scenario.empty()) add("scenario", quoted(run.scenario));
  if (!run.file.empty()) add("file", quoted(run.file));
  if (!run.rover.empty()) add("rover", quoted(run.rover));
  if (run.width > 0) add("size", "[" + std::to_string(run.width) + ", " + std::to_string(run.height) + "]");
  if (!run.settings.empty()) add("settings", "[" + joined(run.settings, quoted) + "]");
  if (run.steps > 0) add("steps", std::to_string(run.steps));
  add("hash", run.hash ? quoted(hash_text(*run.hash)) : "null");
  return line + "}";
}

}  // namespace

Certificate read_certificate(const std::string& path) {
  const Json all = read_json(path);
  if (!all.is_object() || all.size() != 1 || !all.contains("runs") || !all.at("runs").is_array() ||
      all.at("runs").empty())
    throw ConfigError(path + ": is no certificate (allowed: an object with the list 'runs')");
  Certificate runs;
  std::set<std::string> names;
  for (const Json& object : all.at("runs")) {
    runs.push_back(read_run(object, path + ": run " + std::to_string(runs.size() + 1)));
    if (!names.insert(runs.back().name).second)
      throw ConfigError(path + ": two runs have the name " + in_quotes(runs.back().name));
  }
  return runs;
}

std::string certificate_text(const Certificate& runs) {
  std::string text = "{\"runs\": [\n";
  for (const CertifiedRun& run : runs) text += (&run == &runs.front() ? " " : ",\n ") + line_of(run);
  return text + "\n]}\n";
}

void add_new_scenarios(Certificate& runs) {
  for (const std::string& name : installed_scenarios()) {
    const auto is_of_it = [&name](const CertifiedRun& run) { return run.scenario == name; };
    if (std::any_of(runs.begin(), runs.end(), is_of_it)) continue;
    const Scenario scenario = load_scenario(scenario_file(name));
    CertifiedRun run;
    run.name = run.scenario = name;
    run.steps = usual_steps;
    if (scenario.grid.from_raster.empty()) {
      run.width = std::min(scenario.grid.width, usual_cells);
      run.height = std::min(scenario.grid.height, usual_cells);
    }
    runs.push_back(run);
  }
}

}  // namespace desert_sim

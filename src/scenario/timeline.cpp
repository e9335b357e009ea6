#include "src/scenario/timeline.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include "src/core/input_file.hpp"
#include "src/core/quoted.hpp"
#include "src/core/time_units.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_flow_text.hpp"
#include "src/scenario/yaml_parameters.hpp"
#include "src/scenario/yaml_text.hpp"

namespace desert_sim {

namespace {

double read_time(const YAML::Node& node, const std::string& key, ValidationErrors& errors) {
  double value = 0;
  if (node.IsDefined() && !(yaml::decode_number(node, "s", value) && value >= 0 && value <= 1e12))
    errors.add(key, yaml::node_text(node) +
                        " is not a time (allowed: [0, 1e+12] s, or with a unit: " + time_units + ")");
  return value;
}

void read_repetition(const YAML::Node& node, const std::string& key, ValidationErrors& errors,
                     TimelineEntry& entry) {
  entry.every = read_time(node["every"], key + ".every", errors);
  if (entry.every > 0 && entry.every < entry.most_frequent)
    errors.add(key + ".every", yaml::node_text(node["every"]) + " is too often (allowed: [0.0001, 1e+12] s)");
  if (!node["until"]) return;
  entry.until = read_time(node["until"], key + ".until", errors);
  if (!(entry.every > 0)) errors.add(key + ".until", "is given without 'every'");
  if (entry.until < entry.time) errors.add(key + ".until", "is earlier than 'time'");
}

/// All keys of the entry but those that say when are the command's.
std::string command_text(const YAML::Node& entry, const std::string& path, ValidationErrors& errors) {
  YAML::Node command(YAML::NodeType::Map);
  std::set<std::string> seen;
  for (const auto& part : entry) {
    const std::string key = part.first.Scalar();
    if (!seen.insert(key).second) errors.add(path + key, "is given twice");
    if (key != "time" && key != "every" && key != "until") command[key] = part.second;
  }
  return yaml::flow_text(command);
}

TimelineEntry read_entry(const YAML::Node& node, const std::string& key, ValidationErrors& errors) {
  TimelineEntry entry;
  const bool is_command = node.IsMap() && node["command"];
  if (!is_command)
    yaml::reject_unknown_keys(node, key + ".", {"time", "ramp", "every", "until", "set"}, errors);
  if (node.IsNull()) errors.add(key, "nothing is given where keys and values are expected");
  if (!node.IsMap()) return entry;
  if (!node["time"]) errors.add(key + ".time", "is missing");
  entry.time = read_time(node["time"], key + ".time", errors);
  read_repetition(node, key, errors, entry);
  if (is_command) {
    entry.command = command_text(node, key + ".", errors);
    return entry;
  }
  entry.ramp = read_time(node["ramp"], key + ".ramp", errors);
  const YAML::Node set = node["set"];
  if (!set || !set.IsMap() || set.size() == 0) {
    errors.add(key + ".set",
               "must name parameters and their values, such as {rain.rate: 1.0e-5}, or "
               "'command' a command");
    return entry;
  }
  for (const auto& setting : set)
    entry.settings.push_back(setting.first.Scalar() + "=" + yaml::flow_text(setting.second));
  return entry;
}

bool is_earlier(const TimelineEntry& a, const TimelineEntry& b) { return a.time < b.time; }

/// Returns whether there are not too many.
bool check_length(std::size_t length, const std::string& key, ValidationErrors& errors) {
  if (length > max_timeline_entries)
    errors.add(key, std::to_string(length) + " entries are given (allowed: at most " +
                        std::to_string(max_timeline_entries) + ")");
  return length <= max_timeline_entries;
}

/// Sets `found` to the value of a floating-point parameter that can change, and returns its unit; null if
/// `path` is none.
const char* find_number(const Scenario& scenario, const std::string& path, double& found) {
  const char* unit = nullptr;
  for_each_live_parameter(scenario, [&](const std::string& section, const auto& row, const auto& value) {
    if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>)
      if (path == section + "." + row.name) {
        found = static_cast<double>(value);
        unit = row.unit;
      }
  });
  return unit;
}

}  // namespace

std::optional<double> TimelineEntry::next_after(double after) const {
  if (time > after) return time;
  if (!(every > 0)) return std::nullopt;
  // The quotient is rounded, so that the repetition it names may be one too early or too late. Where
  // repetitions lie closer than numbers do, the next number is one.
  double n = std::max(0.0, std::floor((after - time) / every) - 1), next = time + n * every;
  for (int tries = 0; next <= after && tries < 4; ++tries) next = time + ++n * every;
  if (next <= after) next = std::nextafter(after, no_end);
  return next <= until ? std::optional(next) : std::nullopt;
}

std::optional<double> TimelineEntry::last_between(double after, double now) const {
  const std::optional<double> next = next_after(after);
  if (!next || *next > now) return std::nullopt;
  if (!(every > 0)) return next;
  const double end = std::min(now, until);
  double n = std::floor((end - time) / every) + 1, last = time + n * every;
  for (int tries = 0; last > end && tries < 4; ++tries) last = time + --n * every;
  return last > after && last <= end ? last : *next;
}

int Ramp::step_index_at(double time) const {
  if (time >= start + duration) return step_count;
  return std::clamp(static_cast<int>(std::floor((time - start) / duration * step_count)), 0, step_count - 1);
}

void sort_by_path(std::vector<Ramp>& ramps) {
  std::stable_sort(ramps.begin(), ramps.end(), [](const Ramp& a, const Ramp& b) { return a.path < b.path; });
}

std::vector<Ramp> extract_ramps(const Scenario& scenario, std::vector<std::string>& settings, double time,
                                double duration) {
  std::vector<Ramp> ramps;
  if (!(duration > 0)) return ramps;
  std::vector<std::string> immediate;
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    Ramp ramp{setting.substr(0, equals), 0, 0, time, duration, 0};
    const char* const unit = find_number(scenario, ramp.path, ramp.from);
    if (unit && yaml::decode_number(YAML::Load(setting.substr(equals + 1)), unit, ramp.to))
      ramps.push_back(ramp);
    else
      immediate.push_back(setting);
  }
  settings = immediate;
  return ramps;
}

void check_ramp(const Scenario& scenario, const Ramp& ramp, double time, const std::string& key,
                ValidationErrors& errors) {
  if (!(ramp.start <= time))
    errors.add(key + ".start", std::to_string(ramp.start) + " s is later than the present time, " +
                                   std::to_string(time) + " s");
  bool found = false;
  for_each_live_parameter(scenario, [&](const std::string& section, const auto& row, const auto& value) {
    using T = std::decay_t<decltype(value)>;
    if constexpr (std::is_floating_point_v<T>) {
      if (ramp.path != section + "." + row.name) return;
      found = true;
      for (const double end : {ramp.from, ramp.to})
        if (!yaml::in_range<T>(end, row))
          errors.add(key,
                     ramp.path + " = " + std::to_string(end) + " is not in " + yaml::allowed_range<T>(row));
    }
  });
  if (!found)
    errors.add(key + ".path", in_quotes(ramp.path) + " is not a floating-point parameter that can change");
}

std::vector<TimelineEntry> read_timeline(const YAML::Node& list, const std::string& key,
                                         ValidationErrors& errors) {
  std::vector<TimelineEntry> timeline;
  if (!list.IsDefined() || list.IsNull()) return timeline;
  if (!list.IsSequence()) {
    errors.add(key, yaml::node_text(list) + " is given where a list is expected");
    return timeline;
  }
  if (!check_length(list.size(), key, errors)) return timeline;
  for (std::size_t n = 0; n < list.size(); ++n) {
    if (errors.is_full()) break;
    timeline.push_back(read_entry(list[n], key + "." + std::to_string(n), errors));
    if (n > 0 && is_earlier(timeline[n], timeline[n - 1]))
      errors.add(key + "." + std::to_string(n) + ".time", "is earlier than that of the previous entry");
  }
  return timeline;
}

namespace {

void emit_settings(YAML::Emitter& out, const TimelineEntry& entry) {
  out << YAML::Key << "ramp" << YAML::Value << entry.ramp << YAML::Key << "set" << YAML::Value
      << YAML::BeginMap;
  for (const std::string& setting : entry.settings) {
    const std::size_t equals = setting.find('=');
    out << YAML::Key << setting.substr(0, equals) << YAML::Value << YAML::Load(setting.substr(equals + 1));
  }
  out << YAML::EndMap;
}

}  // namespace

std::string timeline_raster(const TimelineEntry& entry) {
  constexpr const char* key = "image_file";
  if (entry.command.find(key) == std::string::npos) return "";
  const YAML::Node file = YAML::Load(entry.command)[key];
  return !file ? "" : file.IsScalar() ? file.Scalar() : "?";
}

void emit_timeline(YAML::Emitter& out, const std::vector<TimelineEntry>& timeline) {
  out << YAML::Key << "timeline" << YAML::Value << YAML::BeginSeq;
  for (const TimelineEntry& entry : timeline) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "time" << YAML::Value << entry.time;
    if (entry.every > 0) out << YAML::Key << "every" << YAML::Value << entry.every;
    if (entry.until < entry.no_end) out << YAML::Key << "until" << YAML::Value << entry.until;
    if (entry.command.empty())
      emit_settings(out, entry);
    else
      for (const auto& part : YAML::Load(entry.command))
        out << YAML::Key << part.first << YAML::Value << part.second;
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void check_timeline(const Scenario& scenario, const std::vector<TimelineEntry>& timeline,
                    const std::string& list, ValidationErrors& errors) {
  Scenario then = scenario;
  then.timeline.clear();
  for (int* cells : {&then.grid.width, &then.grid.height}) *cells = *cells > 0 ? *cells : 1;
  if (then.grid.cell_size == 0) then.grid.cell_size = 1;  // resolve_grid() may set it later
  for (std::size_t n = 0; n < timeline.size(); ++n) {
    const TimelineEntry& entry = timeline[n];
    const std::string key = list + "." + std::to_string(n);
    for (const std::string& setting : entry.settings)
      if (setting.rfind("run.timeline", 0) == 0)
        errors.add(key + ".set.run.timeline", "would replace its own list");
    try {
      if (!entry.settings.empty()) then = with_live_settings(then, entry.settings);
    } catch (const ConfigError& e) {
      errors.add(key + ".set", e.what());
    }
  }
}

void add_script(Scenario& scenario, const std::string& path) {
  ValidationErrors errors(path);
  const YAML::Node list = yaml_text::parse(InputFile(path, "").read_all(), path);
  if (!list.IsSequence())
    throw ConfigError(path + ": is not a list of what happens when (allowed: entries as of run.timeline)");
  std::vector<TimelineEntry> script = read_timeline(list, "timeline", errors);
  check_length(scenario.timeline.size() + script.size(), "timeline, with the scenario's", errors);
  errors.throw_if_any();
  check_timeline(scenario, script, "timeline", errors);
  errors.throw_if_any();
  std::vector<TimelineEntry> merged;
  std::merge(scenario.timeline.begin(), scenario.timeline.end(), script.begin(), script.end(),
             std::back_inserter(merged), is_earlier);
  scenario.timeline = std::move(merged);
}

}  // namespace desert_sim

#include "src/scenario/timeline.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "src/core/quoted.hpp"
#include "src/core/time_units.hpp"
#include "src/scenario/live_parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

std::string flow_text(const YAML::Node& node) {
  YAML::Emitter out;
  out.SetMapFormat(YAML::Flow);
  out.SetSeqFormat(YAML::Flow);
  out << node;
  std::string text = out.c_str();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

double read_time(const YAML::Node& node, const std::string& key, ValidationErrors& errors) {
  double value = 0;
  if (node.IsDefined() && !(yaml::decode_number(node, "s", value) && value >= 0 && value <= 1e12))
    errors.add(key, yaml::node_text(node) +
                        " is not a time (allowed: [0, 1e+12] s, or with a unit: " + time_units + ")");
  return value;
}

TimelineEntry read_entry(const YAML::Node& node, const std::string& key, ValidationErrors& errors) {
  TimelineEntry entry;
  yaml::reject_unknown_keys(node, key + ".", {"time", "ramp", "set"}, errors);
  if (node.IsNull()) errors.add(key, "nothing is given where keys and values are expected");
  if (!node.IsMap()) return entry;
  if (!node["time"]) errors.add(key + ".time", "is missing");
  entry.time = read_time(node["time"], key + ".time", errors);
  entry.ramp = read_time(node["ramp"], key + ".ramp", errors);
  const YAML::Node set = node["set"];
  if (!set || !set.IsMap() || set.size() == 0) {
    errors.add(key + ".set", "must name parameters and their values, such as {rain.rate: 1.0e-5}");
    return entry;
  }
  for (const auto& setting : set)
    entry.settings.push_back(setting.first.Scalar() + "=" + flow_text(setting.second));
  return entry;
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

int Ramp::step_index_at(double time) const {
  if (time >= start + duration) return step_count;
  return std::clamp(static_cast<int>(std::floor((time - start) / duration * step_count)), 0, step_count - 1);
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

std::vector<TimelineEntry> read_timeline(const YAML::Node& list, ValidationErrors& errors) {
  std::vector<TimelineEntry> timeline;
  const std::string key = "run.timeline";
  if (!list.IsDefined() || list.IsNull()) return timeline;
  if (!list.IsSequence()) {
    errors.add(key, yaml::node_text(list) + " is given where a list is expected");
    return timeline;
  }
  if (list.size() > max_timeline_entries) {
    errors.add(key, std::to_string(list.size()) + " entries are given (allowed: at most " +
                        std::to_string(max_timeline_entries) + ")");
    return timeline;
  }
  for (std::size_t n = 0; n < list.size(); ++n) {
    timeline.push_back(read_entry(list[n], key + "." + std::to_string(n), errors));
    if (n > 0 && timeline[n].time < timeline[n - 1].time)
      errors.add(key + "." + std::to_string(n) + ".time", "is earlier than that of the previous entry");
  }
  return timeline;
}

void emit_timeline(YAML::Emitter& out, const std::vector<TimelineEntry>& timeline) {
  out << YAML::Key << "timeline" << YAML::Value << YAML::BeginSeq;
  for (const TimelineEntry& entry : timeline) {
    out << YAML::Flow << YAML::BeginMap << YAML::Key << "time" << YAML::Value << entry.time << YAML::Key
        << "ramp" << YAML::Value << entry.ramp << YAML::Key << "set" << YAML::Value << YAML::BeginMap;
    for (const std::string& setting : entry.settings) {
      const std::size_t equals = setting.find('=');
      out << YAML::Key << setting.substr(0, equals) << YAML::Value << YAML::Load(setting.substr(equals + 1));
    }
    out << YAML::EndMap << YAML::EndMap;
  }
  out << YAML::EndSeq;
}

void check_timeline(const Scenario& scenario, ValidationErrors& errors) {
  Scenario then = scenario;
  then.timeline.clear();
  for (int* cells : {&then.grid.width, &then.grid.height}) *cells = *cells > 0 ? *cells : 1;
  if (then.grid.cell_size == 0) then.grid.cell_size = 1;  // resolve_grid() may set it later
  for (std::size_t n = 0; n < scenario.timeline.size(); ++n) {
    try {
      then = with_live_settings(then, scenario.timeline[n].settings);
    } catch (const ConfigError& e) {
      errors.add("run.timeline." + std::to_string(n) + ".set", e.what());
    }
  }
}

}  // namespace desert_sim

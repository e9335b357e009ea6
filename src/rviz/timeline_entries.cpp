#include "src/rviz/timeline_entries.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "src/core/number_text.hpp"
#include "src/core/time_units.hpp"
#include "src/scenario/timeline.hpp"
#include "src/scenario/yaml_flow_text.hpp"

namespace desert_sim {

namespace {

/// The time under a key; `otherwise` without one.
double time_of(const YAML::Node& entry, const char* key, double otherwise) {
  double seconds = otherwise;
  if (entry.IsMap() && entry[key] && entry[key].IsScalar()) read_entry_time(entry[key].Scalar(), seconds);
  return seconds;
}

std::string seconds_text(double seconds) { return time_text(seconds) + " s"; }

/// When it happens for the last time [s].
double end_of(const YAML::Node& entry) {
  const double time = time_of(entry, "time", 0), every = time_of(entry, "every", 0),
               until = time_of(entry, "until", TimelineEntry::no_end);
  return every > 0 ? time + std::max(0.0, std::floor((until - time) / every)) * every : time;
}

/// Long values, such as rasters, are cut.
std::string short_text(const YAML::Node& value) {
  constexpr std::size_t longest = 60;
  const std::string text = yaml::flow_text(value);
  return text.size() > longest ? text.substr(0, longest) + " …" : text;
}

std::string when_text(const YAML::Node& entry) {
  std::string text = seconds_text(time_of(entry, "time", 0));
  if (entry["every"]) text += ", every " + seconds_text(time_of(entry, "every", 0));
  if (entry["until"]) text += " until " + seconds_text(time_of(entry, "until", 0));
  return text;
}

std::string settings_text(const YAML::Node& entry) {
  std::string text;
  for (const auto& setting : entry["set"])
    text += (text.empty() ? "" : ", ") + setting.first.Scalar() + " → " + short_text(setting.second);
  const double ramp = time_of(entry, "ramp", 0);
  return ramp > 0 ? text + " within " + seconds_text(ramp) : text;
}

std::string command_words(const YAML::Node& entry) {
  std::string keys;
  for (const auto& part : entry) {
    const std::string key = part.first.Scalar();
    if (key == "time" || key == "every" || key == "until" || key == "command") continue;
    keys += (keys.empty() ? ": " : ", ") + key + " " + short_text(part.second);
  }
  return entry["command"].Scalar() + keys;
}

}  // namespace

TimelineEntries timeline_entries(const std::string& scenario) {
  TimelineEntries entries;
  const YAML::Node run = YAML::Load(scenario)["run"];
  if (run && run["timeline"])
    for (const YAML::Node& entry : run["timeline"]) entries.push_back(yaml::flow_text(entry));
  return entries;
}

std::string timeline_setting(const TimelineEntries& entries) {
  std::string list;
  for (const std::string& entry : entries) list += (list.empty() ? "" : ", ") + entry;
  return "run.timeline=[" + list + "]";
}

std::size_t insert_entry(TimelineEntries& entries, const std::string& entry) {
  const auto start = [](const std::string& text) {
    return time_of(YAML::Load(text), "time", TimelineEntry::no_end);
  };
  const double time = start(entry);
  std::size_t place = entries.size();
  while (place > 0 && start(entries[place - 1]) > time) --place;
  entries.insert(entries.begin() + static_cast<std::ptrdiff_t>(place), entry);
  return place;
}

std::string time_text(double seconds) { return number_text(seconds, 12); }

bool read_entry_time(const std::string& text, double& seconds) {
  return YAML::convert<double>::decode(YAML::Node(text), seconds) || read_time_with_unit(text, seconds);
}

EntryWords words_of(const std::string& text) {
  const YAML::Node entry = YAML::Load(text);
  return {when_text(entry), entry["command"] ? command_words(entry) : settings_text(entry), end_of(entry)};
}

}  // namespace desert_sim

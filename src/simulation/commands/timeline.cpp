/// Parameters that change by themselves: a scenario's timeline, and ramps.
#include <algorithm>
#include <cstdio>

#include "src/core/error.hpp"
#include "src/simulation/commands/commands.hpp"

namespace desert_sim {

namespace {

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string path_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

}  // namespace

void Commands::begin_ramps(std::vector<std::string>& settings, double duration) {
  for (const std::string& setting : settings)
    state_.ramps.erase(std::remove_if(state_.ramps.begin(), state_.ramps.end(),
                                      [&](const Ramp& r) { return r.path == path_of(setting); }),
                       state_.ramps.end());
  for (Ramp& ramp : extract_ramps(state_.present_scenario(), settings, state_.time(), duration))
    state_.ramps.push_back(std::move(ramp));
}

void Commands::apply_timeline() {
  const std::vector<TimelineEntry>& timeline = state_.scenario.timeline;
  std::vector<std::string> due;
  for (; state_.next_timeline_entry < timeline.size() &&
         timeline[state_.next_timeline_entry].time <= state_.time();
       ++state_.next_timeline_entry) {
    std::vector<std::string> settings = timeline[state_.next_timeline_entry].settings;
    begin_ramps(settings, timeline[state_.next_timeline_entry].ramp);
    due.insert(due.end(), settings.begin(), settings.end());
  }
  for (Ramp& ramp : state_.ramps) {
    const int step_index = ramp.step_index_at(state_.time());
    if (step_index == ramp.step_index) continue;
    ramp.step_index = step_index;
    due.push_back(ramp.path + "=" + text_of(ramp.value()));
  }
  if (due.empty()) return;
  try {
    set_parameters(due);
  } catch (const ConfigError& e) {
    throw StateError("run.timeline at " + text_of(state_.time()) + " s: " + e.what());
  }
  state_.ramps.erase(std::remove_if(state_.ramps.begin(), state_.ramps.end(),
                                    [](const Ramp& r) { return r.step_index == Ramp::step_count; }),
                     state_.ramps.end());
}

std::string Commands::describe_changes() const {
  std::string text;
  const auto add = [&text](const std::string& line) { text += (text.empty() ? "" : "; ") + line; };
  for (const Ramp& ramp : state_.ramps)
    add(ramp.path + " -> " + text_of(ramp.to) + " until " + text_of(ramp.start + ramp.duration) + " s");
  if (state_.next_timeline_entry < state_.scenario.timeline.size()) {
    const TimelineEntry& next = state_.scenario.timeline[state_.next_timeline_entry];
    std::string settings;
    for (const std::string& setting : next.settings) settings += (settings.empty() ? "" : ", ") + setting;
    add("at " + text_of(next.time) + " s: " + settings);
  }
  return text;
}

}  // namespace desert_sim

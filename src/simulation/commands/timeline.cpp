/// Parameters that change by themselves: a scenario's timeline, and ramps.
#include <algorithm>
#include <cstdio>

#include "src/core/error.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

namespace {

std::string text_of(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::string path_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

}  // namespace

void Simulation::begin_ramps(std::vector<std::string>& settings, double duration) {
  for (const std::string& setting : settings)
    ramps_.erase(std::remove_if(ramps_.begin(), ramps_.end(),
                                [&](const Ramp& r) { return r.path == path_of(setting); }),
                 ramps_.end());
  for (Ramp& ramp : take_ramps(present_scenario(), settings, time(), duration))
    ramps_.push_back(std::move(ramp));
}

void Simulation::follow_timeline() {
  const std::vector<TimelineEntry>& timeline = scenario_.timeline;
  std::vector<std::string> due;
  for (; next_entry_ < timeline.size() && timeline[next_entry_].time <= time(); ++next_entry_) {
    std::vector<std::string> settings = timeline[next_entry_].settings;
    begin_ramps(settings, timeline[next_entry_].ramp);
    due.insert(due.end(), settings.begin(), settings.end());
  }
  for (Ramp& ramp : ramps_) {
    const int stair = ramp.stair_at(time());
    if (stair == ramp.stair) continue;
    ramp.stair = stair;
    due.push_back(ramp.path + "=" + text_of(ramp.value()));
  }
  if (due.empty()) return;
  try {
    set_parameters(due);
  } catch (const ConfigError& e) {
    throw StateError("run.timeline at " + text_of(time()) + " s: " + e.what());
  }
  ramps_.erase(
      std::remove_if(ramps_.begin(), ramps_.end(), [](const Ramp& r) { return r.stair == Ramp::stairs; }),
      ramps_.end());
}

std::string Simulation::describe_changes() const {
  std::string text;
  const auto add = [&text](const std::string& line) { text += (text.empty() ? "" : "; ") + line; };
  for (const Ramp& ramp : ramps_)
    add(ramp.path + " -> " + text_of(ramp.to) + " until " + text_of(ramp.start + ramp.duration) + " s");
  if (next_entry_ < scenario_.timeline.size()) {
    const TimelineEntry& next = scenario_.timeline[next_entry_];
    std::string settings;
    for (const std::string& setting : next.settings) settings += (settings.empty() ? "" : ", ") + setting;
    add("at " + text_of(next.time) + " s: " + settings);
  }
  return text;
}

}  // namespace desert_sim

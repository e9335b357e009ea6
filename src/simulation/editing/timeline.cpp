/// What happens by itself: a scenario's timeline, and ramps.
#include <algorithm>
#include <utility>

#include "src/core/error.hpp"
#include "src/core/joined.hpp"
#include "src/core/log.hpp"
#include "src/core/number_text.hpp"
#include "src/simulation/editing/commands.hpp"

namespace desert_sim {

namespace {

std::string text_of(double value) { return number_text(value, 9); }

std::string path_of(const std::string& setting) { return setting.substr(0, setting.find('=')); }

using Due = std::pair<double, std::size_t>;  ///< when [s], and which entry

/// The entries that are due after `after` and until `now` [s], in the order in which they happen.
std::vector<Due> due_entries(const std::vector<TimelineEntry>& timeline, double after, double now) {
  std::vector<Due> due;
  for (std::size_t n = 0; n < timeline.size(); ++n)
    if (const std::optional<double> time = timeline[n].last_between(after, now)) due.emplace_back(*time, n);
  std::sort(due.begin(), due.end());
  return due;
}

std::string name_of(const Command& command) {
  return std::visit([](const auto& one) { return one.name; }, command);
}

}  // namespace

Commands::Commands(SimulationState& state, Pipeline& pipeline)
    : state_(state),
      pipeline_(pipeline),
      history_(state, pipeline,
               [this](const Scenario& wanted, const std::string& what) {
                 require_scenario(wanted, what);
                 read_timed_commands(wanted);  // none is for a species that would go
               }),
      timed_commands_(read_timed_commands(state.scenario)) {}

void Commands::begin_ramps(std::vector<std::string>& settings, double duration) {
  for (const std::string& setting : settings)
    state_.ramps.erase(std::remove_if(state_.ramps.begin(), state_.ramps.end(),
                                      [&](const Ramp& r) { return r.path == path_of(setting); }),
                       state_.ramps.end());
  for (Ramp& ramp : extract_ramps(state_.present_scenario(), settings, state_.time(), duration))
    state_.ramps.push_back(std::move(ramp));
  sort_by_path(state_.ramps);
}

/// Ramps and entries that were accepted one by one can meet a condition between parameters on their way. A
/// run goes on then: what is refused keeps its value. Returns the paths of these parameters.
std::vector<std::string> Commands::set_what_can_be_set(std::vector<std::string> due) {
  if (due.empty()) return {};
  try {
    set_parameters(due);
    due.clear();
  } catch (const ConfigError&) {  // NOLINT(bugprone-empty-catch): told below, setting by setting
  }
  std::string reasons;
  for (std::size_t before = due.size() + 1; due.size() < before;) {
    before = due.size();
    reasons.clear();
    std::vector<std::string> refused;
    for (const std::string& setting : due) {
      try {
        set_parameters({setting});
      } catch (const ConfigError& e) {
        refused.push_back(setting);
        reasons += "; " + setting + " is refused: " + e.what();
      }
    }
    due = std::move(refused);
  }
  std::transform(due.begin(), due.end(), due.begin(), path_of);
  if (!due.empty() && due != refused_parameters_)
    log_error("run.timeline and ramps: at " + text_of(state_.time()) + " s parameters keep their values" +
              reasons);
  refused_parameters_ = due;
  return due;
}

void Commands::apply_timed(const Command& command) {
  try {
    apply(command);
  } catch (const ConfigError& e) {
    log_error("run.timeline: at " + text_of(state_.time()) + " s " + name_of(command) +
              " is refused: " + e.what());
  }
}

void Commands::apply_timeline() {
  std::vector<std::string> due;
  for (const auto& [time, n] : due_entries(state_.scenario.timeline, state_.timeline_time, state_.time())) {
    if (const std::optional<Command>& command = timed_commands_[n]) {
      set_what_can_be_set(std::exchange(due, {}));  // what comes first may decide what the command does
      apply_timed(*command);
      continue;
    }
    std::vector<std::string> settings = state_.scenario.timeline[n].settings;
    begin_ramps(settings, state_.scenario.timeline[n].ramp);
    due.insert(due.end(), settings.begin(), settings.end());
  }
  state_.timeline_time = state_.time();
  for (Ramp& ramp : state_.ramps) {
    const int step_index = ramp.step_index_at(state_.time());
    if (step_index == ramp.step_index) continue;
    ramp.step_index = step_index;
    due.push_back(ramp.path + "=" + text_of(ramp.value()));
  }
  const std::vector<std::string> refused = set_what_can_be_set(std::move(due));
  for (Ramp& ramp : state_.ramps)  // one that has been refused at its end tries again at each step
    if (ramp.step_index == Ramp::step_count && std::count(refused.begin(), refused.end(), ramp.path) > 0)
      --ramp.step_index;
  state_.ramps.erase(std::remove_if(state_.ramps.begin(), state_.ramps.end(),
                                    [](const Ramp& r) { return r.step_index == Ramp::step_count; }),
                     state_.ramps.end());
}

std::string Commands::describe_changes() const {
  std::string text;
  const auto add = [&text](const std::string& line) { text += (text.empty() ? "" : "; ") + line; };
  for (const Ramp& ramp : state_.ramps)
    add(ramp.path + " -> " + text_of(ramp.to) + " until " + text_of(ramp.start + ramp.duration) + " s");
  std::optional<Due> next;
  for (std::size_t n = 0; n < state_.scenario.timeline.size(); ++n)
    if (const std::optional<double> time = state_.scenario.timeline[n].next_after(state_.timeline_time))
      next = next ? std::min(*next, Due(*time, n)) : Due(*time, n);
  if (next)
    add("at " + text_of(next->first) + " s: " +
        (timed_commands_[next->second] ? name_of(*timed_commands_[next->second])
                                       : joined(state_.scenario.timeline[next->second].settings)));
  return text;
}

}  // namespace desert_sim

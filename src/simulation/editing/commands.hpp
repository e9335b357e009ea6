#pragma once
/// What changes a simulation between steps: commands from outside, and the scenario's timeline.

#include <optional>
#include <string>
#include <vector>

#include "src/simulation/commands/command.hpp"
#include "src/simulation/editing/timed_commands.hpp"
#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/edit_history.hpp"

namespace desert_sim {

/// Throws ConfigError, in the name of `what`, unless it is a timeline or a rose whose numbers are in their
/// ranges.
void check_wind_schedule(const WindRegime& regime, const std::string& what);
/// Throws ConfigError unless the feature can be one of the wind's, apart from its id.
void check_wind_feature(const WindFeature& feature);

class Commands {
 public:
  /// Throws ConfigError if the scenario's timeline has commands that could never be applied.
  Commands(SimulationState& state, Pipeline& pipeline);

  /// A command is applied whole, or throws ConfigError and changes nothing. `with_change`: the result tells
  /// what changed, cell by cell. Those that replace the simulation are the Session's: they throw Error.
  CommandResult apply(const Command& command, bool with_change = false);

  EditHistory& history() { return history_; }

  /// Reads the timeline of the state's scenario anew, once another has taken its place. Throws as the
  /// constructor does.
  void read_timeline() { timed_commands_ = read_timed_commands(state_.scenario); }
  /// Does what the timeline has until now, and changes the parameters that ramps change. What is refused
  /// changes nothing, and is an error in the log; a ramp tries again.
  void apply_timeline();
  /// What the timeline and ramps are changing, and what comes next; empty if nothing.
  std::string describe_changes() const;

 private:
  struct Execution;  ///< what each command does
  /// Throws ConfigError, in the name of `what`, if the simulation could not go on with this scenario.
  void require_scenario(const Scenario& wanted, const std::string& what) const;
  void set_parameters(const std::vector<std::string>& settings);
  std::vector<std::string> set_what_can_be_set(std::vector<std::string> due);
  void apply_timed(const Command& command);
  /// Of `settings`, numbers become ramps where there is a duration [s]; former ramps of the same parameters
  /// stop.
  void begin_ramps(std::vector<std::string>& settings, double duration);

  SimulationState& state_;
  Pipeline& pipeline_;
  std::vector<std::string> refused_parameters_;  ///< at the last step; the log has told why
  EditHistory history_;
  std::vector<std::optional<Command>> timed_commands_;  ///< of each entry of the timeline
};

}  // namespace desert_sim

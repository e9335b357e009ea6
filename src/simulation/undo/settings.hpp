#pragma once
/// What commands set of a simulation besides its ground and its plants: parameters, ramps, the wind. Undo and
/// redo handle each setting as a text, by a key, as checkpoints and journals write it:
///
///     saltation.lift, species   a parameter; a list is one value
///     wind                      the regime that blows
///     wind.features.3           a local feature of the wind, by its id; gone if there is no text
///     #…                        what belongs to them and has no name of its own

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "src/simulation/pipeline/pipeline.hpp"
#include "src/simulation/state/state.hpp"
#include "src/simulation/undo/stroke.hpp"

namespace desert_sim {

/// What a command may set.
enum class SettingScope { wind, features, all };

using SettingTexts = std::map<std::string, std::string>;
using SettingChanges = std::map<std::string, std::optional<std::string>>;

/// The present settings.
SettingTexts settings_of(const SimulationState& state, SettingScope scope);

/// "path=value", or "path removed", of those that have a name.
std::vector<std::string> describe_settings(const SettingChanges& changes);

/// The settings that differ, in the order of keys. A parameter whose ramp differs counts as changed, because
/// its value goes on with it.
std::vector<ChangedSetting> changed_settings(const SettingTexts& before, const SettingTexts& after);

/// Throws ConfigError, in the name of `what`, if a simulation could not go on with this scenario.
using ScenarioCheck = std::function<void(const Scenario& wanted, const std::string& what)>;

/// Sets settings, in the name of an undo or redo.
class SettingsReturn {
 public:
  /// Throws ConfigError if the check refuses, or if plants are of a species that would go; `leaving`: how
  /// many of each species go before the settings do.
  SettingsReturn(SimulationState& state, Pipeline& pipeline, const SettingChanges& changes,
                 const ScenarioCheck& check, const std::vector<int>& leaving, const std::string& what);
  /// The scenario that there will be.
  const Scenario& scenario() const { return wanted_.scenario; }
  /// Throws ConfigError, and has changed nothing, if memory runs out.
  void set();
  /// Sets all as it was before.
  void roll_back();

 private:
  struct Present {
    Scenario scenario;
    WindRegime wind;
    std::vector<Ramp> ramps;
    ClockOrigin clock;
    bool held_layers_known;
  };
  void set(const Present& wanted);

  SimulationState& state_;
  Pipeline& pipeline_;
  const Present before_;
  Present wanted_;
  std::optional<ClockOrigin> clock_;  ///< while no step was made since it showed
  bool other_scenario_ = false;       ///< not only another regime
};

}  // namespace desert_sim

#pragma once
/// The state of a simulation: the terrain, the plants, the clock, the wind regime, and the accounts of
/// material. It is all that a checkpoint saves; everything else follows from it.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kernels/field/ledger.hpp"
#include "kernels/micro_relief/ripple_size.hpp"
#include "kernels/plants/workspace.hpp"
#include "src/scenario/gusts.hpp"
#include "src/scenario/scenario.hpp"
#include "src/simulation/state/clock_origin.hpp"
#include "src/terrain/terrain.hpp"

namespace desert_sim {

/// What one material did since the start, in quanta and in cubic metres.
struct MaterialBalance {
  long long initial = 0, final = 0, in = 0, out = 0;  ///< [quanta]
  double quantum_volume = 0;                          ///< [m³] of one quantum
  double base_volume = 0;                             ///< [m³] between elevation 0 and the datum; of bedrock
  /// final − initial − in + out, which must be 0 [quanta]
  long long residual() const { return final - initial - in + out; }
  double cubic_metres(long long quanta) const { return static_cast<double>(quanta) * quantum_volume; }
  double initial_m3() const { return base_volume + cubic_metres(initial); }
  double final_m3() const { return base_volume + cubic_metres(final); }
  double relative_residual() const;
};

/// How many plants of a species there are.
struct PlantCount {
  std::string species;
  int plants = 0, mature = 0;
};

/// What processes keep from step to step besides layers, by name (Process::flags, Process::counter): flags
/// that are set, and what was counted in all steps, but for what the device still counts.
using ProcessFlags = std::set<std::string>;
using ProcessCounts = std::map<std::string, std::uint64_t>;

/// Members are public: the parts of the simulation (pipeline, commands, views, checkpoint) all work on it.
/// Only the thread that owns the simulation may use it.
struct SimulationState {
  /// A terrain without material under the scenario, at step 0. Throws ConfigError if memory runs out.
  SimulationState(const Scenario& scenario, Terrain terrain);
  SimulationState(const SimulationState&) = delete;
  SimulationState& operator=(const SimulationState&) = delete;

  Exec& exec() const { return terrain.exec(); }
  /// Whether the layers that are held are those of the present time for which they are (run.hold_time).
  bool held_layers_known = false;
  bool has_held_layers() const;
  /// Whether a layer is in use and part of the state; what is held is, where steps to come need it.
  bool is_part(Layer layer) const {
    const Lifetime lifetime = info(layer).lifetime;
    const bool held =
        lifetime == Lifetime::held && held_layers_known && scenario.run.time_step < scenario.run.hold_time;
    return terrain.has(layer) && (lifetime == Lifetime::persistent || held);
  }

  /// Simulated time [s].
  double time() const {
    return clock_origin.time + static_cast<double>(steps - clock_origin.step) * scenario.run.time_step;
  }
  /// The time of a clock on which `run.acceleration` simulated seconds pass in a second [s]; where that is
  /// 0, as many as there are.
  double paced_time() const {
    const double acceleration = scenario.run.acceleration > 0 ? scenario.run.acceleration : 1.0;
    return clock_origin.paced_time + (time() - clock_origin.accelerated_at) / acceleration;
  }
  /// Lets both clocks go on from the times that they show, before `run` takes the place of scenario.run.
  /// `parts`: of a step until now; see Process::longest_step.
  void keep_time(const RunParameters& run, int parts);
  /// The high-altitude wind at a time [m/s]: of the regime, and of the gusts if there are any.
  wind::Vector wind_above_at(double when) const {
    const wind::Vector regime = wind_regime.at(when);
    return gusts ? gusts->around(regime, when) : regime;
  }
  wind::Vector wind_above() const { return wind_above_at(time()); }  ///< now
  LedgerView ledger() const { return {ledger_words.data()}; }
  /// The scenario with the wind regime that blows now, which commands may have replaced.
  Scenario present_scenario() const;
  /// Layers that are in use, derived ones included.
  std::vector<Layer> layers_in_use() const;

  /// Lets plants live by the scenario's species from now on; where there were none, there is room for them
  /// then. Throws ConfigError if memory runs out.
  void take_species();
  /// Lets another wind regime begin now; its first ramp starts from the present wind.
  void set_wind_regime(WindRegime regime);
  /// Replaces all plants; `words` are columns as plants::words() gives them. Throws ConfigError if there are
  /// more than there is room for.
  void set_plants(const std::vector<std::uint32_t>& words);

  /// Takes the material that the terrain holds now as what it began with, and the 1st percentile of its
  /// surface as the reference of the wind's speed-up.
  void begin_balance();
  /// What is booked in and out of each material [quanta]: [2 · material] in, [2 · material + 1] out.
  std::vector<long long> read_ledger() const;
  void write_ledger(const std::vector<long long>& accounts);
  std::array<MaterialBalance, material_count> balance() const;
  /// Plants by species, in the order of the scenario; none where vegetation is off.
  std::vector<PlantCount> plant_counts() const;
  /// XXH3-64 over the persistent layers, the plants, the clock and the accounts.
  std::uint64_t hash() const;

  Scenario start;     ///< the scenario that it began with: what a reset goes back to
  Scenario scenario;  ///< `start`, as commands have changed it
  Terrain terrain;
  plants::Workspace plants;  ///< empty where vegetation is off
  WindRegime wind_regime;
  RippleWind ripple_wind;      ///< follows from the winds so far; no step depends on it
  std::optional<Gusts> gusts;  ///< of a member of an ensemble; a checkpoint does not have them
  std::uint64_t steps = 0;
  ClockOrigin clock_origin;
  Quanta wind_reference = 0;  ///< 1st percentile of the solid surface at load
  double timeline_time = -1;  ///< what scenario.timeline has until then has happened [s]
  std::vector<Ramp> ramps;    ///< parameters that are changing
  ProcessFlags flags;
  ProcessCounts counts;
  std::array<long long, material_count> initial{};  ///< material at the start [quanta]
  Buffer<long long> ledger_words;                   ///< LedgerView's accounts, on the device

 private:
  long long material_now(Material material) const;
};

}  // namespace desert_sim

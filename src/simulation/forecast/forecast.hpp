#pragma once
/// Forecasts: what a terrain will be like, by a run ahead on a copy. As long as nothing but the forecast's
/// own commands happens to the simulation that was copied, it comes to the same states, to the bit.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "src/scenario/gusts.hpp"
#include "src/simulation/commands/command.hpp"
#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct ForecastParameters {
  double horizon = 60;
  int moments = 6;
  int members = 1;
  int stride = 1;
};
constexpr auto parameter_table(const ForecastParameters*) {
  using P = ForecastParameters;
  return std::make_tuple(
      parameter("horizon", &P::horizon, 1e-6, 1e12, "s", "How far ahead, in ROS time."),
      parameter("moments", &P::moments, 1, 100, "1",
                "States to tell, evenly spaced, the last at the horizon."),
      parameter("members", &P::members, 1, 64, "1", "Runs, of which all but the first have gusts."),
      parameter(
          "stride", &P::stride, 1, 1000, "1",
          "Steps of the live run that one step stands for: 1 gives its states to the bit, more is as much "
          "faster, with a time step as much longer."));
}
static_assert(table_is_complete<ForecastParameters>());

/// What a forecast may change at its start.
using ForecastCommand = std::variant<command::SetParameters, command::SetWind, command::SetWindSchedule>;

struct ForecastOptions : ForecastParameters {
  static constexpr std::uint64_t most_steps = 1000000;  ///< of a member
  /// Of the live run while its run.acceleration is 0 [steps/s]; 0: none, and a second of the forecast is a
  /// second of the desert's own time then.
  double step_rate = 0;
  std::vector<ForecastCommand> commands;  ///< applied in this order before the first step
  GustParameters gusts;
};

/// A state. Maps are row-major from the south-west.
struct ForecastMoment {
  double time = 0;  ///< after the start [s of ROS time]
  std::uint64_t step = 0, hash = 0;
  double sim_time = 0;             ///< [s]
  std::vector<float> elevation;    ///< [m]
  std::vector<std::int8_t> costs;  ///< as kernels/view/cell_cost.hpp has them
  std::vector<float> probability;  ///< share of the members in which a cell is passable; empty with one
};

/// What a forecast tells.
struct ForecastMaps {
  std::uint64_t step = 0;             ///< that it starts from
  double sim_time = 0;                ///< of that step [s]
  double seconds_per_sim_second = 0;  ///< of ROS time, at the start
  int members = 1;
  int width = 0, height = 0;
  double cell_size = 0, origin_x = 0, origin_y = 0;  ///< [m]
  std::vector<ForecastMoment> moments;               ///< of the first member
  std::vector<float> passable_until, passable_from;  ///< of the first member, see Passability [s]
};

class ForecastRun {
 public:
  /// Is told before each step which member runs, and how far it is [s of ROS time]; false ends the run.
  using Progress = std::function<bool(int member, double time)>;

  /// Makes the copy from checkpoint_bytes(), and applies the commands. The caller's thread does all work; the
  /// threads of the CPU backend (`threads`, 0: one a processor) inherit its priority. Throws ConfigError if
  /// the options or a command are refused, or if memory is short.
  ForecastRun(std::string checkpoint, const ForecastOptions& options, const std::string& backend,
              int threads);

  /// None if `progress` ended it. Throws ConfigError after ForecastOptions::most_steps. Call it once.
  std::optional<ForecastMaps> run(const Progress& progress);

  /// Of the forecast's own steps [1/s]; 0 as in ForecastOptions.
  double step_rate() const { return options_.step_rate / options_.stride; }

 private:
  /// What is looked at when a moment is reached.
  using Visit = std::function<void(std::size_t moment, double time)>;
  std::unique_ptr<Simulation> member(int number) const;
  void lengthen_steps(Simulation& simulation) const;
  void require_steps() const;
  bool step_to_horizon(int number, const Progress& progress, const Visit& visit);
  std::vector<float> elevation();
  const std::vector<std::int8_t>& costs();

  const ForecastOptions options_;
  std::string checkpoint_;  ///< kept for members to come
  std::unique_ptr<Exec> exec_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<std::int8_t> costs_;  ///< of the last query
};

/// What a forecast of the simulation takes [bytes]: a second terrain, its checkpoint, and all maps, as they
/// are made and twice on their way to others.
struct ForecastMemory {
  double on_device = 0, on_host = 0;
};
ForecastMemory memory_for_forecast(const Simulation& simulation, const ForecastParameters& options);
/// Throws ConfigError, with what is needed and what there is, if that is not there.
void require_memory_for_forecast(const Simulation& simulation, const ForecastParameters& options);

}  // namespace desert_sim

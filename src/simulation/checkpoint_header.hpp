#pragma once
/// The header of a checkpoint: all of the state but the words of layers and plants.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "src/simulation/simulation.hpp"

namespace desert_sim {

struct CheckpointNumbers {
  std::uint64_t steps = 0;
  double datum = 0;
  int exponent = HeightScale::finest;
  Quanta wind_reference = 0;
  std::uint64_t plants = 0;
};
constexpr auto parameter_table(const CheckpointNumbers*) {
  using P = CheckpointNumbers;
  return std::make_tuple(
      parameter("steps", &P::steps, 0, static_cast<double>(max_simulation_steps), "1", "Steps done."),
      parameter("datum", &P::datum, -any_height, 2 * any_height, "m", "Datum of the elevations."),
      parameter("exponent", &P::exponent, HeightScale::finest, HeightScale::coarsest, "1",
                "Of 2, which gives the quantum in metres."),
      parameter("wind_reference", &P::wind_reference, -wall_height, wall_height, "quanta",
                "Lowest surface at the start."),
      parameter("plants", &P::plants, 0, 2147483647, "1", "Number of plants."));
}
static_assert(table_is_complete<CheckpointNumbers>());

struct CheckpointHeader {
  Scenario start, scenario;
  CheckpointNumbers numbers;
  double timeline_time = -1;  ///< what run.timeline has until then has happened [s]
  ProcessFlags flags;
  ProcessCounts counts;
  ClockOrigin clock;
  std::vector<Ramp> ramps;
  std::array<long long, material_count> initial{};
  std::vector<long long> ledger;  ///< as of SimulationState::read_ledger()
  WindRegime wind;
  std::optional<RippleWind> ripple_wind;  ///< checkpoints of older versions lack it
  std::vector<Layer> layers;              ///< persistent ones, in the order of the table

  /// Simulated time [s].
  double time() const {
    return clock.time + static_cast<double>(numbers.steps - clock.step) * scenario.run.time_step;
  }
  HeightScale scale() const { return {numbers.datum, numbers.exponent}; }
};

CheckpointHeader header_of(const Simulation& simulation);
std::string header_text(const CheckpointHeader& header);
/// Throws ConfigError that lists the fields which are missing or wrong, each with its value and range. What a
/// simulation could not have saved is wrong; `path` names the file in messages.
CheckpointHeader read_header(const std::string& text, const std::string& path);

}  // namespace desert_sim

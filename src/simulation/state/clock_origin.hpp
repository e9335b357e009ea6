#pragma once
/// What the clock of a simulation counts from. It counts steps, each of `run.time_step` seconds, and where
/// that has changed while the simulation ran, it goes on from the time that it showed then.

#include <cstdint>

#include "src/core/parameter_table.hpp"

namespace desert_sim {

/// All 0 until run.time_step or run.acceleration changes.
struct ClockOrigin {
  std::uint64_t step = 0, tick = 0;
  double time = 0;
  double accelerated_at = 0, paced_time = 0;
  bool operator==(const ClockOrigin& o) const {
    return step == o.step && tick == o.tick && time == o.time && accelerated_at == o.accelerated_at &&
           paced_time == o.paced_time;
  }
};
constexpr auto parameter_table(const ClockOrigin*) {
  using P = ClockOrigin;
  constexpr double most_parts = 256;  // of a step
  return std::make_tuple(
      parameter("step", &P::step, 0, 0x1p53, "1", "Steps done when run.time_step last changed."),
      parameter("tick", &P::tick, 0, most_parts * 0x1p53, "1", "Steps, or parts of steps, done by then."),
      parameter("time", &P::time, 0, 1e30, "s", "Simulated time then."),
      parameter("accelerated_at", &P::accelerated_at, 0, 1e30, "s",
                "Simulated time when run.acceleration last changed."),
      parameter("paced_time", &P::paced_time, 0, 1e36, "s", "SimulationState::paced_time() then."));
}
static_assert(table_is_complete<ClockOrigin>());

}  // namespace desert_sim

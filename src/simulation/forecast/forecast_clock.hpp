#pragma once
/// The clock of ROS beside a run ahead: when the live run will have made its steps.

#include <cstdint>

#include "src/scenario/scenario.hpp"

namespace desert_sim {

class ForecastClock {
 public:
  /// `step_rate` as in ForecastOptions.
  explicit ForecastClock(double step_rate) : step_rate_(step_rate) {}

  /// From one step to the next under these parameters [s].
  double interval(const RunParameters& run) const {
    if (run.acceleration > 0) return run.time_step / static_cast<double>(run.acceleration);
    return step_rate_ > 0 ? 1 / step_rate_ : run.time_step;
  }
  double time() const { return changed_at_ + static_cast<double>(steps_) * interval_; }  ///< [s]
  /// The time at which the next step is due; rounding counts as nothing.
  bool due(const RunParameters& run, double at) const {
    constexpr double rounding = 1e-6;  // of an interval
    return time() + interval(run) * (1 - rounding) <= at;
  }
  /// A step is made. The parameters are those of before.
  void step(const RunParameters& run) {
    const double next = interval(run);
    if (next != interval_) {
      changed_at_ = time();
      steps_ = 0;
      interval_ = next;
    }
    ++steps_;
  }

 private:
  double step_rate_, changed_at_ = 0, interval_ = 0;
  std::uint64_t steps_ = 0;  ///< since the interval changed, which adds up without rounding
};

}  // namespace desert_sim

#pragma once
/// The clock by which schedules, pauses and watchdogs go: it runs evenly and never jumps. What needs one
/// takes it from outside, so that tests can give one that they move.

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace desert_sim {

class MonotonicClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  using Duration = std::chrono::steady_clock::duration;

  virtual ~MonotonicClock() = default;
  virtual TimePoint now() const = 0;
  /// Waits until `condition` is notified, at most until `time` of this clock. May return earlier. `lock`
  /// holds the mutex of the condition.
  virtual void wait_until(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
                          TimePoint time) const = 0;
  /// now() as a number [s].
  double seconds() const { return std::chrono::duration<double>(now().time_since_epoch()).count(); }
};

/// The computer's.
const MonotonicClock& computer_clock();

}  // namespace desert_sim

#pragma once
/// A clock that stands still until a test moves it.

#include <atomic>

#include "src/core/monotonic_clock.hpp"

namespace desert_sim::test {

class ManualClock : public MonotonicClock {
 public:
  TimePoint now() const override { return TimePoint(Duration(now_)); }
  /// Moves the clock by so many seconds, at least 0.
  void advance(double seconds) {
    now_ += std::chrono::duration_cast<Duration>(std::chrono::duration<double>(seconds)).count();
  }
  /// Who waits looks again and again whether the clock has been moved.
  void wait_until(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
                  TimePoint time) const override {
    if (now() < time) condition.wait_for(lock, std::chrono::milliseconds(1));
  }

 private:
  std::atomic<Duration::rep> now_{Duration(std::chrono::hours(1)).count()};
};

}  // namespace desert_sim::test

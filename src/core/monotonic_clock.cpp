#include "src/core/monotonic_clock.hpp"

namespace desert_sim {

namespace {

class ComputerClock : public MonotonicClock {
 public:
  TimePoint now() const override { return std::chrono::steady_clock::now(); }
  void wait_until(std::condition_variable& condition, std::unique_lock<std::mutex>& lock,
                  TimePoint time) const override {
    condition.wait_until(lock, time);
  }
};

}  // namespace

const MonotonicClock& computer_clock() {
  static const ComputerClock clock;
  return clock;
}

}  // namespace desert_sim

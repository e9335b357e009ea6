#pragma once
/// When a topic is published that shows a state which changes in steps: at a rate, and right after a step.
///
/// Due times lie a period apart. A change in the last half of a period is shown at once instead of waiting
/// for the due time; the due times stay, so that on average there is no more than one message a period, and
/// two are at least half a period apart. A change that came before that waits for the due time. If the next
/// one does so, too, the due times move to where changes come: steps at the same rate do not wait for ever.

#include <chrono>

namespace desert_sim {

class DueTime {
 public:
  using Clock = std::chrono::steady_clock;

  /// The due time by the rate alone.
  Clock::time_point time() const { return due_; }
  /// From when on a change is shown at once.
  Clock::time_point earliest(Clock::duration period) const { return due_ - period / 2; }
  /// Whether a change at `change`, which has not been shown, is to be shown at `now`.
  bool reached(Clock::time_point now, Clock::time_point change, Clock::duration period) const {
    return now >= due_ || change >= earliest(period);
  }
  /// The next due time after a message at `now` that showed the change at `change`. A message long before
  /// the due time, for a new subscriber, does not put it off: many of them would put it off for long.
  void published(Clock::time_point now, Clock::time_point change, Clock::duration period) {
    if (now < earliest(period)) return;
    const bool waits = change < earliest(period) && now >= due_;
    const bool again = waits && waited_;
    waited_ = waits && !again;
    due_ += period;
    if (due_ <= now) due_ = now + period;
    if (!again || period <= Clock::duration::zero()) return;
    const auto periods = (now + period / 2 - change + period - Clock::duration(1)) / period;
    due_ = change + periods * period;
  }
  /// The next one is due a period from now at the latest.
  void period_changed(Clock::time_point now, Clock::duration period) {
    if (now + period < due_) due_ = now + period;
  }

 private:
  Clock::time_point due_;
  bool waited_ = false;  ///< whether the last change had to
};

}  // namespace desert_sim

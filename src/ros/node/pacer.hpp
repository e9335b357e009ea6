#pragma once
/// When the next step is due, and how fast steps come.

#include <cstdint>
#include <deque>

namespace desert_sim {

/// Seconds of a clock that never jumps.
double steady_now();

/// Keeps a rate of steps on a clock that may be slow, stand still, or jump. Times are that clock's seconds.
/// A backlog of up to `backlog` seconds is caught up; what goes beyond it is given up and only shows in
/// lag().
class Pacer {
 public:
  static constexpr double backlog = 1.0;

  /// `rate` in steps per second; 0: a step is always due.
  explicit Pacer(double rate) : rate_(rate) {}
  double rate() const { return rate_; }

  /// The schedule begins anew at the next due(), with no lag: after a pause, a reset, a jump.
  void restart() { running_ = false; }
  /// What is behind the schedule at time `now` need not be done, and is no lag.
  void forgive(double now);
  /// Whether a step is due at time `now`. A clock that went back restarts the schedule (see jumped_back()).
  bool due(double now);
  /// A step that was due has been done.
  void stepped();
  /// Time until the next step is due [s]; 0 if it is.
  double until_due(double now) const;
  /// How far the steps are behind the schedule since it began [s], time given up included.
  double lag(double now) const;
  /// Whether the clock went back since the last call.
  bool jumped_back();

 private:
  double due_time() const;
  double rate_;
  bool running_ = false, jumped_back_ = false;
  double start_ = 0, last_ = 0, given_up_ = 0;
  std::uint64_t done_ = 0;
};

/// Steps per second over the last two seconds; over the last two steps if they are slower.
class RateMeter {
 public:
  /// A step was done at `now` [s, any steady clock].
  void count(double now);
  double rate(double now) const;
  void clear() { marks_.clear(); }

 private:
  struct Mark {
    double time;
    std::uint64_t steps;
  };
  std::deque<Mark> marks_;
  std::uint64_t steps_ = 0;
};

}  // namespace desert_sim

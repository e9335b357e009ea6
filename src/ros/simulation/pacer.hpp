#pragma once
/// The schedule of steps (Pacer), and the measured rate of steps or messages (RateMeter).

#include <cstdint>
#include <deque>

namespace desert_sim {

/// Keeps a rate of steps on a clock that may be slow, stand still, or jump. Times are seconds of that clock.
/// If steps are late, up to `backlog` seconds are caught up; what exceeds them is given up, and only shows in
/// lag().
class Pacer {
 public:
  static constexpr double backlog = 1.0;

  /// `rate` in steps per second; 0: a step is always due.
  explicit Pacer(double rate) : rate_(rate) {}
  double rate() const { return rate_; }

  /// The schedule starts again at the next due(), without lag: after a pause, a reset, or a jump of the
  /// clock.
  void restart() { running_ = false; }
  /// Steps that are late at time `now` need not be caught up, and do not count as lag.
  void drop_backlog(double now);
  /// Whether a step is due at time `now`. A clock that went back restarts the schedule (see jumped_back()).
  bool due(double now);
  /// A step that was due has been done. From the time at which it was due the rate is `rate`.
  void stepped(double rate);
  void stepped() { stepped(rate_); }
  /// From time `now` on the rate is another: of the time to the next step the share that is left stays the
  /// same, and steps that are late need not be caught up.
  void change_rate(double rate, double now);
  /// Time until the next step is due [s]; 0 if it is.
  double until_due(double now) const;
  /// How far the steps are behind the schedule since it started [s], including the time that was given up.
  double lag(double now) const;
  /// Whether the clock went back since the last call.
  bool jumped_back();

 private:
  double due_time() const;
  void begin(double rate, double first_due);
  double rate_;
  bool running_ = false, jumped_back_ = false;
  double start_ = 0, last_ = 0, dropped_time_ = 0;
  std::uint64_t done_ = 0;
};

/// Measures steps per second over the last two seconds, or over the last two steps if they took longer.
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

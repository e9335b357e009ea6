// When topics are published, by a clock of the test's own.

#include "src/ros/topics/due_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace desert_sim {
namespace {

using Clock = DueTime::Clock;
using std::chrono::milliseconds;
constexpr milliseconds period(100);

struct Shown {
  std::vector<int> times, waits;  ///< of messages, and from the change to its message [ms]
};

/// Steps every `step` from `first` on, and a publisher that looks each millisecond, for ten seconds.
Shown run(milliseconds step, milliseconds first) {
  const Clock::time_point start = Clock::time_point() + std::chrono::hours(1);
  DueTime due;
  Shown shown;
  bool unshown = false;
  Clock::time_point change = start;
  for (milliseconds t(0); t < std::chrono::seconds(10); t += milliseconds(1)) {
    const Clock::time_point now = start + t;
    if (t >= first && (t - first) % step == milliseconds(0)) {
      change = now;
      unshown = true;
    }
    if (!unshown || !due.reached(now, change, period)) continue;
    shown.times.push_back(static_cast<int>(t.count()));
    shown.waits.push_back(static_cast<int>((now - change) / milliseconds(1)));
    due.published(now, change, period);
    unshown = false;
  }
  return shown;
}

int smallest_gap(const std::vector<int>& times) {
  int gap = times[1] - times[0];
  for (std::size_t i = 2; i < times.size(); ++i) gap = std::min(gap, times[i] - times[i - 1]);
  return gap;
}

TEST(DueTime, StepsAtTheRateOfMessagesDoNotWait) {
  for (int first = 0; first < 100; first += 7) {
    const Shown shown = run(milliseconds(100), milliseconds(first));
    EXPECT_GE(shown.times.size(), 97u) << first;
    for (std::size_t i = 3; i < shown.waits.size(); ++i) ASSERT_EQ(shown.waits[i], 0) << first << ", " << i;
  }
}

TEST(DueTime, SlowStepsDoNotWaitAtAll) {
  for (int step : {130, 250, 1000}) {
    const Shown shown = run(milliseconds(step), milliseconds(20));
    EXPECT_EQ(*std::max_element(shown.waits.begin(), shown.waits.end()), 0) << step;
    EXPECT_EQ(shown.times.size(), static_cast<std::size_t>((10000 - 20 + step - 1) / step)) << step;
  }
}

TEST(DueTime, FastStepsAreShownAtTheRate) {
  for (int step : {1, 10, 33, 50, 70}) {
    const Shown shown = run(milliseconds(step), milliseconds(5));
    EXPECT_GE(shown.times.size(), 90u) << step;
    EXPECT_LE(shown.times.size(), 101u) << step << ": not more than one a period";
    EXPECT_GE(smallest_gap(shown.times), 50) << step << ": half a period between two";
    double sum = 0;
    for (int wait : shown.waits) sum += wait;
    EXPECT_LT(sum / static_cast<double>(shown.waits.size()), 0.25 * step + 1) << step;
  }
}

TEST(DueTime, AMessageLongBeforeItDoesNotPutTheNextOneOff) {
  const Clock::time_point start = Clock::time_point() + std::chrono::hours(1);
  DueTime due;
  due.published(start, start, period);
  const Clock::time_point next = due.time();
  for (int n = 1; n < 50; n += 7) {
    due.published(start + milliseconds(n), start, period);
    EXPECT_EQ(due.time(), next) << n;
  }
}

TEST(DueTime, AShorterPeriodHoldsAtOnce) {
  const Clock::time_point start = Clock::time_point() + std::chrono::hours(1);
  DueTime due;
  due.published(start, start, std::chrono::seconds(100));
  due.period_changed(start, period);
  EXPECT_EQ(due.time(), start + period);
  due.period_changed(start, std::chrono::seconds(5));
  EXPECT_EQ(due.time(), start + period) << "a longer one from the next message on";
}

}  // namespace
}  // namespace desert_sim

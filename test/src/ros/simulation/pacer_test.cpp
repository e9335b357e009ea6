// The schedule of steps on made-up clocks: even, exact through changes of the rate, and told where it is
// late.

#include "src/ros/simulation/pacer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace desert_sim {
namespace {

TEST(Pacer, KeepsItsRate) {
  Pacer pacer(10);
  int steps = 0;
  for (double now = 100; now < 110; now += 0.013)
    if (pacer.due(now)) pacer.stepped(), ++steps;
  EXPECT_NEAR(steps, 100, 1);
  EXPECT_LT(pacer.lag(110), 0.1);
}

TEST(Pacer, CatchesUpWhatIsShortAndGivesUpWhatIsLong) {
  Pacer pacer(10);
  ASSERT_TRUE(pacer.due(0));
  pacer.stepped();
  int caught_up = 0;
  for (; pacer.due(0.55); ++caught_up) pacer.stepped();
  EXPECT_EQ(caught_up, 5);
  int after_long = 0;
  for (; pacer.due(60); ++after_long) pacer.stepped();
  EXPECT_LE(after_long, 11) << "a second's worth";
  EXPECT_NEAR(pacer.lag(60), 58.4, 0.2);
  pacer.restart();
  EXPECT_TRUE(pacer.due(61));
  EXPECT_EQ(pacer.lag(61), 0);
}

TEST(Pacer, ForgivesWhatIsBehindAndKeepsWhatIsAhead) {
  Pacer pacer(10);
  ASSERT_TRUE(pacer.due(0));
  pacer.stepped();
  pacer.drop_backlog(0.05);
  EXPECT_FALSE(pacer.due(0.09));
  EXPECT_TRUE(pacer.due(0.1));
  pacer.drop_backlog(50);
  EXPECT_TRUE(pacer.due(50));
  pacer.stepped();
  EXPECT_FALSE(pacer.due(50.05));
  EXPECT_EQ(pacer.lag(50.05), 0);
}

TEST(Pacer, SurvivesAClockThatJumpsBack) {
  Pacer pacer(10);
  ASSERT_TRUE(pacer.due(1000));
  pacer.stepped();
  ASSERT_TRUE(pacer.due(5));
  EXPECT_TRUE(pacer.jumped_back());
  EXPECT_FALSE(pacer.jumped_back()) << "told once";
  pacer.stepped();
  EXPECT_FALSE(pacer.due(5.05));
  EXPECT_TRUE(pacer.due(5.1));
}

TEST(Pacer, AsFastAsItCanIsAlwaysDue) {
  Pacer pacer(0);
  EXPECT_TRUE(pacer.due(0));
  pacer.stepped();
  EXPECT_TRUE(pacer.due(0));
  EXPECT_EQ(pacer.lag(100), 0);
}

TEST(RateMeter, MeasuresAndForgets) {
  RateMeter meter;
  double now = 0;
  for (; now < 5; now += 0.001) meter.count(now);
  EXPECT_NEAR(meter.rate(now), 1000, 10);
  for (; now < 10; now += 0.5) meter.count(now);
  EXPECT_NEAR(meter.rate(now), 2, 0.2);
  EXPECT_LT(meter.rate(now + 60), 0.2) << "no steps any more";
}

/// The times at which a clock that ticks every `tick` seconds finds steps due, in [from, to).
std::vector<double> steps_of(Pacer& pacer, double from, double to, double tick) {
  std::vector<double> times;
  for (int n = 0; from + n * tick < to; ++n)
    for (const double now = from + n * tick; pacer.due(now); pacer.stepped()) times.push_back(now);
  return times;
}

TEST(Pacer, StepsAreEvenlySpaced) {
  Pacer pacer(20);
  const std::vector<double> times = steps_of(pacer, 1.7e9, 1.7e9 + 60, 0.001);
  EXPECT_EQ(times.size(), 1200u);
  for (std::size_t n = 1; n < times.size(); ++n) EXPECT_NEAR(times[n] - times[n - 1], 0.05, 0.0011) << n;
}

TEST(Pacer, ACoarseClockGetsTheStepsOfEachTick) {
  Pacer pacer(160);
  const std::vector<double> times = steps_of(pacer, 100, 110, 0.125);
  EXPECT_EQ(times.size(), 1 + 160 * 9.875) << "the first one at once";
  for (int n = 1; n < 80; ++n) EXPECT_EQ(std::count(times.begin(), times.end(), 100 + 0.125 * n), 20) << n;
}

TEST(Pacer, AChangeScalesWhatIsLeftOfTheInterval) {
  Pacer pacer(1);
  ASSERT_TRUE(pacer.due(10));
  pacer.stepped();
  pacer.change_rate(4, 10.5);  // half of a second is left: half of a quarter
  EXPECT_EQ(pacer.rate(), 4);
  EXPECT_FALSE(pacer.due(10.62));
  EXPECT_TRUE(pacer.due(10.625));
  pacer.stepped();
  EXPECT_FALSE(pacer.due(10.874));
  EXPECT_TRUE(pacer.due(10.875));
  pacer.stepped();
  pacer.change_rate(4, 10.9);
  EXPECT_DOUBLE_EQ(pacer.until_due(11), 0.125) << "none, where it is the same rate";
}

TEST(Pacer, NoChangeBringsABurst) {
  Pacer pacer(0.5);
  ASSERT_TRUE(pacer.due(0));
  pacer.stepped();
  pacer.change_rate(1000, 1.9);
  EXPECT_LE(steps_of(pacer, 1.9, 1.95, 0.001).size(), 51u);
  pacer.change_rate(0.5, 1.95);
  EXPECT_LE(steps_of(pacer, 1.95, 4, 0.001).size(), 2u);
}

TEST(Pacer, AChangeForgivesWhatIsLate) {
  Pacer pacer(100);
  ASSERT_TRUE(pacer.due(0));
  pacer.stepped();
  ASSERT_TRUE(pacer.due(5));
  EXPECT_GT(pacer.lag(5), 4);
  pacer.change_rate(10, 5);
  EXPECT_EQ(pacer.lag(5), 0);
  EXPECT_TRUE(pacer.due(5));
  pacer.stepped();
  EXPECT_FALSE(pacer.due(5.05));
}

/// As under a ramp of run.acceleration: each step has a rate of its own, and counts with 1 / rate.
TEST(Pacer, AStepThatChangesTheRateKeepsTheScheduleAndTheLag) {
  Pacer pacer(10);
  double due = 100;
  ASSERT_TRUE(pacer.due(due));
  for (int n = 0; n < 50; ++n) {
    const double rate = 10 + n;
    pacer.stepped(rate);
    due += 1 / rate;
    EXPECT_FALSE(pacer.due(due - 1e-6)) << n;
    EXPECT_TRUE(pacer.due(due + 1e-6)) << n;
  }
  ASSERT_TRUE(pacer.due(due + 11));
  const double lag = pacer.lag(due + 11);
  EXPECT_GT(lag, 9);
  pacer.stepped(20);
  EXPECT_NEAR(pacer.lag(due + 11), lag - 1.0 / 20, 0.03) << "told all the same";
}

TEST(Pacer, ChangesFromAndToAsFastAsItCan) {
  Pacer pacer(10);
  ASSERT_TRUE(pacer.due(1));
  pacer.stepped();
  pacer.change_rate(0, 1.01);
  EXPECT_TRUE(pacer.due(1.01));
  pacer.stepped();
  EXPECT_TRUE(pacer.due(1.01));
  EXPECT_EQ(pacer.lag(9), 0);
  pacer.change_rate(10, 9);
  EXPECT_TRUE(pacer.due(9));
  pacer.stepped();
  EXPECT_FALSE(pacer.due(9.05));
  EXPECT_TRUE(pacer.due(9.1));
  pacer.stepped(0);
  EXPECT_TRUE(pacer.due(9.1));
}

}  // namespace
}  // namespace desert_sim

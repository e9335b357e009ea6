// When a planner asks for forecasts: one at a time, and coarser ones where they come late.

#include "src/planner/forecast_schedule.hpp"

#include <gtest/gtest.h>

namespace desert_sim {
namespace {

TEST(ForecastSchedule, AsksOncePerPeriod) {
  ForecastSchedule s(30, 3);
  EXPECT_TRUE(s.due(100));
  s.ask(100);
  s.end(110, true);
  EXPECT_FALSE(s.due(129.9));
  EXPECT_TRUE(s.due(130));
  EXPECT_TRUE(s.due(5)) << "a clock that was set back";
}

TEST(ForecastSchedule, NeverAsksForAnotherOneBeforeTheFirstIsThere) {
  ForecastSchedule s(30, 3);
  s.ask(100);
  EXPECT_TRUE(s.under_way());
  EXPECT_FALSE(s.due(1e6));
  s.end(1e6, true);
  EXPECT_FALSE(s.under_way());
  EXPECT_TRUE(s.due(1e6));
}

TEST(ForecastSchedule, ANewGoalDoesNotWaitForThePeriodButForTheForecastThatIsUnderWay) {
  ForecastSchedule s(30, 3);
  s.ask(100);
  s.hurry();
  EXPECT_FALSE(s.due(101));
  s.end(131, true);
  EXPECT_EQ(s.stride(), 6) << "late is late";
  EXPECT_TRUE(s.due(131));
  s.ask(131);
  s.end(132, true);
  EXPECT_FALSE(s.due(133));
  s.hurry();
  EXPECT_TRUE(s.due(133));
}

TEST(ForecastSchedule, LateOnesMakeTheNextCoarserAndQuickOnesFinerAgain) {
  ForecastSchedule s(30, 3);
  double time = 0;
  const auto takes = [&](double seconds) {
    s.ask(time);
    s.end(time += seconds, true);
    return s.stride();
  };
  EXPECT_EQ(takes(31), 6);
  EXPECT_EQ(takes(20), 6) << "in time, but none to spare";
  EXPECT_EQ(takes(40), 12);
  EXPECT_EQ(takes(5), 6);
  EXPECT_EQ(takes(5), 3);
  EXPECT_EQ(takes(5), 3) << "no finer than it is wanted";
  for (int n = 0; n < 10; ++n) takes(100);
  EXPECT_EQ(s.stride(), 48) << "16 times the one that is wanted";
}

TEST(ForecastSchedule, OfOneThatIsRefusedNothingIsLearnt) {
  ForecastSchedule s(30, 3);
  s.ask(0);
  s.end(100, false);
  EXPECT_EQ(s.stride(), 3);
  EXPECT_TRUE(s.due(100));
}

TEST(ForecastSchedule, WhereTheTimeWaitsForForecastsTheyAreNeverLate) {
  ForecastSchedule s(1, 2);
  for (double time = 0; time < 10; time += 1) {
    ASSERT_TRUE(s.due(time));
    s.ask(time);
    s.end(time, true);
  }
  EXPECT_EQ(s.stride(), 2);
}

TEST(ForecastSchedule, StridesAreThoseThatTheTerrainTakes) {
  ForecastSchedule s(1, 900);
  s.ask(0);
  s.end(2, true);
  EXPECT_EQ(s.stride(), ForecastSchedule::longest_stride);
}

}  // namespace
}  // namespace desert_sim

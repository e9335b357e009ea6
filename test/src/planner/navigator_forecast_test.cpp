// Navigating through forecasts: waiting, taking shelter, and what another forecast changes.
#include <algorithm>
#include <cmath>

#include "src/core/error.hpp"
#include "test/src/planner/navigating.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

using test::frame;
using NavigatingByForecast = test::Navigating;

TEST_F(NavigatingByForecast, PlansThroughTheForecast) {
  parameters_.planner = PlannerKind::forecast;
  Navigator patient(parameters_);
  const auto wall = [](int x, int) { return x >= 40 && x < 44 ? 0.0F : 1.0F; };
  patient.update(frame, {0, 0, frame.width, frame.height}, test::values_of(frame, wall).data());
  ForecastCosts forecast{0, {100, 200}, {test::values_of(frame, wall), test::values_of(frame, free_)}, frame};
  patient.set_forecast(forecast);
  patient.set_goal({35, 5, 0}, 0);
  bool waited = false;
  double t = 0;
  for (; t < 600 && patient.active(); t += 0.1) {
    if (t > 199.9 && t < 200.05)
      patient.update(frame, {0, 0, frame.width, frame.height}, test::values_of(frame, free_).data());
    rover_.drive(patient.act(t, rover_.pose, RoverCondition::driving, ""), 0.1);
    waited = waited || (t > 90 && t < 190 && patient.status().state == NavigatorState::waiting);
    const std::vector<TimedPoint> schedule = patient.schedule();
    const GridPath ahead = patient.path();
    ASSERT_TRUE(schedule.empty() || schedule.size() == ahead.size()) << t;
    for (std::size_t n = 0; n + 1 < schedule.size(); ++n) {
      ASSERT_NEAR(schedule[n].point.x, ahead[n].x, 1e-9) << t;
      ASSERT_LE(schedule[n].arrival, schedule[n + 1].arrival) << t;
    }
    ASSERT_TRUE(t >= 200 || rover_.pose.x < 20) << t;
  }
  EXPECT_EQ(patient.status().state, NavigatorState::arrived) << patient.status().reason;
  EXPECT_TRUE(waited);
  EXPECT_GT(t, 200);
  forecast.frame.width = 5;
  EXPECT_THROW(patient.set_forecast(forecast), ConfigError);
}

/// A rover in a channel, the south of the ground, down which a flood comes. A rock on its bank leaves a
/// narrow way in the north.
class BeforeAFlood : public test::Navigating {
 protected:
  BeforeAFlood() : Navigating(with_forecasts()) { ground(rock); }
  static PlannerParameters with_forecasts() {
    PlannerParameters p;
    p.planner = PlannerKind::forecast;
    p.speed = p.forecast_speed = 0.2;
    return p;
  }
  static float rock(int x, int y) { return x > 44 && x < 54 && y >= 30 && y < 54 ? 0.0F : 1.0F; }
  static float flood(int x, int y) { return y < 30 ? 0.0F : rock(x, y); }
  static ForecastCosts forecast(double made, const std::vector<double>& times,
                                const test::Traversability& before = rock,
                                const test::Traversability& then = flood) {
    ForecastCosts told{made, times, {}, frame};
    for (const double t : times)
      told.traversability.push_back(test::values_of(frame, floods(made + t) ? then : before));
    return told;
  }
  static bool floods(double time) { return time >= 120 && time < 340; }
  static double northernmost(const Navigator& navigator) {
    double y = 0;
    for (const GridPoint& p : navigator.path()) y = std::max(y, p.y);
    return y;
  }
  bool stands_on(const test::Traversability& t) const {
    CostGrid grid(frame, parameters_.costs());
    test::fill(grid, t);
    return grid.cost(*grid.cell_at({rover_.pose.x, rover_.pose.y})) != CostGrid::lethal;
  }
};

/// Nothing in it says that there will be no flood.
TEST_F(BeforeAFlood, AForecastThatEndsBeforeItDoesNotUndoTheOneThatTellsOfIt) {
  go(35, 20);
  navigator_.set_forecast(forecast(time_, {20, 40, 60, 80, 100, 120, 140, 160, 180, 200}));
  run(1);
  ASSERT_GT(northernmost(navigator_), 27) << "it has no time to pass the rock in the channel";
  for (int n = 0; n < 10; ++n) {
    navigator_.set_forecast(forecast(time_, {10, 20}));
    run(4);
    EXPECT_EQ(status().replans, 0) << time_ << ": " << status().last_replan;
    EXPECT_GT(northernmost(navigator_), 27);
    if (n % 2 == 0) navigator_.set_forecast(forecast(time_, {20, 40, 60, 80, 100, 120, 140, 160, 180, 200}));
    run(4);
  }
  EXPECT_EQ(status().replans, 0) << status().last_replan;
}

TEST_F(BeforeAFlood, WhatAForecastTellsOfLaterTimesHoldsUntilItIsTooOld) {
  parameters_.forecast_age = 15;
  Navigator forgetful(parameters_);
  forgetful.update(frame, {0, 0, frame.width, frame.height}, test::values_of(frame, rock).data());
  const auto act = [&](double time) { forgetful.act(time, rover_.pose, RoverCondition::driving, ""); };
  forgetful.set_goal({35, 20, 0}, 0);
  forgetful.set_forecast(forecast(0, {80, 100, 120}));
  act(1);
  forgetful.set_forecast(forecast(10, {40}));
  act(10);
  EXPECT_EQ(forgetful.status().replans, 0) << forgetful.status().last_replan;
  forgetful.set_forecast(forecast(20, {40}));
  act(20);
  EXPECT_NE(forgetful.status().last_replan.find("earlier"), std::string::npos)
      << forgetful.status().last_replan;
  EXPECT_LT(northernmost(forgetful), 21);
  // The time is set back: what was told before was of another terrain.
  forgetful.set_forecast(forecast(20, {80, 100}));
  forgetful.set_goal({35, 20, 0}, 0);
  forgetful.set_forecast(forecast(5, {40}));
  act(5);
  EXPECT_LT(northernmost(forgetful), 21);
}

TEST_F(BeforeAFlood, WhereNoWayLeadsToTheGoalItWaitsWhereItCanStay) {
  const auto bank = [](int, int y) { return y < 30 ? 0.0F : 1.0F; };
  rover_.pose = {5, 10, 0};
  go(35.2, 5.2);  // in the channel, 32 m away
  while (time_ < 600 && navigator_.active()) {
    navigator_.set_forecast(forecast(time_, {20, 40, 60, 80, 100, 120, 140, 160, 180, 200}));
    for (int n = 0; n < 10; ++n) {
      const float far_off = n % 2 == 0 ? 0.3F : 1.0F;
      ground([&](int x, int y) {
        return x == 1 && y == 58 ? far_off : floods(time_) ? flood(x, y) : rock(x, y);
      });
      run(1);
    }
    ASSERT_TRUE(!floods(time_) || stands_on(bank))
        << time_ << " s: " << rover_.pose.x << ", " << rover_.pose.y;
    if (time_ > 130) continue;
    EXPECT_EQ(status().replans, 0) << status().last_replan;
    EXPECT_GT(navigator_.path().back().y, 15) << "on the bank";
  }
  EXPECT_EQ(status().state, NavigatorState::arrived) << status().reason;
  EXPECT_EQ(status().replans, 1);
  EXPECT_NE(status().last_replan.find("a way leads to the goal again"), std::string::npos)
      << status().last_replan;
  EXPECT_GT(time_, 340);
}

/// A goal behind a wall, and a flood that leaves an island.
TEST_F(BeforeAFlood, ItStaysInItsShelterAndGivesUpWhereNoWayLeadsToTheGoalNowEither) {
  const auto wall = [](int x, int) { return x == 8 ? 0.0F : 1.0F; };
  const auto island = [](int x, int y) { return x >= 20 && x < 25 && y >= 22 && y < 27 ? 1.0F : 0.0F; };
  ground(wall);
  rover_.pose = {6, 12, 0};
  go(2, 12);
  navigator_.set_forecast(forecast(time_, {20, 40, 60, 80, 100, 120}, wall, island));
  run(40);
  EXPECT_EQ(status().state, NavigatorState::waiting);
  EXPECT_NE(status().reason.find("no way leads"), std::string::npos) << status().reason;
  EXPECT_TRUE(stands_on(island)) << rover_.pose.x << ", " << rover_.pose.y;
  EXPECT_EQ(run(30), NavigatorState::waiting);
  EXPECT_EQ(run(40), NavigatorState::no_path);
  EXPECT_NE(status().reason.find("none with waiting"), std::string::npos) << status().reason;
  EXPECT_TRUE(stands_on(island));
}

TEST_F(NavigatingByForecast, RefusesForecastsWhoseTimesDoNotRise) {
  parameters_.planner = PlannerKind::forecast;
  Navigator navigator(parameters_);
  const std::vector<float> ground = test::values_of(frame, free_);
  navigator.update(frame, {0, 0, frame.width, frame.height}, ground.data());
  const auto refusal = [&](double made, double second) {
    return test::refusal([&] { navigator.set_forecast({made, {100, second}, {ground, ground}, frame}); });
  };
  EXPECT_NO_THROW(navigator.set_forecast({1e9, {100, 200}, {ground, ground}, frame}));
  EXPECT_NE(refusal(0, 100).find("moment 1 is at 100 s, the one before at 100 s"), std::string::npos);
  EXPECT_NE(refusal(0, NAN).find("moment 1 is at nan s"), std::string::npos);
  EXPECT_NE(refusal(INFINITY, 200).find("moment 0 is at inf s"), std::string::npos);
  // A double of that size has no hundreds.
  EXPECT_NE(refusal(1e38, 200).find("moment 1 is at 1e+38 s"), std::string::npos);
  navigator.set_goal({35, 5, 0}, 0);
  EXPECT_NO_THROW(navigator.act(1, {5, 5, 0}, RoverCondition::idle, ""));
}

}  // namespace
}  // namespace desert_sim

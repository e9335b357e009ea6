// Navigating through forecasts: waiting, and what is refused.
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

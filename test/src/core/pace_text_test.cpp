#include "src/core/pace_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace desert_sim {
namespace {

TEST(PaceText, SaysWhatASecondStandsFor) {
  EXPECT_EQ(pace_text(3600, 10, 360), "× 3600: an hour of wind in a second");
  EXPECT_EQ(pace_text(2400, 10, 240), "× 2400: 40 min of wind in a second");
  EXPECT_EQ(pace_text(100000, 10, 1e4), "× 100000: 1.16 d of wind in a second");
  EXPECT_EQ(pace_text(86400, 10, 8640), "× 86400: a day of wind in a second");
  EXPECT_EQ(pace_text(1.5, 10, 0.15), "× 1.5: 1.5 s of wind in a second");
}

TEST(PaceText, RealTimeAndSlower) {
  EXPECT_EQ(pace_text(1, 10, 0.1), "× 1: real time");
  EXPECT_EQ(pace_text(1.0001, 10, 0.1), "× 1: real time") << "as the number is shown";
  EXPECT_EQ(pace_text(0.03f, 10, 0.003f), "× 0.03: slower than real time, a second of wind takes 33 s");
  EXPECT_EQ(pace_text(0.5, 10, 0.05), "× 0.5: slower than real time, a second of wind takes 2 s");
  EXPECT_EQ(pace_text(1.0 / 3600, 10, 1e-4),
            "× 0.000278: slower than real time, a second of wind takes an hour");
}

TEST(PaceText, WithoutAnAcceleration) {
  EXPECT_EQ(pace_text(0, 10, 360), "not tied to a clock: 10 steps of 6 min a second = × 3600");
  EXPECT_EQ(pace_text(0, 1, 1), "not tied to a clock: 1 step of a second a second = × 1");
  EXPECT_EQ(pace_text(0, 0.5, 1), "not tied to a clock: 0.5 steps of a second a second = × 0.5");
  EXPECT_EQ(pace_text(0, 0, 0.1f), "not tied to a clock: steps of 100 ms, as fast as it can");
}

TEST(PaceText, TimesAtTheEdgesOfUnits) {
  EXPECT_EQ(spoken_time(59.4), "59 s");
  EXPECT_EQ(spoken_time(9.94), "9.94 s");
  EXPECT_EQ(spoken_time(59.99), "a minute") << "not 60 s";
  EXPECT_EQ(spoken_time(3599), "an hour");
  EXPECT_EQ(spoken_time(365.25 * 86400), "a year");
  EXPECT_EQ(spoken_time(0.9999), "a second");
  EXPECT_EQ(spoken_time(0.02), "20 ms");
  EXPECT_EQ(spoken_time(0), "0 s");
}

TEST(PaceText, NumbersThatNoNodeHas) {
  for (const double number : {double(NAN), HUGE_VAL, -HUGE_VAL, -1.0, 1e300, 1e-300})
    EXPECT_FALSE(pace_text(number, number, number).empty());
}

}  // namespace
}  // namespace desert_sim

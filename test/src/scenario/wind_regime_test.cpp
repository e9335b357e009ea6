// The wind high above the ground: constant, ramp, timeline, rose.

#include "src/scenario/wind_regime.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace desert_sim {
namespace {

void expect_wind(wind::Vector w, double x, double y) {
  EXPECT_NEAR(w.x, x, 1e-5);
  EXPECT_NEAR(w.y, y, 1e-5);
}

TEST(UnitVector, IsExactForQuarterTurns) {
  const double exact[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (int q = -8; q <= 8; ++q) {
    const wind::Vector u = unit_vector(90.0 * q);
    EXPECT_EQ(u.x, exact[((q % 4) + 4) % 4][0]) << q;
    EXPECT_EQ(u.y, exact[((q % 4) + 4) % 4][1]) << q;
  }
}

TEST(UnitVector, PointsCounterClockwiseFromEast) {
  for (double d = -720; d <= 720; d += 7.3) {
    const wind::Vector u = unit_vector(d);
    EXPECT_NEAR(u.x, std::cos(d * 3.14159265358979 / 180), 1e-6);
    EXPECT_NEAR(u.y, std::sin(d * 3.14159265358979 / 180), 1e-6);
  }
}

TEST(SpeedAndDirection, InvertTheVector) {
  double speed, direction;
  speed_and_direction(wind_vector(-135, 7), speed, direction);
  EXPECT_NEAR(speed, 7, 1e-5);
  EXPECT_NEAR(direction, -135, 1e-4);
  speed_and_direction({}, speed, direction);
  EXPECT_EQ(speed, 0);
  EXPECT_EQ(direction, 0);
}

TEST(WindRegime, IsConstantAfterItsRamp) {
  WindRegime r;
  r.direction_deg = 90;
  r.speed = 6;
  expect_wind(r.at(0), 0, 6);
  r.ramp = 10;
  r.start_time = 100;
  r.initial_wind = {4, 0};
  expect_wind(r.at(100), 4, 0);
  expect_wind(r.at(105), 2, 3);
  expect_wind(r.at(110), 0, 6);
  expect_wind(r.at(1e9), 0, 6);
  expect_wind(r.at(0), 4, 0);
}

WindRegime timeline(bool repeat) {
  WindRegime r;
  r.regime = WindRegimeKind::timeline;
  r.repeat = repeat;
  r.initial_wind = {-2, 0};
  r.segments = {{0, 4, 10, 4, 1}, {90, 6, 20, 0, 1}, {180, 8, 5, 5, 1}};
  return r;
}

TEST(WindRegime, TimelineRampsFromWhatWasBeforeAndTurnsAtOnceWithoutRamp) {
  const WindRegime r = timeline(true);
  expect_wind(r.at(0), -2, 0);
  expect_wind(r.at(2), 1, 0);
  expect_wind(r.at(4), 4, 0);
  expect_wind(r.at(9.99), 4, 0);
  expect_wind(r.at(10), 0, 6);
  expect_wind(r.at(29.99), 0, 6);
  expect_wind(r.at(32.5), -4, 3);
}

TEST(WindRegime, TimelineRepeatsFromItsLastSegmentOrHoldsIt) {
  expect_wind(timeline(true).at(35), -8, 0);
  expect_wind(timeline(true).at(37), -2, 0);
  expect_wind(timeline(true).at(35 + 12), 0, 6);
  expect_wind(timeline(true).at(35 * 1000 + 12), 0, 6);
  expect_wind(timeline(false).at(35), -8, 0);
  expect_wind(timeline(false).at(1e6), -8, 0);
}

WindRegime rose(std::uint64_t seed) {
  WindRegime r;
  r.regime = WindRegimeKind::rose;
  r.hold_time = 5;
  r.rose_seed = seed;
  r.segments = {{0, 3, 1, 0, 1}, {90, 4, 1, 0, 2}, {180, 5, 1, 0, 0}, {270, 6, 1, 0, 5}};
  return r;
}

TEST(WindRegime, RoseDrawsEachDirectionAsOftenAsItsProbability) {
  const WindRegime r = rose(3);
  std::map<int, int> counts;
  constexpr int draws = 20000;
  for (int n = 0; n < draws; ++n) {
    const wind::Vector w = r.at(5.0 * n + 2.5);
    ++counts[static_cast<int>(std::lround(std::hypot(w.x, w.y)))];
  }
  EXPECT_EQ(counts.count(5), 0u) << "probability 0";
  EXPECT_NEAR(counts[3], draws / 8.0, 4 * std::sqrt(draws / 8.0));
  EXPECT_NEAR(counts[4], draws / 4.0, 4 * std::sqrt(draws / 4.0));
  EXPECT_NEAR(counts[6], draws * 5 / 8.0, 4 * std::sqrt(draws * 5 / 8.0));
}

TEST(WindRegime, RoseHoldsADirectionAndDependsOnItsSeed) {
  const WindRegime r = rose(3), other = rose(4);
  int different = 0;
  for (int n = 0; n < 100; ++n) {
    const wind::Vector a = r.at(5.0 * n), b = r.at(5.0 * n + 4.99), c = other.at(5.0 * n);
    EXPECT_EQ(a.x, b.x);
    EXPECT_EQ(a.y, b.y);
    different += a.x != c.x || a.y != c.y;
  }
  EXPECT_GT(different, 20);
}

/// hold_time changes in fifty stairs, as a ramp does it. A rose began anew at every stair and so kept its
/// first direction until the ramp was over.
TEST(WindRegime, RoseAndTimelineGoOnWhileTheirParametersChange) {
  WindRegime r = rose(3);
  WindRegimeParameters p = r;
  int draws = 0;
  for (double time = 0; time < 200; time += 4) {
    p.hold_time = static_cast<float>(5 + time / 100);
    const wind::Vector before = r.at(time);
    r = r.with(p, time);
    EXPECT_EQ(r.at(time).x, before.x) << time;
    EXPECT_EQ(r.at(time).y, before.y) << time;
    draws += r.at(time + 4).x != before.x || r.at(time + 4).y != before.y;
  }
  EXPECT_GT(draws, 12) << "the wind of a rose";

  WindRegime t = timeline(true);
  for (double time = 0; time < 100; time += 1.5) {
    WindRegimeParameters changed = t;
    changed.speed = static_cast<float>(time);  // of a constant wind, which this is not
    t = t.with(changed, time);
    const wind::Vector expected = timeline(true).at(time), now = t.at(time);
    expect_wind(now, static_cast<double>(expected.x), static_cast<double>(expected.y));
  }
}

TEST(WindRegime, ConstantWindTurnsFromThePresentOneOnlyIfItChanges) {
  WindRegime r;
  r.ramp = 10;
  r.speed = 6;
  WindRegimeParameters p = r;
  p.repeat = false;
  r = r.with(p, 5);
  expect_wind(r.at(10), 6, 0);
  p.speed = 2;
  r = r.with(p, 5);
  expect_wind(r.at(5), 3, 0);
  expect_wind(r.at(15), 2, 0);
}

}  // namespace
}  // namespace desert_sim

// Measured series of the wind: what a file says, and what is wrong with it.

#include "src/scenario/wind_series.hpp"

#include <gtest/gtest.h>

#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

const SeriesFormat usual{SeriesDirection::to, SeriesAngle::mathematical, ""};

WindSeries parse(const std::string& text, const SeriesFormat& format = usual) {
  return parse_wind_series(text, "wind.csv", format);
}

void expect_wind(wind::Vector w, double x, double y) {
  EXPECT_NEAR(w.x, x, 1e-5);
  EXPECT_NEAR(w.y, y, 1e-5);
}

const std::string three = "time,speed,direction\n0,4,0\n10,5,90\n30,6,180\n";

TEST(WindSeries, HoldsEachRowUntilTheNext) {
  const WindSeries s = parse(three);
  expect_wind(s.at(-5, false), 4, 0);
  expect_wind(s.at(0, false), 4, 0);
  expect_wind(s.at(9.999, false), 4, 0);
  expect_wind(s.at(10, false), 0, 5);
  expect_wind(s.at(29.9, false), 0, 5);
  expect_wind(s.at(30, false), -6, 0);
  expect_wind(s.at(1e9, false), -6, 0);
  EXPECT_EQ(s.shortest_interval(), 10);
  EXPECT_NEAR(s.fastest(), 6, 1e-6);
}

/// The last row holds for 20 s, as the one before it.
TEST(WindSeries, Repeats) {
  const WindSeries s = parse(three);
  expect_wind(s.at(49.9, true), -6, 0);
  expect_wind(s.at(50, true), 4, 0);
  expect_wind(s.at(60, true), 0, 5);
  expect_wind(s.at(50 * 7 + 35, true), -6, 0);
  expect_wind(parse("time,speed,direction\n5,4,0\n").at(1e6, true), 4, 0);
}

TEST(WindSeries, TurnsDirectionsByTheirConvention) {
  const std::string text = "direction,time,note,speed\n30, 0 ,calm, 2\n";
  const auto at = [&](SeriesDirection direction, SeriesAngle angle) {
    return parse(text, {direction, angle, ""}).at(0, false);
  };
  const double cos30 = 0.8660254 * 2, sin30 = 0.5 * 2;
  expect_wind(at(SeriesDirection::to, SeriesAngle::mathematical), cos30, sin30);
  expect_wind(at(SeriesDirection::from, SeriesAngle::mathematical), -cos30, -sin30);
  expect_wind(at(SeriesDirection::to, SeriesAngle::compass), sin30, cos30);
  expect_wind(at(SeriesDirection::from, SeriesAngle::compass), -sin30, -cos30);
}

TEST(WindSeries, ReadsDates) {
  const std::string text =
      "time,speed,direction\n2001-02-28T23:30,1,0\n2001-03-01 00:00:00,2,0\n\n# a "
      "pause\n2001-03-04T15:00Z,3,0\n";
  const WindSeries s = parse(text);
  EXPECT_EQ(s.rows.at(1).time, 1800);
  EXPECT_EQ(s.rows.at(2).time, 1800 + 3 * 86400 + 15 * 3600);
  EXPECT_EQ(date_text(s.date.value()), "2001-02-28 23:30:00");
  const WindSeries later = parse(text, {SeriesDirection::to, SeriesAngle::mathematical, "2001-03-02"});
  EXPECT_EQ(later.rows.at(1).time, -86400);
  expect_wind(later.at(0, false), 2, 0);
  EXPECT_EQ(date_text(later.date.value()), "2001-03-02 00:00:00");
}

TEST(WindSeries, KnowsTheCalendar) {
  EXPECT_EQ(read_date("1970-01-01").value(), 0);
  EXPECT_EQ(read_date("2000-03-01").value(), 951868800);
  EXPECT_EQ(read_date("1969-12-31T23:59:59").value(), -1);
  for (const char* date : {"2000-02-29 12:34:56", "1900-03-01 00:00:00", "1969-07-20 20:17:40",
                           "2400-12-31 23:59:59", "2026-11-25 10:00:00"})
    EXPECT_EQ(date_text(read_date(date).value()), date);
  for (const char* none : {"", "2001", "2001-13-01", "2001-02-29", "1900-02-29", "2001-03-04T25:00",
                           "2001-03-04T15", "2001-03-04x15:00", "2001-03-04T15:00:99", "2001-03-04T15:00 h"})
    EXPECT_FALSE(read_date(none)) << none;
}

TEST(WindSeries, NamesLineColumnAndValueOfAllFaults) {
  const std::string said = test::refusal(
      [] { parse("# a station\ntime,speed,direction\n0,4,0\n10,x,0\n10,4,400\n20,-1,0\n25\n"); });
  for (const char* part : {"wind.csv: line 4, column speed: 'x'", "[0, 100] m/s", "line 5, column time",
                           "not later than", "line 5, column direction: '400'", "[-360, 360] deg",
                           "line 6, column speed: '-1'", "line 7, column speed: ''"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " is not in\n" << said;
}

TEST(WindSeries, RefusesWhatIsNoSeries) {
  EXPECT_NE(test::refusal([] { parse(""); }).find("no row"), std::string::npos);
  EXPECT_NE(test::refusal([] { parse("time,speed\n0,1\n"); }).find("no column 'direction'"),
            std::string::npos);
  EXPECT_NE(test::refusal([] { parse("time,speed,direction\n0,1,2\n2001-03-04,1,2\n"); }).find("line 3"),
            std::string::npos);
  const std::string late = test::refusal([] {
    parse(three, {SeriesDirection::to, SeriesAngle::mathematical, "31"});
  });
  EXPECT_NE(late.find("wind.series_start: '31' is not in [0 s, 30 s]"), std::string::npos) << late;
  EXPECT_FALSE(test::refusal([] {
                 parse(three, {SeriesDirection::to, SeriesAngle::mathematical, "2001-03-04"});
               }).empty());
}

TEST(WindSeries, IsTheSameAsText) {
  WindSeries s = parse("time,speed,direction\n2001-03-04T15:00,3.3,17\n2001-03-04T15:00:00.1,7.1,200.3\n");
  const WindSeries back = WindSeries::from_text(s.text(), "a.ck");
  EXPECT_EQ(back.text(), s.text());
  EXPECT_EQ(back.date, s.date);
  ASSERT_EQ(back.rows.size(), 2u);
  EXPECT_EQ(back.rows[1].time, s.rows[1].time);
  EXPECT_EQ(back.rows[1].wind.x, s.rows[1].wind.x);
  for (const char* none : {"", "-", "x 0,1,2", "- 0,1", "- 0,1,2 0,1,2", "- 0,1000,2", "- 0,nan,2"})
    EXPECT_FALSE(test::refusal([&] { WindSeries::from_text(none, "a.ck"); }).empty()) << none;
}

}  // namespace
}  // namespace desert_sim

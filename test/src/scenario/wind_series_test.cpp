// Series of the wind: what blows when, and their dates.

#include "src/scenario/wind_series.hpp"

#include <gtest/gtest.h>

#include "src/scenario/wind_series_file.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

WindSeries series_of(const std::string& text) {
  return parse_wind_series(text, "wind.csv", {SeriesDirection::to, SeriesAngle::mathematical});
}

void expect_blows(wind::Vector w, double x, double y) {
  EXPECT_NEAR(w.x, x, 1e-5);
  EXPECT_NEAR(w.y, y, 1e-5);
}

const std::string three_rows = "time,speed,direction\n0,4,0\n10,5,90\n30,6,180\n";

TEST(WindSeries, HoldsEachRowUntilTheNext) {
  const WindSeries s = series_of(three_rows);
  expect_blows(s.at(-5, false), 4, 0);
  expect_blows(s.at(0, false), 4, 0);
  expect_blows(s.at(9.999, false), 4, 0);
  expect_blows(s.at(10, false), 0, 5);
  expect_blows(s.at(29.9, false), 0, 5);
  expect_blows(s.at(30, false), -6, 0);
  expect_blows(s.at(1e9, false), -6, 0);
  EXPECT_EQ(s.shortest_interval(), 10);
  EXPECT_NEAR(s.fastest(), 6, 1e-6);
}

/// The last row holds for 20 s, as the one before it.
TEST(WindSeries, Repeats) {
  const WindSeries s = series_of(three_rows);
  expect_blows(s.at(49.9, true), -6, 0);
  expect_blows(s.at(50, true), 4, 0);
  expect_blows(s.at(60, true), 0, 5);
  expect_blows(s.at(50 * 7 + 35, true), -6, 0);
  expect_blows(series_of("time,speed,direction\n5,4,0\n").at(1e6, true), 4, 0);
}

TEST(WindSeries, KnowsTheCalendar) {
  EXPECT_EQ(read_date("1970-01-01").value(), 0);
  EXPECT_EQ(read_date("2000-03-01").value(), 951868800);
  EXPECT_EQ(read_date("1969-12-31T23:59:59").value(), -1);
  for (const char* date : {"2000-02-29 12:34:56", "1900-03-01 00:00:00", "1969-07-20 20:17:40",
                           "2400-12-31 23:59:59", "2026-11-25 10:00:00"})
    EXPECT_EQ(date_text(read_date(date).value()), date);
  EXPECT_EQ(read_date("2019-10-27T02:00+02:00").value(), read_date("2019-10-27T00:00").value());
  EXPECT_EQ(read_date("2019-10-27T02:00:30-0330").value(), read_date("2019-10-27T05:30:30Z").value());
  for (const char* none : {"2019-10-27T02:00+25:00", "2019-10-27T02:00+02:0x", "2019-10-27T02:00+", "",
                           "2001", "2001-13-01", "2001-02-29", "1900-02-29", "2001-03-04T25:00",
                           "2001-03-04T15", "2001-03-04x15:00", "2001-03-04T15:00:99", "2001-03-04T15:00 h"})
    EXPECT_FALSE(read_date(none)) << none;
}

TEST(WindSeries, IsTheSameAsText) {
  WindSeries s =
      series_of("time,speed,direction\n2001-03-04T15:00,3.3,17\n2001-03-04T15:00:00.1,7.1,200.3\n");
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

// Series of the wind in files: what a file says, and what is wrong with it.

#include "src/scenario/wind_series_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/support/log_lines.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

const SeriesFormat usual{SeriesDirection::to, SeriesAngle::mathematical};

WindSeries parse(const std::string& text, const SeriesFormat& format = usual) {
  return parse_wind_series(text, "wind.csv", format);
}

void expect_vector(wind::Vector w, double x, double y) {
  EXPECT_NEAR(w.x, x, 1e-5);
  EXPECT_NEAR(w.y, y, 1e-5);
}

const std::string three = "time,speed,direction\n0,4,0\n10,5,90\n30,6,180\n";

TEST(WindSeriesFile, TurnsDirectionsByTheirConvention) {
  const std::string text = "direction,time,note,speed\n30, 0 ,calm, 2\n";
  const auto at = [&](SeriesDirection direction, SeriesAngle angle) {
    return parse(text, {direction, angle, ""}).at(0, false);
  };
  const double cos30 = 0.8660254 * 2, sin30 = 0.5 * 2;
  expect_vector(at(SeriesDirection::to, SeriesAngle::mathematical), cos30, sin30);
  expect_vector(at(SeriesDirection::from, SeriesAngle::mathematical), -cos30, -sin30);
  expect_vector(at(SeriesDirection::to, SeriesAngle::compass), sin30, cos30);
  expect_vector(at(SeriesDirection::from, SeriesAngle::compass), -sin30, -cos30);
}

TEST(WindSeriesFile, ReadsDates) {
  const std::string text =
      "time,speed,direction\n2001-02-28T23:30,1,0\n2001-03-01 00:00:00,2,0\n\n# a "
      "pause\n2001-03-04T15:00Z,3,0\n";
  const WindSeries s = parse(text);
  EXPECT_EQ(s.rows.at(1).time, 1800);
  EXPECT_EQ(s.rows.at(2).time, 1800 + 3 * 86400 + 15 * 3600);
  EXPECT_EQ(date_text(s.date.value()), "2001-02-28 23:30:00");
  const WindSeries later = parse(text, {SeriesDirection::to, SeriesAngle::mathematical, "2001-03-02"});
  EXPECT_EQ(later.rows.at(1).time, -86400);
  expect_vector(later.at(0, false), 2, 0);
  EXPECT_EQ(date_text(later.date.value()), "2001-03-02 00:00:00");
}

TEST(WindSeriesFile, NamesLineColumnAndValueOfAllFaults) {
  const std::string said =
      test::refusal([] { parse("# a station\ntime,speed,direction\n0,4,0\n10,x,0\n10,4,400\n20,-1,0\n"); });
  for (const char* part :
       {"wind.csv: line 4, column speed: 'x'", "[0, 100] m/s", "line 5, column time", "not later than",
        "line 5, column direction: '400'", "[-360, 360] deg", "line 6, column speed: '-1'"})
    EXPECT_NE(said.find(part), std::string::npos) << part << " is not in\n" << said;
}

TEST(WindSeriesFile, RefusesWhatIsNoSeries) {
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

/// Columns as spreadsheets of all systems and languages save them.
TEST(WindSeriesFile, ReadsWhatSpreadsheetsSave) {
  const std::string expected = parse("time,speed,direction\n0,7.5,35\n10,8.5,40\n").text();
  EXPECT_EQ(parse("\xEF\xBB\xBFtime,speed,direction\r\n0,7.5,35\r\n10,8.5,40\r\n").text(), expected);
  EXPECT_EQ(parse("time\tspeed\tdirection\n0\t7.5\t35\n10\t8.5\t40\n").text(), expected);
  EXPECT_EQ(parse("Time;Speed;Direction\n0;7,5;35\n10;8.5;40\n").text(), expected);
  EXPECT_EQ(parse("time,speed,direction\r0,7.5,35\r10,8.5,40\r").text(), expected);
  EXPECT_EQ(parse("\"time\",\"speed\",\"direction\"\n\"0\",\"7.5\",\"35\"\n10,8.5,40").text(), expected);
  const std::string utf16("\xFF\xFEt\0i\0m\0e\0", 10);
  for (const std::string& text : {utf16, std::string("time\0,speed", 11)}) {
    const std::string said = test::refusal([&] { parse(text); });
    EXPECT_NE(said.find("wind.csv: "), std::string::npos) << said;
    EXPECT_NE(said.find("save it as UTF-8"), std::string::npos) << said;
  }
}

TEST(WindSeriesFile, CalmAirNeedsNoDirection) {
  for (const char* none : {"", "NA", "NaN", "nan", "-"}) {
    const WindSeries s = parse("time,speed,direction\n0,4,0\n10,0.0," + std::string(none) + "\n20,3,90\n");
    ASSERT_EQ(s.rows.size(), 3u) << none;
    expect_vector(s.rows[1].wind, 0, 0);
    const std::string said =
        test::refusal([&] { parse("time,speed,direction\n0,4,0\n10,1.5," + std::string(none) + "\n"); });
    EXPECT_NE(said.find("line 3, column direction"), std::string::npos) << said << " for " << none;
  }
  EXPECT_FALSE(test::refusal([] { parse("time,speed,direction\n0,1.5,VRB\n"); }).empty());
}

TEST(WindSeriesFile, ARowWithoutSpeedIsAGap) {
  for (const char* row : {"10,,", "10,NA,270", "10,NaN,NaN", "10"}) {
    test::LogLines log;
    const WindSeries s = parse("time,speed,direction\n0,4,0\n" + std::string(row) + "\n20,3,90\n");
    ASSERT_EQ(s.rows.size(), 2u) << row;
    expect_vector(s.at(15, false), 4, 0);
    ASSERT_FALSE(log.lines.empty()) << row;
    EXPECT_NE(log.lines[0].find("1 of 3 rows have no speed"), std::string::npos) << log.lines[0];
  }
  EXPECT_NE(test::refusal([] { parse("time,speed,direction\n0,,\n"); }).find("no row with a speed"),
            std::string::npos);
  EXPECT_NE(test::refusal([] { parse("time,speed,direction\n0,999.9,999\n"); }).find("[0, 100] m/s"),
            std::string::npos);
}

/// A gale, two days without data, and calmer hours.
TEST(WindSeriesFile, GapsAreToldHeldCalmedOrRefused) {
  const std::string text =
      "time,speed,direction\n2019-01-01T00:00,4,0\n2019-01-01T01:00,20,0\n2019-01-03T01:00,4,0\n"
      "2019-01-03T02:00,5,0\n2019-01-03T03:00,5,0\n";
  constexpr double hour = 3600;
  const auto with = [&](SeriesGap gap) {
    return parse(text, {SeriesDirection::to, SeriesAngle::mathematical, "", gap});
  };
  test::LogLines log;
  const WindSeries held = with(SeriesGap::hold), calm = with(SeriesGap::calm);
  ASSERT_EQ(log.lines.size(), 2u);
  for (const char* part : {"wind.csv", "1 gap", "2 d after 2019-01-01 01:00:00", "the usual interval is 1 h",
                           "20 m/s", "wind.series_gap: hold"})
    EXPECT_NE(log.lines[0].find(part), std::string::npos) << part << " is not in " << log.lines[0];
  EXPECT_NE(log.lines[1].find("calm air"), std::string::npos) << log.lines[1];
  expect_vector(held.at(30 * hour, false), 20, 0);
  expect_vector(calm.at(1.9 * hour, false), 20, 0);
  expect_vector(calm.at(2 * hour, false), 0, 0);
  expect_vector(calm.at(48.9 * hour, false), 0, 0);
  expect_vector(calm.at(49 * hour, false), 4, 0);
  const std::string said = test::refusal([&] { with(SeriesGap::refuse); });
  EXPECT_NE(said.find("wind.series_gap: has 1 gap"), std::string::npos) << said;
}

/// However many rows lack a speed: the rows of the file say what the usual interval is.
TEST(WindSeriesFile, RowsWithoutSpeedAreGapsWhereverTheyAre) {
  for (const char* rows : {"0,4,0\n3600,,\n7200,4,0\n", "0,4,0\n3600,,\n7200,4,0\n10800,,\n14400,4,0\n",
                           "0,4,0\n3600,4,0\n7200,NA,0\n"}) {
    const std::string text = std::string("time,speed,direction\n") + rows;
    const auto with = [&](SeriesGap gap) {
      return parse(text, {SeriesDirection::to, SeriesAngle::mathematical, "", gap});
    };
    EXPECT_NE(test::refusal([&] { with(SeriesGap::refuse); }).find("the longest of 2 h"), std::string::npos)
        << rows;
    const WindSeries calmed = with(SeriesGap::calm);
    EXPECT_NE(
        std::find_if(calmed.rows.begin(), calmed.rows.end(), [](const auto& row) { return row.wind.x == 0; }),
        calmed.rows.end())
        << rows;
  }
}

TEST(WindSeriesFile, FieldsMayBeQuotedAndNoneIsLeftOver) {
  const auto refused = [](const std::string& rows) {
    return test::refusal([&] { parse("time,speed,direction\n" + rows); });
  };
  EXPECT_EQ(
      parse("time,station,speed,direction\n0,\"A, 3\",4,0\n3600,\"B \"\"3, 4\"\"\",5,0\n").rows[1].wind.x, 5);
  EXPECT_EQ(parse("time,speed,direction\n0,4,0,,\n3600,5,0,\n").rows[1].wind.x, 5)
      << "empty fields at the end";
  for (const char* row : {"0,4,1,270,0\n", "0,4,270,note\n"})
    EXPECT_NE(refused(row).find("fields, and the header 3"), std::string::npos) << refused(row);
  const std::string decimal = refused("0,\"4,1\",\"270,0\"\n");
  EXPECT_NE(decimal.find("column speed: '4,1' is not a number"), std::string::npos) << decimal;
  const std::string two = test::refusal([] { parse("time,speed,speed,direction\n0,4,9,0\n"); });
  EXPECT_NE(two.find("has two columns 'speed'"), std::string::npos) << two;
}

TEST(WindSeriesFile, RowsAtEqualIntervalsHaveNoGap) {
  test::LogLines log;
  parse("time,speed,direction\n0,4,0\n");
  parse("time,speed,direction\n0,4,0\n10,4,0\n20,4,0\n34,4,0\n",
        {SeriesDirection::to, SeriesAngle::mathematical, "", SeriesGap::refuse});
  EXPECT_TRUE(log.lines.empty()) << log.lines[0];
}

TEST(WindSeriesFile, DatesWrittenAsNumbersAreRefused) {
  const auto said = [](const std::string& first, const std::string& second) {
    return test::refusal([&] { parse("time,speed,direction\n" + first + ",4,0\n" + second + ",5,90\n"); });
  };
  EXPECT_NE(said("20240131", "20240201").find("write them as 2024-01-31 00:00:00"), std::string::npos);
  EXPECT_NE(said("2024013123", "2024020100").find("write them as 2024-01-31 23:00:00"), std::string::npos);
  EXPECT_NE(said("202401312310", "202401312320").find("write them as 2024-01-31 23:10:00"),
            std::string::npos);
  EXPECT_NO_THROW(parse("time,speed,direction\n20240131,4,0\n20240132,5,90\n")) << "no date";
  EXPECT_NO_THROW(parse("time,speed,direction\n1700000000,4,0\n1700003600,5,90\n")) << "since 1970";
}

TEST(WindSeriesFile, DaysOfASpreadsheetAreWarnedOf) {
  const auto warnings = [](const std::string& first, const std::string& second) {
    test::LogLines log;
    parse("time,speed,direction\n" + first + ",4,0\n" + second + ",5,90\n");
    return log.lines.size();
  };
  EXPECT_EQ(warnings("45292", "45292.0416667"), 1u);
  EXPECT_EQ(warnings("45292", "45293"), 1u);
  EXPECT_EQ(warnings("0", "1"), 0u);
  EXPECT_EQ(warnings("45000", "45600"), 0u);
}

TEST(WindSeriesFile, AnHourThatComesTwiceIsOneFault) {
  const std::string said = test::refusal([] {
    parse(
        "time,speed,direction\n2019-10-27T01:00,4,0\n2019-10-27T02:00,5,0\n2019-10-27T02:00,6,0\n"
        "2019-10-27T03:00,3,0\n");
  });
  EXPECT_NE(said.find("line 4, column time: 2019-10-27 02:00:00 is not later"), std::string::npos) << said;
  EXPECT_NE(said.find("summer time"), std::string::npos) << said;
  EXPECT_EQ(said.find("line 5"), std::string::npos) << said;
}

/// What is no time is not compared with others: 2019 s after 1970 is none of the file's.
TEST(WindSeriesFile, AFaultyTimeIsOneFault) {
  const std::string said = test::refusal([] {
    parse("time,speed,direction\n2019-10-27T01:00,4,0\n2019-10-27T25:00,5,0\n2019-10-27T02:00,6,0\n");
  });
  EXPECT_NE(said.find("line 3, column time: '2019-10-27T25:00'"), std::string::npos) << said;
  EXPECT_EQ(said.find("1970"), std::string::npos) << said;
  EXPECT_EQ(said.find("line 4"), std::string::npos) << said;
}

TEST(WindSeriesFile, TimesBeyondTheRangeAreRefused) {
  const std::string said =
      test::refusal([] { parse("time,speed,direction\n-1.7e308,4,0\n0,5,0\n1.7e308,6,0\n"); });
  EXPECT_NE(said.find("line 2, column time: '-1.7e308' is not seconds in [-1e12, 1e12]"), std::string::npos)
      << said;
  EXPECT_NE(said.find("line 4"), std::string::npos) << said;
}

}  // namespace
}  // namespace desert_sim

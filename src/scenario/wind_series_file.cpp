#include "src/scenario/wind_series_file.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "src/core/csv.hpp"
#include "src/core/elementary.hpp"
#include "src/core/input_file.hpp"
#include "src/core/log.hpp"
#include "src/core/lower_case.hpp"
#include "src/core/number_text.hpp"
#include "src/core/quoted.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/scenario/scenario.hpp"
#include "src/scenario/sections.hpp"
#include "src/scenario/wind_regime.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr std::uint64_t max_series_bytes = std::uint64_t{1} << 26;
constexpr double max_series_time = 1e12;  // [s], as of other times
constexpr double usual_intervals = 1.5;   // longer than so many is a gap

/// What stations write where they have measured nothing.
bool is_missing(const std::string& field) {
  for (const char* none : {"", "na", "n/a", "nan", "null", "none", "-", "--"})
    if (lower_case(field) == none) return true;
  return false;
}

/// Times of a file, in seconds or as dates: what its first one is, all must be.
struct TimeReader {
  bool dates = false, known = false;

  bool read(const std::string& text, bool decimal_comma, double& time) {
    const std::optional<double> date = read_date(text);
    if (!date && !read_plain_number(text, time, decimal_comma)) return false;
    if (date) time = *date;
    if (!(std::abs(time) <= max_series_time)) return false;
    if (known && dates != date.has_value()) return false;
    dates = date.has_value();
    known = true;
    return true;
  }
  std::string expected() const {
    if (!known) return "seconds in [-1e12, 1e12] or a date such as 2001-03-04T15:00";
    return dates ? "a date such as 2001-03-04T15:00" : "seconds in [-1e12, 1e12], as in the rows before";
  }
  std::string shown(double time) const { return dates ? date_text(time) : number_text(time, 10) + " s"; }
  /// A length of time in what reads best: "28 d", "1 h", "0.5 s".
  static std::string length(double seconds) {
    for (const auto& [unit, name] : {std::pair{86400.0, " d"}, {3600.0, " h"}, {60.0, " min"}})
      if (seconds >= unit) return number_text(seconds / unit) + name;
    return number_text(seconds) + " s";
  }
};

/// Where the columns that count stand, and what separates them.
struct Columns {
  int time = -1, speed = -1, direction = -1;  ///< -1: nowhere
  std::size_t count = 0;
  char separator = ',';
  bool decimal_comma() const { return separator != ','; }
};

Columns find_columns(const std::string& line, const std::string& key, ValidationErrors& errors) {
  Columns columns;
  columns.separator = separator_of(line);
  std::vector<std::string> names;
  for (const std::string& field : csv_fields(line, columns.separator)) names.push_back(lower_case(field));
  const auto find = [&](const char* name, int& column) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      errors.add(key,
                 std::string("has no column '") + name +
                     "' (needed: time, speed, direction, separated by commas, semicolons or tabs; found: " +
                     shortened(line) + ")");
    else if (std::find(found + 1, names.end(), name) != names.end())
      errors.add(
          key, std::string("has two columns '") + name + "' (allowed: one; found: " + shortened(line) + ")");
    else
      column = static_cast<int>(found - names.begin());
  };
  columns.count = names.size();
  find("time", columns.time);
  find("speed", columns.speed);
  find("direction", columns.direction);
  return columns;
}

/// The direction to which the air moves, counter-clockwise from +x [deg].
double direction_to(double given, const SeriesFormat& format) {
  const double angle = format.angle == SeriesAngle::compass ? 90 - given : given;
  return format.direction == SeriesDirection::from ? angle + 180 : angle;
}

/// The rows of a file, one after the other.
class RowReader {
 public:
  RowReader(const SeriesFormat& format, ValidationErrors& errors) : format_(format), errors_(errors) {}

  void read_columns(const std::string& line, const std::string& key) {
    columns_ = find_columns(line, key, errors_);
  }

  void read_row(const std::string& line, const std::string& key) {
    const std::vector<std::string> fields = csv_fields(line, columns_.separator);
    const auto field = [&](int column) {
      return column < static_cast<int>(fields.size()) ? fields[static_cast<std::size_t>(column)] : "";
    };
    // Such as those of numbers with a decimal comma, between commas.
    const auto full = std::find_if(fields.rbegin(), fields.rend(), [](const auto& f) { return !f.empty(); });
    if (const auto used = static_cast<std::size_t>(fields.rend() - full); used > columns_.count) {
      errors_.add(key, "has " + std::to_string(used) + " fields, and the header " +
                           std::to_string(columns_.count) + ": " + shortened(line));
      return;
    }
    double time = 0, speed = 0, direction = 0;
    if (!times.read(field(columns_.time), columns_.decimal_comma(), time)) {
      errors_.add(key + ", column time", in_quotes(field(columns_.time)) + " is not " + times.expected());
      return;
    }
    if (last_time_ && !(time > *last_time_))
      errors_.add(
          key + ", column time",
          times.shown(time) + " is not later than the row before, " + times.shown(*last_time_) +
              (times.dates ? "; where clocks go back an hour at the end of summer time, give UTC or the "
                             "distance from it (2001-10-28T02:00+02:00)"
                           : ""));
    last_time_ = time;
    all_times.push_back(time);
    if (is_missing(field(columns_.speed))) {
      ++missing;
      return;
    }
    number(key, "speed", field(columns_.speed), 0, max_series_speed,
           "m/s; a field that is empty, NA or NaN is missing", speed);
    const bool calm = speed == 0 && is_missing(field(columns_.direction));
    if (!calm) number(key, "direction", field(columns_.direction), -360, 360, "deg", direction);
    rows.push_back({time, wind_vector(direction_to(direction, format_), speed)});
  }

  std::vector<WindSeries::Row> rows;
  std::vector<double> all_times;  ///< also of rows without a speed
  TimeReader times;
  long long missing = 0;  ///< rows without a speed

 private:
  void number(const std::string& key, const char* name, const std::string& field, double lowest,
              double highest, const char* unit, double& value) {
    if (!read_plain_number(field, value, columns_.decimal_comma()) || !(value >= lowest && value <= highest))
      errors_.add(key + ", column " + name, in_quotes(field) + " is not a number in [" + number_text(lowest) +
                                                ", " + number_text(highest) + "] " + unit);
  }

  const SeriesFormat& format_;
  ValidationErrors& errors_;
  Columns columns_;
  std::optional<double> last_time_;
};

/// Time of the file at which the simulation starts.
double start_of(const WindSeries& series, const TimeReader& times, const std::string& given,
                ValidationErrors& errors) {
  const double first = series.rows.front().time, last = series.rows.back().time;
  if (given.empty()) return first;
  double start = 0;
  const std::optional<double> date = read_date(given);
  const bool read = times.dates ? date.has_value() : read_plain_number(given, start);
  if (times.dates && date) start = *date;
  if (!read || !(start >= first && start <= last))
    errors.add("wind.series_start", in_quotes(given) + " is not in [" + times.shown(first) + ", " +
                                        times.shown(last) + "], the times of the series");
  return start;
}

/// Median of the intervals between two or more times [s].
double usual_interval(const std::vector<double>& times) {
  std::vector<double> intervals;
  intervals.reserve(times.size() - 1);
  for (std::size_t n = 1; n < times.size(); ++n) intervals.push_back(times[n] - times[n - 1]);
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>((intervals.size() - 1) / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// Refuses dates that are written as numbers, and warns of times that may be days of a spreadsheet, counted
/// from 1900.
void check_seconds(const std::vector<double>& times, const std::string& source, ValidationErrors& errors) {
  if (times.size() < 2) return;
  if (std::all_of(times.begin(), times.end(), [](double t) { return date_of_number(t).has_value(); })) {
    errors.add("column time",
               number_text(times.front(), 17) +
                   " and all others are dates written as numbers, not seconds; write them as " +
                   date_text(*date_of_number(times.front())));
    return;
  }
  constexpr double in_1927 = 10000, in_2119 = 80000, minutes_a_day = 1440, tolerance = 0.05;
  const double usual = usual_interval(times), minutes = usual * minutes_a_day;
  if (times.front() > in_1927 && times.back() < in_2119 && usual <= 1 && minutes > 0.5 &&
      std::abs(minutes - std::round(minutes)) < tolerance)
    log_warning(source + ": its times, " + number_text(times.front(), 10) + " … " +
                number_text(times.back(), 10) +
                ", are taken for seconds; if they are days of a spreadsheet, write them as dates such as "
                "2001-03-04T15:00");
}

/// Fills gaps with calm air or refuses them, as the format says, and tells the longest. Rows without a speed
/// at the end are a gap, too.
void treat_gaps(RowReader& read, const std::string& source, SeriesGap gap, ValidationErrors& errors) {
  std::vector<WindSeries::Row>& rows = read.rows;
  if (rows.empty() || read.all_times.size() < 2) return;
  const double usual = usual_interval(read.all_times), last = read.all_times.back();
  const auto end_of = [&](std::size_t n) { return n + 1 < rows.size() ? rows[n + 1].time : last + usual; };
  std::vector<WindSeries::Row> filled;
  std::size_t gaps = 0, longest = 0;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    filled.push_back(rows[n]);
    const double interval = end_of(n) - rows[n].time;
    if (interval <= usual_intervals * usual) continue;
    if (gaps++ == 0 || interval > end_of(longest) - rows[longest].time) longest = n;
    if (gap == SeriesGap::calm) filled.push_back({rows[n].time + usual, {}});
  }
  if (gaps == 0) return;
  const double from = rows[longest].time, length = end_of(longest) - from;
  const double speed = elementary::hypot(rows[longest].wind.x, rows[longest].wind.y);
  const std::string said = "has " + std::to_string(gaps) + (gaps == 1 ? " gap" : " gaps") +
                           " between its rows, the "
                           "longest of " +
                           TimeReader::length(length) + " after " + read.times.shown(from) +
                           " (the usual interval is " + TimeReader::length(usual) + ")";
  if (gap == SeriesGap::refuse) {
    errors.add("wind.series_gap", said + ", and gaps are refused");
    return;
  }
  log_warning(source + ": " + said + "; " +
              (gap == SeriesGap::calm ? "calm air fills them after one interval"
                                      : "the wind before each is held, there " + number_text(speed) +
                                            " m/s (wind.series_gap: hold; or calm, or refuse)"));
  if (filled.size() > max_series_rows)
    errors.add("wind.series_gap",
               "has more than " + std::to_string(max_series_rows) + " rows with its gaps filled");
  rows = std::move(filled);
}

}  // namespace

WindSeries parse_wind_series(const std::string& text, const std::string& source, const SeriesFormat& format) {
  ValidationErrors errors(source);
  RowReader read(format, errors);
  bool named = false;
  std::istringstream in(plain_lines(text, source));
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = line.substr(0, line.find('#'));
    if (trimmed(line).empty()) continue;
    const std::string key = "line " + std::to_string(number);
    if (!named) {
      read.read_columns(line, key);
      errors.throw_if_any();
      named = true;
      continue;
    }
    read.read_row(line, key);
    if (read.rows.size() > max_series_rows) {
      errors.add(key, "is one row too many (allowed: " + std::to_string(max_series_rows) + ")");
      break;
    }
  }
  if (!read.times.dates) check_seconds(read.all_times, source, errors);
  if (read.rows.empty())
    errors.add("file", read.missing > 0 ? "has no row with a speed" : "has no row of values");
  errors.throw_if_any();
  if (read.missing > 0)
    log_warning(source + ": " + std::to_string(read.missing) + " of " +
                std::to_string(read.rows.size() + static_cast<std::size_t>(read.missing)) +
                " rows have no speed, and are left out");
  treat_gaps(read, source, format.gap, errors);
  WindSeries series;
  series.rows = std::move(read.rows);
  const double start = start_of(series, read.times, format.start, errors);
  errors.throw_if_any();
  for (WindSeries::Row& row : series.rows) row.time -= start;
  if (read.times.dates) series.date = start;
  return series;
}

void read_wind_series(Scenario& s, const std::string& folder) {
  const WindRegimeParameters& wind = s.wind_regime;
  if (s.wind_series || wind.series_file.empty() || !s.run.start_from.empty()) return;
  const std::string path = raster_path(s, wind.series_file);
  const InputFile file(path, folder);
  if (file.size() > max_series_bytes)
    throw ConfigError(path + ": has " + std::to_string(file.size()) + " bytes (allowed: at most " +
                      std::to_string(max_series_bytes) + ")");
  s.wind_series = std::make_shared<const WindSeries>(parse_wind_series(
      file.read_all(), path, {wind.series_direction, wind.series_angle, wind.series_start, wind.series_gap}));
}

}  // namespace desert_sim

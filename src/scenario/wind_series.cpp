#include "src/scenario/wind_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <locale>
#include <sstream>

#include "src/core/input_file.hpp"
#include "src/core/number_text.hpp"
#include "src/core/quoted.hpp"
#include "src/scenario/sections.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

constexpr std::uint64_t max_series_bytes = std::uint64_t{1} << 26;
constexpr double max_series_speed = 100;  // [m/s], as of wind.speed

/// A number that is all of `text`; false if it is none, or not finite.
bool read_plain_number(const std::string& text, double& number) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  std::string more;
  return (in >> number) && !(in >> more) && std::isfinite(number);
}

std::string trimmed(const std::string& text) {
  const char* const blanks = " \t\r\"";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(trimmed(field));
  return fields;
}

/// Days since 1970-01-01 of a date in the Gregorian calendar: years begin in March here, so that the leap day
/// is their last.
long long days_of(long long year, int month, int day) {
  year -= month <= 2;
  const long long era = (year >= 0 ? year : year - 399) / 400, of_era = year - era * 400;
  const int of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

int days_in(long long year, int month) {
  constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return days[month - 1] + (month == 2 && leap ? 1 : 0);
}

/// Times of a file, in seconds or as dates: what its first one is, all must be.
struct TimeReader {
  bool dates = false, known = false;

  bool read(const std::string& text, double& time) {
    const std::optional<double> date = read_date(text);
    if (!date && !read_plain_number(text, time)) return false;
    if (date) time = *date;
    if (known && dates != date.has_value()) return false;
    dates = date.has_value();
    known = true;
    return true;
  }
  const char* expected() const {
    return !known ? "seconds or a date such as 2001-03-04T15:00"
                  : (dates ? "a date such as 2001-03-04T15:00" : "seconds, as in the rows before");
  }
  std::string shown(double time) const { return dates ? date_text(time) : number_text(time, 10) + " s"; }
};

/// Where the columns that count stand; -1: nowhere.
struct Columns {
  int time = -1, speed = -1, direction = -1;
};

Columns find_columns(const std::string& line, const std::string& key, ValidationErrors& errors) {
  Columns columns;
  const std::vector<std::string> names = fields_of(line);
  const auto find = [&](const char* name, int& column) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      errors.add(key, std::string("has no column '") + name +
                          "' (needed: time, speed, direction, separated by commas; found: " + line + ")");
    else
      column = static_cast<int>(found - names.begin());
  };
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

WindSeries::Row read_row(const std::string& line, const std::string& key, const Columns& columns,
                         const SeriesFormat& format, TimeReader& times, ValidationErrors& errors) {
  const std::vector<std::string> fields = fields_of(line);
  const auto field = [&](int column) {
    return column < static_cast<int>(fields.size()) ? fields[static_cast<std::size_t>(column)] : "";
  };
  double time = 0, speed = 0, direction = 0;
  if (!times.read(field(columns.time), time))
    errors.add(key + ", column time", quoted(field(columns.time)) + " is not " + times.expected());
  const auto number = [&](int column, const char* name, double lowest, double highest, const char* unit,
                          double& value) {
    if (!read_plain_number(field(column), value) || !(value >= lowest && value <= highest))
      errors.add(key + ", column " + name, quoted(field(column)) + " is not a number in [" +
                                               number_text(lowest) + ", " + number_text(highest) + "] " +
                                               unit);
  };
  number(columns.speed, "speed", 0, max_series_speed, "m/s", speed);
  number(columns.direction, "direction", -360, 360, "deg", direction);
  return {time, wind_vector(direction_to(direction, format), speed)};
}

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
    errors.add("wind.series_start", quoted(given) + " is not in [" + times.shown(first) + ", " +
                                        times.shown(last) + "], the times of the series");
  return start;
}

}  // namespace

std::optional<double> read_date(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0;
  double second = 0;
  const char* const at = text.c_str();
  if (std::sscanf(at, "%4d-%2d-%2d%n", &year, &month, &day, &used) != 3 || used < 8) return {};
  std::string rest = text.substr(static_cast<std::size_t>(used));
  if (!rest.empty() && rest.back() == 'Z') rest.pop_back();
  if (!rest.empty()) {
    int fields_used = 0;
    if (rest[0] != 'T' && rest[0] != ' ') return {};
    if (std::sscanf(rest.c_str() + 1, "%2d:%2d%n", &hour, &minute, &fields_used) != 2) return {};
    rest = rest.substr(static_cast<std::size_t>(fields_used) + 1);
    if (!rest.empty() && (rest[0] != ':' || !read_plain_number(rest.substr(1), second))) return {};
  }
  if (month < 1 || month > 12 || day < 1 || day > days_in(year, month) || hour < 0 || hour > 23 ||
      minute < 0 || minute > 59 || !(second >= 0 && second < 61))
    return {};
  return static_cast<double>(days_of(year, month, day)) * 86400 + hour * 3600 + minute * 60 + second;
}

std::string date_text(double date) {
  const auto whole = static_cast<long long>(std::floor(date));
  long long days = whole / 86400, left = whole % 86400;
  if (left < 0) left += 86400, --days;
  // The year is guessed from the mean length of one, and is right to one.
  long long year = 1970 + static_cast<long long>(std::floor(static_cast<double>(days) / 365.2425));
  while (days_of(year, 1, 1) > days) --year;
  while (days_of(year + 1, 1, 1) <= days) ++year;
  int month = 1;
  while (month < 12 && days_of(year, month + 1, 1) <= days) ++month;
  const long long day = days - days_of(year, month, 1) + 1;
  char text[64];
  std::snprintf(text, sizeof text, "%04lld-%02d-%02lld %02lld:%02lld:%02lld", year, month, day, left / 3600,
                left / 60 % 60, left % 60);
  return text;
}

wind::Vector WindSeries::at(double time, bool repeat) const {
  if (rows.size() > 1 && repeat) {
    const double last = rows.back().time, holds = last - rows[rows.size() - 2].time,
                 period = last + holds - rows.front().time;
    if (time >= last + holds) time = rows.front().time + std::fmod(time - rows.front().time, period);
  }
  const auto next =
      std::upper_bound(rows.begin(), rows.end(), time, [](double t, const Row& row) { return t < row.time; });
  return next == rows.begin() ? next->wind : std::prev(next)->wind;
}

double WindSeries::shortest_interval() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < rows.size(); ++n)
    shortest = std::min(shortest, rows[n].time - rows[n - 1].time);
  return shortest;
}

double WindSeries::fastest() const {
  double fastest = 0;
  for (const Row& row : rows)
    fastest = std::max(fastest, std::hypot(static_cast<double>(row.wind.x), static_cast<double>(row.wind.y)));
  return fastest;
}

std::string WindSeries::text() const {
  std::string all = date ? number_text(*date, 17) : "-";
  char line[80];
  for (const Row& row : rows) {
    std::snprintf(line, sizeof line, " %.17g,%.9g,%.9g", row.time, static_cast<double>(row.wind.x),
                  static_cast<double>(row.wind.y));
    all += line;
  }
  return all;
}

WindSeries WindSeries::from_text(const std::string& text, const std::string& source) {
  WindSeries series;
  std::istringstream in(text);
  std::string word;
  double date = 0;
  const auto refuse = [&source](const std::string& what) -> void {
    throw ConfigError(source + ": " + quoted(what) + " is not what a wind series has there");
  };
  if (!(in >> word) || (word != "-" && !read_plain_number(word, date))) refuse(word);
  if (word != "-") series.date = date;
  while (in >> word) {
    const std::vector<std::string> fields = fields_of(word);
    double time = 0, x = 0, y = 0;
    if (fields.size() != 3 || !read_plain_number(fields[0], time) || !read_plain_number(fields[1], x) ||
        !read_plain_number(fields[2], y) || !(std::hypot(x, y) <= max_series_speed + 1) ||
        (!series.rows.empty() && !(time > series.rows.back().time)))
      refuse(word);
    series.rows.push_back({time, {static_cast<float>(x), static_cast<float>(y)}});
  }
  if (series.rows.empty() || series.rows.size() > max_series_rows) refuse("no row, or too many");
  return series;
}

WindSeries parse_wind_series(const std::string& text, const std::string& source, const SeriesFormat& format) {
  ValidationErrors errors(source);
  WindSeries series;
  TimeReader times;
  std::optional<Columns> columns;
  std::istringstream in(text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    line = trimmed(line.substr(0, line.find('#')));
    if (line.empty()) continue;
    const std::string key = "line " + std::to_string(number);
    if (!columns) {
      columns = find_columns(line, key, errors);
      errors.throw_if_any();
      continue;
    }
    series.rows.push_back(read_row(line, key, *columns, format, times, errors));
    const std::size_t n = series.rows.size();
    if (n > 1 && !(series.rows[n - 1].time > series.rows[n - 2].time))
      errors.add(key + ", column time", times.shown(series.rows[n - 1].time) +
                                            " is not later than the row before, " +
                                            times.shown(series.rows[n - 2].time));
    if (n > max_series_rows) {
      errors.add(key, "is one row too many (allowed: " + std::to_string(max_series_rows) + ")");
      break;
    }
  }
  if (series.rows.empty()) errors.add("file", "has no row of values");
  errors.throw_if_any();
  const double start = start_of(series, times, format.start, errors);
  errors.throw_if_any();
  for (WindSeries::Row& row : series.rows) row.time -= start;
  if (times.dates) series.date = start;
  return series;
}

void read_wind_series(Scenario& s, const std::string& folder) {
  const WindRegimeParameters& wind = s.wind_regime;
  if (s.wind_series || wind.series_file.empty()) return;
  const std::string path = raster_path(s, wind.series_file);
  const InputFile file(path, folder);
  if (file.size() > max_series_bytes)
    throw ConfigError(path + ": has " + std::to_string(file.size()) + " bytes (allowed: at most " +
                      std::to_string(max_series_bytes) + ")");
  s.wind_series = std::make_shared<const WindSeries>(parse_wind_series(
      file.read_all(), path, {wind.series_direction, wind.series_angle, wind.series_start}));
}

}  // namespace desert_sim

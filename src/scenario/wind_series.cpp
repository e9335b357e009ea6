#include "src/scenario/wind_series.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>

#include "src/core/csv.hpp"
#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace {

/// Days since 1970-01-01 of a date in the Gregorian calendar: years begin in March here, so that the leap day
/// is their last.
long long days_of(long long year, int month, int day) {
  year -= month <= 2;
  const long long era = (year >= 0 ? year : year - 399) / 400, of_era = year - era * 400;
  const int of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return era * 146097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719468;
}

/// Takes Z, +02:00 or -0330 from the end of a time of day: seconds by which its clock is ahead of UTC.
/// Nothing for one that is out of range.
std::optional<double> take_distance_from_utc(std::string& time) {
  if (!time.empty() && time.back() == 'Z') time.pop_back();
  const std::size_t at = time.find_first_of("+-");
  if (at == std::string::npos) return 0;
  int hours = 0, minutes = 0, used = 0;
  const std::string distance = time.substr(at + 1);
  const bool read = std::sscanf(distance.c_str(), "%2d:%2d%n", &hours, &minutes, &used) == 2 ||
                    std::sscanf(distance.c_str(), "%2d%2d%n", &hours, &minutes, &used) == 2;
  if (!read || static_cast<std::size_t>(used) != distance.size() || hours < 0 || hours > 14 || minutes < 0 ||
      minutes > 59)
    return {};
  const double seconds = hours * 3600.0 + minutes * 60.0;
  const double ahead = time[at] == '+' ? seconds : -seconds;
  time.resize(at);
  return ahead;
}

int days_in(long long year, int month) {
  constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return days[month - 1] + (month == 2 && leap ? 1 : 0);
}

}  // namespace

std::optional<double> read_date(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, used = 0;
  double second = 0;
  const char* const at = text.c_str();
  if (std::sscanf(at, "%4d-%2d-%2d%n", &year, &month, &day, &used) != 3 || used < 8) return {};
  std::string rest = text.substr(static_cast<std::size_t>(used));
  const std::optional<double> ahead = take_distance_from_utc(rest);
  if (!ahead) return {};
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
  return static_cast<double>(days_of(year, month, day)) * 86400 + hour * 3600 + minute * 60 + second - *ahead;
}

std::optional<double> date_of_number(double number) {
  if (!(number >= 19000101 && number < 1e12) || number != std::floor(number)) return {};
  std::string text = number_text(number, 17);
  if (text.size() != 8 && text.size() != 10 && text.size() != 12) return {};
  if (text < "1900" || text >= "2101") return {};
  std::string date = text.substr(0, 4) + "-" + text.substr(4, 2) + "-" + text.substr(6, 2);
  if (text.size() > 8) date += "T" + text.substr(8, 2) + ":" + (text.size() > 10 ? text.substr(10, 2) : "00");
  return read_date(date);
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
  for (const Row& row : rows) fastest = std::max(fastest, elementary::hypot(row.wind.x, row.wind.y));
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
    throw ConfigError(source + ": " + in_quotes(what) + " is not what a wind series has there");
  };
  if (!(in >> word) || (word != "-" && !read_plain_number(word, date))) refuse(word);
  if (word != "-") series.date = date;
  while (in >> word) {
    const std::vector<std::string> fields = csv_fields(word, ',');
    double time = 0, x = 0, y = 0;
    if (fields.size() != 3 || !read_plain_number(fields[0], time) || !read_plain_number(fields[1], x) ||
        !read_plain_number(fields[2], y) || !(elementary::hypot(x, y) <= max_series_speed + 1) ||
        (!series.rows.empty() && !(time > series.rows.back().time)))
      refuse(word);
    series.rows.push_back({time, {static_cast<float>(x), static_cast<float>(y)}});
  }
  if (series.rows.empty() || series.rows.size() > max_series_rows) refuse("no row, or too many");
  return series;
}

}  // namespace desert_sim

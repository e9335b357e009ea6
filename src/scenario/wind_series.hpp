#pragma once
/// A measured series of the wind: read from a CSV file once (wind_series_file.hpp), when a session begins
/// with its scenario. After that it belongs to the scenario and to checkpoints, which need the file no
/// longer.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/wind/vector.hpp"

namespace desert_sim {

/// Whether a series says where the wind blows to, or where it comes from, as meteorologists do.
enum class SeriesDirection : int { to, from };
constexpr const char* series_direction_names[] = {"to", "from"};

/// Counter-clockwise from +x (east), or clockwise from +y (north).
enum class SeriesAngle : int { mathematical, compass };
constexpr const char* series_angle_names[] = {"mathematical", "compass"};

/// What blows where a series has no row for longer than usual: the last row's wind, none, or the series is
/// refused.
enum class SeriesGap : int { hold, calm, refuse };
constexpr const char* series_gap_names[] = {"hold", "calm", "refuse"};

constexpr std::size_t max_series_rows = std::size_t{1} << 20;
constexpr double max_series_speed = 100;  // [m/s], as of wind.speed

struct WindSeries {
  struct Row {
    double time;  ///< since the simulation's start [s]; may be negative
    wind::Vector wind;
  };
  std::vector<Row> rows;       ///< at least one, in order of time
  std::optional<double> date;  ///< of the simulation's start, in seconds since 1970-01-01 UTC, where known

  /// The wind of the last row that is not later than `time` [s since the start]. Before the first row it is
  /// the first one's. After the last row has held for as long as the one before it, the series starts again
  /// at its first row, or, without `repeat`, the last row holds on.
  wind::Vector at(double time, bool repeat) const;
  double shortest_interval() const;  ///< between rows [s]; infinite if there is only one
  double fastest() const;            ///< [m/s]

  /// All of it as text, to the bit, and back. from_text() throws ConfigError in the name of `source`.
  std::string text() const;
  static WindSeries from_text(const std::string& text, const std::string& source);
};

/// Seconds since 1970-01-01 UTC of a date, with or without a time of day and its distance from UTC (Z,
/// +02:00); empty if `text` is none.
std::optional<double> read_date(const std::string& text);
/// The date that a number such as 20010304, 2001030415 or 200103041500 is, of the years 1900 to 2100; empty
/// if it is none.
std::optional<double> date_of_number(double number);
/// "2001-03-04 15:00:00".
std::string date_text(double date);

}  // namespace desert_sim

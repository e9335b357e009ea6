#pragma once
/// Reads a series of the wind from a CSV file.
///
/// The first line names the columns, of which `time`, `speed` [m/s] and `direction` [deg] count, in upper or
/// lower case. They are separated by commas, semicolons or tabs; with the latter two a number may have a
/// decimal comma. Times rise from row to row; they are seconds, or dates such as 2001-03-04T15:00, 2001-03-04
/// 15:00:30 (UTC) or 2001-03-04T15:00+02:00. Empty lines and what follows a # are skipped. Air of speed 0
/// needs no direction. A row whose speed is missing (empty, NA, NaN) is none: the gap that it leaves is
/// treated as series_gap says.

#include <string>

#include "src/scenario/wind_series.hpp"

namespace desert_sim {

struct Scenario;

struct SeriesFormat {
  SeriesDirection direction;
  SeriesAngle angle;
  std::string start =
      {};  ///< time or date of the file at which the simulation starts; empty: the first row's
  SeriesGap gap = SeriesGap::hold;
};

/// Reads a file's text. Throws ConfigError that lists faults with `source`, line, column and value. Logs a
/// warning that names the longest gap, if one is longer than 1.5 times the usual (median) interval between
/// rows.
WindSeries parse_wind_series(const std::string& text, const std::string& source, const SeriesFormat& format);

/// Reads the series that the scenario names, unless it has it already or begins with a checkpoint, which has
/// it; with a `folder`, only from below it.
void read_wind_series(Scenario& scenario, const std::string& folder = "");

}  // namespace desert_sim

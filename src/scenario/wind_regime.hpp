#pragma once
/// The wind high above the ground as a function of time: constant (after a ramp), a timeline of segments, a
/// wind rose, or a measured series. A direction is the one towards which the air moves, counter-clockwise
/// from +x (east).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "kernels/wind/vector.hpp"
#include "src/core/parameter_table.hpp"
#include "src/scenario/wind_series.hpp"

namespace desert_sim {

class ValidationErrors;

enum class WindRegimeKind : int { constant, timeline, rose, series };
constexpr const char* wind_regime_kind_names[] = {"constant", "timeline", "rose", "series"};

/// One entry of a timeline, or one direction of a rose.
struct WindSegment {
  float direction_deg = 0;
  float speed = 5;
  float duration = 100;
  float ramp = 0;
  float probability = 1;
};

constexpr auto parameter_table(const WindSegment*) {
  using P = WindSegment;
  return std::make_tuple(
      parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                "Where the wind blows to, counter-clockwise from +x."),
      parameter("speed", &P::speed, 0, 100, "m/s", "Speed high above the ground."),
      parameter("duration", &P::duration, 1e-3, 1e12, "s",
                "How long a segment of a timeline lasts, its ramp included."),
      parameter("ramp", &P::ramp, 0, 1e12, "s",
                "Time in which the wind turns to this segment from the one before."),
      parameter("probability", &P::probability, 0, 1e6, "1", "Weight of this direction in a rose."));
}
static_assert(table_is_complete<WindSegment>());

/// The parts of a regime that are plain parameters (section `wind` of a scenario, next to WindParameters).
struct WindRegimeParameters {
  WindRegimeKind regime = WindRegimeKind::constant;
  float direction_deg = 0;
  float speed = 5;
  float ramp = 0;
  bool repeat = true;
  float hold_time = 50;
  std::uint64_t rose_seed = 1;
  std::string series_file{};
  SeriesDirection series_direction = SeriesDirection::to;
  SeriesAngle series_angle = SeriesAngle::mathematical;
  std::string series_start{};
  SeriesGap series_gap = SeriesGap::hold;
};

constexpr auto parameter_table(const WindRegimeParameters*) {
  using P = WindRegimeParameters;
  return std::make_tuple(
      parameter(
          "regime", &P::regime, wind_regime_kind_names,
          "constant; timeline: `segments` in turn; rose: one of `segments` drawn every hold_time; series: "
          "the rows of series_file, each until the next one's time."),
      parameter("direction_deg", &P::direction_deg, -360, 360, "deg",
                "Where the constant wind blows to, counter-clockwise from +x."),
      parameter("speed", &P::speed, 0, 100, "m/s", "Speed of the constant wind high above the ground."),
      parameter("ramp", &P::ramp, 0, 1e12, "s",
                "Time in which the constant wind rises, or turns from the one before."),
      parameter("repeat", &P::repeat,
                "Whether a timeline or series starts again at its end; otherwise its last entry stays."),
      parameter("hold_time", &P::hold_time, 1e-3, 1e12, "s", "How long a rose keeps a direction."),
      parameter("rose_seed", &P::rose_seed, 0, highest_uint64, "1", "Seed of the random draws of a rose."),
      parameter("series_file", &P::series_file,
                "CSV file with the columns time (seconds, or dates such as 2001-03-04T15:00 in UTC), speed "
                "[m/s] and direction [deg] of a regime `series`."),
      parameter("series_direction", &P::series_direction, series_direction_names,
                "Whether its directions say where the wind blows to, or from where."),
      parameter("series_angle", &P::series_angle, series_angle_names,
                "mathematical: counter-clockwise from +x; compass: clockwise from +y (north)."),
      parameter("series_start", &P::series_start,
                "Time or date of the series at which the simulation starts; if not given, that of its first "
                "row."),
      parameter("series_gap", &P::series_gap, series_gap_names,
                "Where the series has no row for more than 1.5 times its usual (median) interval: hold: the "
                "last row "
                "blows on; calm: none does, after one interval; refuse: the series is refused."));
}
static_assert(table_is_complete<WindRegimeParameters>());

constexpr std::size_t max_wind_segments = 4096;

/// Adds an error for each condition that a regime of this kind and its segments break together; `key` is that
/// of the list of segments. The ranges of the segments' parameters are checked elsewhere.
void check_wind_segments(WindRegimeKind kind, const std::vector<WindSegment>& segments,
                         const std::string& key, ValidationErrors& errors);

/// A wind regime with its segments and the state from which it began.
struct WindRegime : WindRegimeParameters {
  std::vector<WindSegment> segments{};         ///< segments of a timeline, or directions of a rose
  std::shared_ptr<const WindSeries> series{};  ///< of a regime `series`
  double start_time = 0;        ///< simulated time at which it began, or would have with its hold_time [s]
  wind::Vector initial_wind{};  ///< wind at start_time, from which the first ramp starts

  /// The wind at simulated time `time` [s]. A timeline that does not repeat holds its last segment.
  wind::Vector at(double time) const;
  /// The regime with other parameters from `time` [s] on. A timeline or rose stays where it is in its course;
  /// its parameters may change at every step. A constant wind turns from the present one if its direction,
  /// speed or ramp has changed.
  WindRegime with(const WindRegimeParameters& changed, double time) const;
};

/// Unit vector of a direction, exact for multiples of 90 degrees.
wind::Vector unit_vector(double direction_deg);
wind::Vector wind_vector(double direction_deg, double speed);
/// Speed and direction [deg, −180…180] of a vector.
void speed_and_direction(wind::Vector w, double& speed, double& direction_deg);

}  // namespace desert_sim

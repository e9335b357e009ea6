#include "src/scenario/wind_regime.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/field/random.hpp"
#include "src/core/elementary.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

wind::Vector segment_wind(const WindSegment& s) { return wind_vector(s.direction_deg, s.speed); }

/// Linear interpolation from `a` to `b` after `elapsed` of `ramp` seconds.
wind::Vector interpolate_ramp(wind::Vector a, wind::Vector b, double elapsed, double ramp) {
  if (ramp <= 0 || elapsed >= ramp) return b;
  const double t = elapsed / ramp;
  return {static_cast<float>(a.x + t * (b.x - a.x)), static_cast<float>(a.y + t * (b.y - a.y))};
}

}  // namespace

wind::Vector unit_vector(double direction_deg) {
  const auto [x, y] = elementary::direction_deg(direction_deg);
  return {static_cast<float>(x), static_cast<float>(y)};
}

wind::Vector wind_vector(double direction_deg, double speed) {
  const wind::Vector u = unit_vector(direction_deg);
  return {static_cast<float>(u.x * speed), static_cast<float>(u.y * speed)};
}

void speed_and_direction(wind::Vector w, double& speed, double& direction_deg) {
  speed = elementary::hypot(w.x, w.y);
  direction_deg = speed > 0 ? elementary::atan2_deg(w.y, w.x) : 0;
}

void check_wind_segments(WindRegimeKind kind, const std::vector<WindSegment>& segments,
                         const std::string& key, ValidationErrors& errors) {
  if (segments.size() > max_wind_segments)
    errors.add(key, std::to_string(segments.size()) + " entries are given (allowed: at most " +
                        std::to_string(max_wind_segments) + ")");
  const bool needs_segments = kind == WindRegimeKind::timeline || kind == WindRegimeKind::rose;
  if (needs_segments && segments.empty())
    errors.add(key, std::string("a ") + wind_regime_kind_names[static_cast<int>(kind)] +
                        " needs at least one segment");
  float probability = 0;
  for (std::size_t n = 0; n < segments.size(); ++n) {
    if (segments[n].ramp > segments[n].duration)
      errors.add(key + "." + std::to_string(n) + ".ramp", "is longer than the segment's duration");
    probability += segments[n].probability;
  }
  if (kind == WindRegimeKind::rose && !segments.empty() && !(probability > 0))
    errors.add(key, "the probabilities of a rose must not all be 0");
}

WindRegime WindRegime::with(const WindRegimeParameters& changed, double time) const {
  WindRegime next = *this;
  static_cast<WindRegimeParameters&>(next) = changed;
  const bool constant = changed.regime == WindRegimeKind::constant;
  const bool turns = changed.direction_deg != direction_deg || changed.speed != speed || changed.ramp != ramp;
  if (changed.regime == WindRegimeKind::series) {
    next.start_time = 0;  // its times are those of the simulation
  } else if (changed.regime != regime || (constant && turns)) {
    next.initial_wind = at(time);
    next.start_time = time;
  } else if (changed.hold_time != hold_time) {
    next.start_time = time - (time - start_time) / hold_time * changed.hold_time;
  }
  return next;
}

wind::Vector WindRegime::at(double time) const {
  const double elapsed = std::max(0.0, time - start_time);
  if (regime == WindRegimeKind::constant)
    return interpolate_ramp(initial_wind, wind_vector(direction_deg, speed), elapsed, ramp);
  if (regime == WindRegimeKind::rose) {
    const auto draw_index = static_cast<std::uint64_t>(std::min(elapsed / hold_time, 0x1p63));
    double total = 0;
    for (const WindSegment& s : segments) total += s.probability;
    double draw = total * random_unit(rose_seed, Purpose::wind_rose, static_cast<std::uint32_t>(draw_index),
                                      static_cast<std::uint32_t>(draw_index >> 32));
    for (const WindSegment& s : segments) {
      draw -= s.probability;
      if (draw < 0) return segment_wind(s);
    }
    return segment_wind(segments.back());
  }
  if (regime == WindRegimeKind::series) return series ? series->at(elapsed, repeat) : initial_wind;
  double length = 0;
  for (const WindSegment& s : segments) length += s.duration;
  double t = elapsed;
  bool first_round = true;
  if (repeat && t >= length) {
    t = std::fmod(t, length);
    first_round = false;
  }
  wind::Vector before = first_round ? initial_wind : segment_wind(segments.back());
  for (const WindSegment& s : segments) {
    if (t < s.duration) return interpolate_ramp(before, segment_wind(s), t, s.ramp);
    t -= s.duration;
    before = segment_wind(s);
  }
  return segment_wind(segments.back());
}

}  // namespace desert_sim

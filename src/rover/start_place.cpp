#include "src/rover/start_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

constexpr double lengths = 3;        // that it drives ahead, and back
constexpr double longest_test = 60;  // [s], of a slow rover
constexpr double interval = 0.2;     // between two looks at the copy [s]

bool is_well(RoverCondition condition) {
  return condition == RoverCondition::idle || condition == RoverCondition::driving;
}

double length_of(const RoverParameters& p) { return std::max(p.wheelbase, p.body_length); }

/// Drives a copy of a rover that stands; why it does not get as far as `way` [m], or empty.
std::string why_it_stops(Rover rover, double speed, double way, const GroundSource& ground) {
  const RoverState start = rover.state();
  const auto made = [&] {
    return std::hypot(rover.state().pose.x - start.pose.x, rover.state().pose.y - start.pose.y);
  };
  const double time = std::min(longest_test, 4 * way / std::abs(speed));
  rover.drive({speed, 0, 0}, time);
  for (double t = 0; t < time && made() < way; t += interval) {
    rover.advance(interval, &ground);
    if (!is_well(rover.state().condition)) return rover.state().reason;
  }
  return made() < way ? "it only made " + number_text(made()) + " m of " + number_text(way) + " m in " +
                            number_text(time) + " s"
                      : "";
}

/// Cheaper than start_problem(), for places that are plainly none: unknown, under water, occupied, or steep.
bool may_be_a_start(const RoverParameters& p, double x, double y, const GroundSource& ground) {
  const double half = p.wheelbase / 2;
  const auto east = ground.elevation(x + half, y), west = ground.elevation(x - half, y),
             north = ground.elevation(x, y + half), south = ground.elevation(x, y - half);
  if (!east || !west || !north || !south) return false;
  const double tangent = std::hypot(*east - *west, *north - *south) / p.wheelbase;
  if (tangent > std::tan(std::min(p.tip_roll_deg, p.tip_pitch_deg) * pi / 180)) return false;
  const GroundPoint point = ground.at(x, y);
  return !(point.obstacle > 0) && point.water <= p.max_water;
}

}  // namespace

std::string start_problem(const Rover& rover, double x, double y, double yaw, const GroundSource& ground) {
  Rover copy = rover;
  try {
    copy.reset(x, y, yaw, ground);
  } catch (const ConfigError& e) {
    return e.what();
  }
  const RoverParameters& p = rover.parameters();
  const double way = lengths * length_of(p);
  const std::string ahead = why_it_stops(copy, p.max_speed, way, ground);
  if (!ahead.empty()) return "driving ahead, " + ahead;
  const std::string back = why_it_stops(copy, -p.max_speed, way, ground);
  return back.empty() ? "" : "driving back, " + back;
}

std::optional<StartPlace> nearest_start(const Rover& rover, const StartArea& area, double yaw,
                                        const GroundSource& ground) {
  const double spacing = length_of(rover.parameters());
  const int across = static_cast<int>(area.width / 2 / spacing),
            along = static_cast<int>(area.height / 2 / spacing);
  std::optional<StartPlace> best;
  double nearest = std::numeric_limits<double>::infinity();
  const auto consider = [&](int i, int j) {
    const double distance = spacing * std::hypot(i, j), x = area.x + spacing * i, y = area.y + spacing * j;
    if (std::abs(i) > across || std::abs(j) > along || distance >= nearest) return;
    if (!may_be_a_start(rover.parameters(), x, y, ground) || !start_problem(rover, x, y, yaw, ground).empty())
      return;
    best = StartPlace{x, y};
    nearest = distance;
  };
  // Square after square around the middle, until all that follow are farther away than what is found.
  for (int ring = 0; ring <= std::max(across, along) && spacing * ring < nearest; ++ring) {
    for (int n = -ring; n <= ring; ++n) {
      consider(n, -ring);
      if (ring > 0) consider(n, ring);
    }
    for (int n = 1 - ring; n <= ring - 1; ++n) {
      consider(-ring, n);
      consider(ring, n);
    }
  }
  return best;
}

}  // namespace desert_sim

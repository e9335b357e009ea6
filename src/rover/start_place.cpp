#include "src/rover/start_place.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

constexpr double lengths = 3;        // that it drives ahead, and back
constexpr double longest_test = 60;  // [s], of a slow rover
constexpr double wide_room = 10;     // lengths of free ground around it
constexpr double gentle_deg = 20;    // steepest free ground
constexpr double interval = 0.2;     // between two looks at the copy [s]

bool is_well(RoverCondition condition) {
  return condition == RoverCondition::idle || condition == RoverCondition::driving;
}

double length_of(const RoverParameters& p) { return std::max(p.wheelbase, p.body_length); }

/// Drives a copy of a rover that stands; why it does not get as far as `way` [m], or empty.
std::string why_it_stops(Rover rover, double speed, double way, const GroundSource& ground) {
  const RoverState start = rover.state();
  const auto made = [&] {
    return elementary::hypot(rover.state().pose.x - start.pose.x, rover.state().pose.y - start.pose.y);
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

/// Whether the ground is known, dry, unoccupied and gentle at all points within `room` [m], on a raster.
/// Cheaper than start_problem().
bool is_free_ground(const RoverParameters& p, double x, double y, double room, const GroundSource& ground) {
  const double half = length_of(p) / 2, steepest = elementary::tan_deg(gentle_deg);
  const int count = static_cast<int>(room / (2 * half));
  for (int j = -count; j <= count; ++j) {
    for (int i = -count; i <= count; ++i) {
      const double px = x + 2 * half * i, py = y + 2 * half * j;
      const auto east = ground.elevation(px + half, py), west = ground.elevation(px - half, py),
                 north = ground.elevation(px, py + half), south = ground.elevation(px, py - half);
      if (!east || !west || !north || !south) return false;
      if (elementary::hypot(*east - *west, *north - *south) > steepest * 2 * half) return false;
      const GroundPoint point = ground.at(px, py);
      if (point.obstacle > 0 || point.water > p.max_water || point.flow() > p.max_flow) return false;
    }
  }
  return true;
}

/// The nearest place with so much room, in the middle of a raster whose spacing is the rover's length.
std::optional<StartPlace> nearest_with_room(const Rover& rover, const StartArea& area, double yaw,
                                            double room, const GroundSource& ground) {
  const double spacing = length_of(rover.parameters());
  const int across = static_cast<int>(area.width / 2 / spacing),
            along = static_cast<int>(area.height / 2 / spacing);
  std::optional<StartPlace> best;
  double nearest = std::numeric_limits<double>::infinity();
  const auto consider = [&](int i, int j) {
    const double distance = spacing * elementary::hypot(i, j), x = area.x + spacing * i,
                 y = area.y + spacing * j;
    if (std::abs(i) > across || std::abs(j) > along || distance >= nearest) return;
    if (!is_free_ground(rover.parameters(), x, y, room, ground)) return;
    if (!start_problem(rover, x, y, yaw, ground).empty()) return;
    best = StartPlace{x, y, room};
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
  for (const double room : {wide_room * length_of(rover.parameters()), 0.0})
    if (const auto place = nearest_with_room(rover, area, yaw, room, ground)) return place;
  return std::nullopt;
}

Start choose_start(const Rover& rover, const StartArea& area, std::optional<double> x,
                   std::optional<double> y, double yaw, const GroundSource& ground) {
  const StartPlace asked{x.value_or(area.x), y.value_or(area.y), 0};
  if (x || y) {
    const std::string problem = start_problem(rover, asked.x, asked.y, yaw, ground);
    return {asked, problem.empty() ? "" : "it may not be able to drive off: " + problem, !problem.empty()};
  }
  const std::optional<StartPlace> free = nearest_start(rover, area, yaw, ground);
  if (!free) return {asked, "the terrain has no place from which it could drive ahead and back", true};
  const double distance = elementary::hypot(free->x - area.x, free->y - area.y);
  if (distance == 0) return {*free, "", false};
  return {*free, "the nearest free ground, " + number_text(distance) + " m from the middle of the terrain",
          false};
}

}  // namespace desert_sim

#include "src/render/stroke_path.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim::render {

namespace {

double distance_to_segment(const Place& p, const Capsule& axis) {
  const double dx = axis.to.x - axis.from.x, dy = axis.to.y - axis.from.y, square = dx * dx + dy * dy;
  const double along =
      square > 0 ? std::clamp(((p.x - axis.from.x) * dx + (p.y - axis.from.y) * dy) / square, 0.0, 1.0) : 0;
  return distance(p, {axis.from.x + along * dx, axis.from.y + along * dy});
}

/// A capsule joins at most so many places, since the time to find it grows with their square. A mouse needs
/// two seconds for them.
constexpr std::size_t most_places = 256;

/// So many pieces may wait; of a longer path they are longer, so that the newest place is never far behind.
constexpr double most_pieces = 64;

/// The point between `from` and `to` that is `length` from `start`, where the first one is nearer and the
/// second one is not.
Place at_distance(const Place& start, double length, const Place& from, const Place& to) {
  const double dx = to.x - from.x, dy = to.y - from.y, square = dx * dx + dy * dy;
  const double x = from.x - start.x, y = from.y - start.y, along = x * dx + y * dy;
  const double root = std::sqrt(std::max(0.0, along * along + square * (length * length - x * x - y * y)));
  const double part = std::clamp((root - along) / square, 0.0, 1.0);
  return {from.x + part * dx, from.y + part * dy};
}

/// Whether a capsule to `end` leaves none of the places before number `count` further than `tolerance`.
bool covers(const std::deque<Place>& places, std::size_t count, const Place& end, double tolerance) {
  const Capsule axis{places.front(), end};
  return std::all_of(places.begin() + 1, places.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Place& place) { return distance_to_segment(place, axis) <= tolerance; });
}

}  // namespace

double share_of_depth(const Capsule& capsule, double radius, double inner) {
  const double length = capsule.length();
  return length > 0 ? length / (length + radius * (1 + inner)) : 1;
}

double share_of_area(const Capsule& capsule, double radius) {
  const double length = capsule.length();
  return length > 0 ? 2 * length / (2 * length + pi * radius) : 1;
}

void StrokePath::add(const Place& place) {
  if (lines_.empty() || lines_.back().closed) lines_.emplace_back();
  std::deque<Place>& places = lines_.back().places;
  if (places.empty() || distance(places.back(), place) > 0) places.push_back(place);
}

void StrokePath::lift() {
  if (!lines_.empty()) lines_.back().closed = true;
}

void StrokePath::end() {
  lift();
  ended_ = true;
}

std::optional<Capsule> StrokePath::take() {
  while (!lines_.empty()) {
    Line& line = lines_.front();
    if (line.places.size() == 1) {
      if (!line.closed) return std::nullopt;
      const Place only = line.places.front();
      const bool is_circle = !line.begun;
      lines_.pop_front();
      if (is_circle) return Capsule{only, only};
      continue;
    }
    const std::optional<Place> end = cut(line);
    if (!end) return std::nullopt;
    const Capsule capsule{line.places.front(), *end};
    line.places.front() = *end;
    line.begun = true;
    return capsule;
  }
  return std::nullopt;
}

std::optional<Place> StrokePath::cut(Line& line) const {
  std::deque<Place>& places = line.places;
  const auto passed = [&](std::size_t count) {
    places.erase(places.begin() + 1, places.begin() + static_cast<std::ptrdiff_t>(count));
  };
  const double length = std::max(piece_, waiting() / most_pieces);
  for (std::size_t n = 1; n < places.size(); ++n) {
    std::optional<Place> end;
    if (n > 1 && (n > most_places || !covers(places, n, places[n], tolerance_)))
      end = places[n - 1];  // the path turns here
    else if (distance(places.front(), places[n]) >= length)
      end = at_distance(places.front(), length, places[n - 1], places[n]);
    if (!end) continue;
    passed(distance(*end, places[n]) > 0 ? n : n + 1);
    return end;
  }
  if (!line.closed) return std::nullopt;
  const Place end = places.back();
  passed(places.size());
  return end;
}

double StrokePath::waiting() const {
  double sum = 0;
  for (const Line& line : lines_)
    for (std::size_t n = 1; n < line.places.size(); ++n) sum += distance(line.places[n - 1], line.places[n]);
  return sum;
}

}  // namespace desert_sim::render

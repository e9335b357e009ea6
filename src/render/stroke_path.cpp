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

/// The last place to which one capsule can go from the first one; at least the second.
std::size_t reach(const std::deque<Place>& places, double tolerance) {
  std::size_t last = 1;
  for (std::size_t n = 2; n < std::min(places.size(), most_places); ++n) {
    const Capsule axis{places.front(), places[n]};
    for (std::size_t m = 1; m < n; ++m)
      if (distance_to_segment(places[m], axis) > tolerance) return last;
    last = n;
  }
  return last;
}

}  // namespace

double share_of_depth(const Capsule& capsule, double radius, double inner) {
  const double length = capsule.length();
  return length > 0 ? length / (length + radius * (1 + inner)) : 1;
}

double share_of_area(const Capsule& capsule, double radius) {
  constexpr double pi = 3.14159265358979323846;
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
    std::deque<Place>& places = line.places;
    if (places.size() == 1) {
      if (!line.closed) return std::nullopt;
      const Place only = places.front();
      const bool is_circle = !line.begun;
      lines_.pop_front();
      if (is_circle) return Capsule{only, only};
      continue;
    }
    const std::size_t last = reach(places, tolerance_);
    const Capsule capsule{places.front(), places[last]};
    const bool may_grow = !line.closed && last + 1 == places.size();
    if (may_grow && capsule.length() < least_) return std::nullopt;
    places.erase(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(last));
    line.begun = true;
    return capsule;
  }
  return std::nullopt;
}

}  // namespace desert_sim::render

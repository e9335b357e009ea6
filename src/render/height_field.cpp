#include "src/render/height_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace desert_sim::render {

double distance(const Place& a, const Place& b) { return std::hypot(b.x - a.x, b.y - a.y); }

double HeightField::height_at(const Place& place) const {
  if (!(place.x >= 0 && place.x <= width * cell_size && place.y >= 0 && place.y <= height * cell_size))
    return std::numeric_limits<double>::quiet_NaN();
  const double u = std::clamp(place.x / cell_size - 0.5, 0.0, width - 1.0),
               v = std::clamp(place.y / cell_size - 0.5, 0.0, height - 1.0);
  const int west = static_cast<int>(u), south = static_cast<int>(v);
  const int east = std::min(west + 1, width - 1), north = std::min(south + 1, height - 1);
  const double a = u - west, b = v - south;
  const auto between = [](double from, double to, double share) { return from + share * (to - from); };
  return between(between(static_cast<double>(at(west, south)), static_cast<double>(at(east, south)), a),
                 between(static_cast<double>(at(west, north)), static_cast<double>(at(east, north)), a), b);
}

}  // namespace desert_sim::render

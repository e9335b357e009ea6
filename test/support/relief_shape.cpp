#include "test/support/relief_shape.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim {

double Steepest::towards(double direction) const {
  const auto near = std::count_if(directions_deg.begin(), directions_deg.end(),
                                  [&](double d) { return angle_between_deg(d, direction) <= 60; });
  return directions_deg.empty() ? 0 : static_cast<double>(near) / static_cast<double>(directions_deg.size());
}

Steepest steepest(const Field& elevation, double sigma, double share) {
  const Slopes s = slopes(smoothed(elevation, sigma));
  Steepest result;
  result.slope_deg = quantile({s.slope_deg.begin(), s.slope_deg.end()}, 1 - share);
  double x = 0, y = 0;
  for (std::size_t i = 0; i < s.slope_deg.size(); ++i) {
    if (static_cast<double>(s.slope_deg[i]) < result.slope_deg) continue;
    const auto direction = static_cast<double>(s.direction_deg[i]);
    result.directions_deg.push_back(direction);
    x += std::cos(direction * degree);
    y += std::sin(direction * degree);
  }
  result.direction_deg = direction_of(x, y);
  result.coherence = std::hypot(x, y) / static_cast<double>(result.directions_deg.size());
  return result;
}

Crescents crescents(const Field& elevation, double sigma) {
  const Field relief = smoothed(elevation, sigma);
  const double cell = relief.cell_size;
  const auto slope = [&](int x, int y) {
    return std::pair((relief.at(x + 1, y) - relief.at(x - 1, y)) / (2 * cell),
                     (relief.at(x, y + 1) - relief.at(x, y - 1)) / (2 * cell));
  };
  const auto fall = [&](int x, int y) {  // unit vector down the slope
    const auto [sx, sy] = slope(x, y);
    const double steepness = std::max(std::hypot(sx, sy), 1e-12);
    return std::pair(-sx / steepness, -sy / steepness);
  };
  std::vector<double> steepness;
  double squares = 0, cubes = 0;  // the mean slope of a periodic relief is 0
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const auto [sx, sy] = slope(x, y);
      steepness.push_back(std::hypot(sx, sy));
      squares += sx * sx;
      cubes += sx * sx * sx;
    }
  const double n = static_cast<double>(steepness.size()), least = quantile(steepness, 0.95);
  Crescents c;
  c.skewness = cubes / n / std::pow(squares / n, 1.5);
  double lee = 0, stoss = 0;
  for (int y = 0; y < relief.height; ++y)
    for (int x = 0; x < relief.width; ++x) {
      const double east = fall(x, y).first;
      if (steepness[relief.index(x, y)] < least || std::abs(east) < 0.5) continue;
      const double divergence =
          (fall(x + 1, y).first - fall(x - 1, y).first + fall(x, y + 1).second - fall(x, y - 1).second) /
          (2 * cell);
      (east > 0 ? c.lee_divergence : c.stoss_divergence) += divergence;
      (east > 0 ? lee : stoss) += 1;
    }
  c.lee_divergence /= std::max(lee, 1.0);
  c.stoss_divergence /= std::max(stoss, 1.0);
  return c;
}

int arms(const Field& elevation, double x, double y, double radius, double dip, double sigma) {
  const Field relief = smoothed(elevation, sigma);
  constexpr int places = 360;
  std::vector<double> ring;
  for (int n = 0; n < places; ++n)
    ring.push_back(relief.sample((x + radius * std::cos(n * degree)) / relief.cell_size - 0.5,
                                 (y + radius * std::sin(n * degree)) / relief.cell_size - 0.5));
  // From the lowest place once round: an arm is a rise by `dip` that is followed by a fall by as much.
  const auto start = std::min_element(ring.begin(), ring.end()) - ring.begin();
  std::rotate(ring.begin(), ring.begin() + start, ring.end());
  ring.push_back(ring.front());
  int found = 0;
  bool rising = true;
  double extreme = ring.front();  // the lowest since the last arm, or the highest of this one
  for (double height : ring) {
    if (rising) {
      extreme = std::min(extreme, height);
      if (height < extreme + dip) continue;
      rising = false;
      extreme = height;
      ++found;
    } else {
      extreme = std::max(extreme, height);
      if (height > extreme - dip) continue;
      rising = true;
      extreme = height;
    }
  }
  return found;
}

}  // namespace desert_sim

#include "src/metrics/slip_faces.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

/// Maxima of a distribution of directions; see slip_face_directions().
std::vector<double> modal_directions(const std::vector<double>& all, double least_share) {
  constexpr int bins = 72, reach = 3;  // of 5 degrees; ±15 degrees are 7 bins
  std::vector<double> count(bins, 0.0), around(bins, 0.0);
  const auto at = [](std::vector<double>& values, int b) -> double& {
    return values[static_cast<std::size_t>(wrapped(b, bins))];
  };
  for (double direction : all) at(count, static_cast<int>(std::floor(direction / 5))) += 1;
  for (int b = 0; b < bins; ++b)
    for (int d = -reach; d <= reach; ++d) at(around, b) += at(count, b + d) / static_cast<double>(all.size());
  std::vector<int> order(bins);
  for (int b = 0; b < bins; ++b) order[static_cast<std::size_t>(b)] = b;
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return at(around, a) > at(around, b); });
  std::vector<double> directions;
  for (int b : order) {
    const double share = at(around, b);
    if (share < least_share || share < at(around, b - 1) || share < at(around, b + 1)) continue;
    double turn = 0;  // from the bin's middle to the mean direction within reach
    for (int d = -reach; d <= reach; ++d) turn += 5.0 * d * at(count, b + d);
    turn /= static_cast<double>(all.size()) * share;
    const double direction = std::fmod(5.0 * b + 2.5 + turn + 360.0, 360.0);
    if (std::all_of(directions.begin(), directions.end(),
                    [&](double other) { return angle_between_deg(direction, other) >= 45.0; }))
      directions.push_back(direction);
  }
  return directions;
}

}  // namespace

std::vector<double> slip_face_directions(const Field& elevation, double least_slope_deg, double least_share) {
  const Slopes s = slopes(elevation);
  std::vector<double> steep;
  for (std::size_t i = 0; i < s.slope_deg.size(); ++i)
    if (static_cast<double>(s.slope_deg[i]) >= least_slope_deg)
      steep.push_back(static_cast<double>(s.direction_deg[i]));
  return steep.empty() ? steep : modal_directions(steep, least_share);
}

SlipFaces slip_faces(const Field& elevation, const Field& sand, const Field& wind_x, const Field& wind_y,
                     double steeper_than_deg, double least_depth) {
  for (const Field* f : {&sand, &wind_x, &wind_y})
    if (f->values.size() != elevation.values.size())
      throw ConfigError("slip faces: a layer has " + std::to_string(f->values.size()) +
                        " cells (allowed: as many as the elevation, " +
                        std::to_string(elevation.values.size()) + ")");
  const Slopes s = slopes(elevation);
  std::vector<double> steep;
  std::size_t in_wind = 0, lee = 0;
  double sum_x = 0, sum_y = 0;
  for (std::size_t i = 0; i < s.slope_deg.size(); ++i) {
    if (!(static_cast<double>(s.slope_deg[i]) > steeper_than_deg &&
          static_cast<double>(sand.values[i]) >= least_depth))
      continue;
    const double direction = static_cast<double>(s.direction_deg[i]);
    const double x = std::cos(direction * degree), y = std::sin(direction * degree);
    steep.push_back(direction);
    sum_x += x;
    sum_y += y;
    const double u = static_cast<double>(wind_x.values[i]), v = static_cast<double>(wind_y.values[i]);
    in_wind += u != 0 || v != 0 ? 1 : 0;
    lee += x * u + y * v > 0 ? 1 : 0;
  }
  SlipFaces faces;
  if (steep.empty()) return faces;
  const double count = static_cast<double>(steep.size());
  faces.share = count / static_cast<double>(s.slope_deg.size());
  if (in_wind > 0) faces.lee_share = static_cast<double>(lee) / static_cast<double>(in_wind);
  faces.direction_deg = direction_of(sum_x, sum_y);
  faces.direction_coherence = std::hypot(sum_x, sum_y) / count;
  faces.directions_deg = modal_directions(steep, 0.08);
  return faces;
}

}  // namespace desert_sim

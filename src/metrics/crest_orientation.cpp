#include "src/metrics/crest_orientation.hpp"

#include <cmath>

namespace desert_sim {

Orientation crest_orientation(const Field& relief, double sigma) {
  const Field f = smoothed(relief, sigma);
  double xx = 0, xy = 0, yy = 0;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) {
      const double gx = f.at(x + 1, y) - f.at(x - 1, y), gy = f.at(x, y + 1) - f.at(x, y - 1);
      xx += gx * gx;
      xy += gx * gy;
      yy += gy * gy;
    }
  Orientation o;
  const double steepest = 0.5 * std::atan2(2 * xy, xx - yy) / degree;
  o.crest_deg = std::fmod(steepest + 90.0 + 360.0, 180.0);
  if (xx + yy > 0) o.coherence = std::hypot(xx - yy, 2 * xy) / (xx + yy);
  return o;
}

}  // namespace desert_sim

#include "test/support/oscillation.hpp"

#include <algorithm>
#include <cmath>

namespace desert_sim {

Oscillation oscillation(const Field& elevation, const Field& sand) {
  const auto thin = [&](int x, int y) { return sand.at(x, y) > 0.01f && sand.at(x, y) < 1.0f; };
  Oscillation worst;
  for (const bool along_x : {true, false}) {
    const int dx = along_x ? 1 : 0, dy = 1 - dx;
    const auto deviation = [&](int x, int y) {
      return elevation.at(x, y) - 0.5 * (elevation.at(x - dx, y - dy) + elevation.at(x + dx, y + dy));
    };
    std::size_t cells = 0, oscillating = 0;
    double squares = 0;
    for (int y = 0; y < sand.height; ++y)
      for (int x = 0; x < sand.width; ++x) {
        if (!thin(x, y)) continue;
        ++cells;
        const double d = deviation(x, y), before = deviation(x - dx, y - dy),
                     after = deviation(x + dx, y + dy);
        if (d * before >= 0 || d * after >= 0) continue;
        if (std::max({std::abs(before), std::abs(d), std::abs(after)}) > 1) continue;  // a wall
        oscillating += std::abs(d) > 0.02 ? 1 : 0;
        squares += d * d;
      }
    const auto all = static_cast<double>(std::max<std::size_t>(cells, 1));
    worst.thin_cells = cells;
    worst.share = std::max(worst.share, static_cast<double>(oscillating) / all);
    worst.rms = std::max(worst.rms, std::sqrt(squares / all));
  }
  return worst;
}

}  // namespace desert_sim

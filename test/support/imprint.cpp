#include "test/support/imprint.hpp"

#include <algorithm>
#include <numeric>

namespace desert_sim {

double imprint(const std::vector<Field>& fields, int period) {
  double greatest = 0;
  for (bool along_x : {true, false}) {
    std::vector<double> squares(static_cast<std::size_t>(period));
    for (const Field& f : fields)
      for (int y = 0; y + 1 < f.height; ++y)
        for (int x = 0; x + 1 < f.width; ++x) {
          const double step = f.at(x + along_x, y + !along_x) - f.at(x, y);
          squares[static_cast<std::size_t>((along_x ? x : y) % period)] += step * step;
        }
    const double mean = std::accumulate(squares.begin(), squares.end(), 0.0) / period;
    greatest = std::max(greatest, *std::max_element(squares.begin(), squares.end()) / mean - 1);
  }
  return greatest;
}

}  // namespace desert_sim

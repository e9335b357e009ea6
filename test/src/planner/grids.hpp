#pragma once
/// Grids of traversability for tests of planners.

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <vector>

#include "src/planner/cost_grid.hpp"

namespace desert_sim::test {

using Traversability = std::function<float(int x, int y)>;

inline std::vector<float> values_of(const GridFrame& f, const Traversability& t) {
  std::vector<float> values;
  for (int y = 0; y < f.height; ++y)
    for (int x = 0; x < f.width; ++x) values.push_back(t(x, y));
  return values;
}

inline std::vector<CellIndex> fill(CostGrid& grid, const Traversability& t) {
  const GridFrame& f = grid.frame();
  std::vector<CellIndex> changed;
  grid.update({0, 0, f.width, f.height}, values_of(f, t).data(), changed);
  return changed;
}

/// Free ground with costs that vary, and round obstacles.
inline std::vector<float> random_ground(const GridFrame& f, std::mt19937& dice, int obstacles) {
  std::uniform_real_distribution<float> share(0.3F, 1.0F);
  std::vector<float> values = values_of(f, [&](int, int) { return share(dice); });
  for (int n = 0; n < obstacles; ++n) {
    const int cx = static_cast<int>(dice() % static_cast<unsigned>(f.width)),
              cy = static_cast<int>(dice() % static_cast<unsigned>(f.height)),
              r = 1 + static_cast<int>(dice() % 4U);
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x < f.width; ++x)
        if ((x - cx) * (x - cx) + (y - cy) * (y - cy) <= r * r)
          values[static_cast<std::size_t>(y * f.width + x)] = 0;
  }
  return values;
}

}  // namespace desert_sim::test

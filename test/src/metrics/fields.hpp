#pragma once
/// Made-up reliefs whose metrics are known.

#include <cmath>

#include "src/metrics/field.hpp"

namespace desert_sim::test {

/// value(x, y) at the middle of each cell; x, y in cells.
template <class Value>
Field relief(int width, int height, double cell_size, bool periodic, const Value& value) {
  Field f{width, height, cell_size, periodic, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) f.values.push_back(static_cast<float>(value(x, y)));
  return f;
}

/// Sinusoidal ridges of height 2: `kx` and `ky` of them fit the periodic grid of n × n cells of 1 m.
inline Field ridges(int n, int kx, int ky, double phase = 0) {
  return relief(n, n, 1, true,
                [=](int x, int y) { return std::sin(360 * degree * (kx * x + ky * y) / n + phase); });
}

}  // namespace desert_sim::test

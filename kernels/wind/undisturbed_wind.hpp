#pragma once
/// The layers of the wind for models that have no wind over the terrain: everywhere the undisturbed one.

#include "kernels/base/grid.hpp"
#include "kernels/wind/vector.hpp"

namespace desert_sim::wind {

struct Blow {
  Grid grid;
  Vector above;  ///< [m/s]
  float *wind_x, *wind_y;

  DESERT_HD void operator()(int x, int y) const {
    wind_x[grid.index(x, y)] = above.x;
    wind_y[grid.index(x, y)] = above.y;
  }
};

}  // namespace desert_sim::wind

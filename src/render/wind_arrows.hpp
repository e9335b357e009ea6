#pragma once
/// The wind at the surface as arrows that lie on it.

#include <functional>
#include <vector>

#include "src/render/mesh.hpp"

namespace desert_sim::render {

/// Wind on a grid of its own: vectors point to where the air moves [m/s], row-major, x fastest, NaN where
/// unknown.
struct WindGrid {
  int width = 0, height = 0;
  double cell_size = 1;     ///< [m]
  double x = 0, y = 0;      ///< the corner of cell (0, 0) [m]
  std::vector<float> u, v;  ///< eastward, northward
  double speed_above = 0;   ///< high above the ground [m/s]: arrows of that speed nearly reach the next one
};

/// Flat arrows, at most `most`, evenly spread. `ground(x, y)` is the height of the surface [m], NaN where
/// there is none: there are no arrows. Each arrow follows the surface from its tail to its tip, a little
/// above it.
Mesh wind_arrows(const WindGrid& wind, int most, const std::function<double(double x, double y)>& ground);

}  // namespace desert_sim::render

#pragma once
/// What the tests of the wind have in common.

#include <cmath>

#include "src/core/constants.hpp"
#include "test/support/bench_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {

class WindField : public test::OnBackend {
 protected:
  static WindParameters with(bool warping, bool projection, int coarsening) {
    WindParameters p;
    p.speedup_law = SpeedUpLaw::venturi;
    p.warping = warping;
    p.projection = projection;
    p.coarsening = coarsening;
    return p;
  }
  static double hills(int x, int y, int width, int height) {
    return 20 + 8 * std::sin(2 * pi * 3 * x / width) * std::cos(2 * pi * 2 * y / height) +
           5 * std::sin(2 * pi * (5.0 * x / width + 4.0 * y / height)) +
           2 * std::cos(2 * pi * 17 * x / width);
  }
};

}  // namespace desert_sim

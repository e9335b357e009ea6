// The shear stress in the outermost cells of open terrains, where its grid is coarser than the terrain.

#include <cmath>

#include "test/kernels/sand/continuum_worlds.hpp"

namespace desert_sim {
namespace {

class ShearStressEdges : public test::OnBackend {};

/// Ridges that go from edge to edge have no ends: the wind along x is the same in all rows.
TEST_P(ShearStressEdges, OfRidgesAcrossTheTerrainAreAsItsMiddle) {
  constexpr int width = 60, height = 48;
  for (const double stress_cell : {1.0, 3.0, 4.0}) {
    SCOPED_TRACE(stress_cell);
    auto s = test::with_sand(
        exec(),
        "grid: {width: 60, height: 48, cell_size: 1, boundary: open}\nsand: {model: continuum}\n"
        "wind: {speed: 12, direction_deg: 0}\navalanching: {enabled: false}\nsaltation: {enabled: false}\n"
        "shear_stress: {stress_cell: " +
            std::to_string(stress_cell) + "}\n",
        [](int x, int) { return 3 + std::sin(x * 2 * pi / 20); });
    s->step();
    const std::vector<float> wind = test::real(*s, Layer::wind_x);
    float least = wind[0], most = wind[0];
    for (int x = 0; x < width; ++x) {
      const float middle = wind[static_cast<std::size_t>(height / 2 * width + x)];
      least = std::min(least, middle);
      most = std::max(most, middle);
      for (const int y : {0, 1, 2, height - 3, height - 2, height - 1})
        EXPECT_NEAR(wind[static_cast<std::size_t>(y * width + x)], middle, 1e-4f * middle) << x << ' ' << y;
    }
    EXPECT_GT(most, 1.2f * least) << "the ridges must be felt";
  }
}

DESERT_ON_EACH_BACKEND(ShearStressEdges);

}  // namespace
}  // namespace desert_sim

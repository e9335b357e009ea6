// Where dunes are loose: on their slip faces and where fresh sand lies, and packed to windward.

#include <cmath>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

struct Means {
  double slip_face, stoss;
  std::size_t slip_cells, stoss_cells;
};

/// Means over slip faces (28 degrees and more, falling with the wind) and windward slopes (3 to 25 degrees,
/// rising with it) of dunes at least 1 m deep, in a wind to the east.
Means means_of(Running& scene) {
  const Field loose = scene.field(Layer::looseness), slope = scene.field(Layer::slope),
              rise = scene.field(Layer::normal_x), sand = scene.field(Layer::sand);
  Means m{0, 0, 0, 0};
  for (std::size_t i = 0; i < loose.values.size(); ++i) {
    const double deg = slope.values[i] * 57.29578, east = -rise.values[i];
    if (sand.values[i] < 1) continue;
    if (deg >= 28 && east < 0) m.slip_face += loose.values[i], ++m.slip_cells;
    if (deg >= 3 && deg <= 25 && east > 0.04) m.stoss += loose.values[i], ++m.stoss_cells;
  }
  m.slip_face /= static_cast<double>(m.slip_cells);
  m.stoss /= static_cast<double>(m.stoss_cells);
  DESERT_REPORT("looseness of slip faces %.3f (%zu cells), of windward slopes %.3f (%zu cells)", m.slip_face,
                m.slip_cells, m.stoss, m.stoss_cells);
  return m;
}

/// Slip faces are at least 0.7 looser than windward slopes.
void expect_loose_slip_faces(const std::string& scenario, const Settings& settings, int steps) {
  Running scene(shipped(scenario, settings));
  scene.run(steps);
  const Means m = means_of(scene);
  EXPECT_GT(m.slip_cells, 100u);
  EXPECT_GT(m.stoss_cells, 500u);
  EXPECT_GT(m.slip_face, 0.9);
  EXPECT_LT(m.stoss, 0.25);
  EXPECT_GT(m.slip_face - m.stoss, 0.7);
}

TEST(Looseness, BarchansAreLooseOnTheirSlipFacesAndPackedToWindward) {
  expect_loose_slip_faces("barchan", {"grid.width=256", "grid.height=128", "looseness.enabled=true"}, 300);
}

TEST(Looseness, TransverseDunesAreLooseOnTheirSlipFacesAndPackedToWindward) {
  expect_loose_slip_faces("transverse", {"grid.width=192", "grid.height=96", "looseness.enabled=true"}, 300);
}

}  // namespace
}  // namespace desert_sim

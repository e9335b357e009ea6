// Winds off the axes of the grid: they raise no waves of a few cells, and lead dunes as straight as winds along an axis.

#include <algorithm>
#include <cmath>

#include "continuum/worlds.hpp"
#include "kernels/field/random.hpp"

namespace desert_sim {
namespace {

class ObliqueWinds : public test::OnBackend {
 protected:
  static std::string world(int cells, double degrees, double speed) {
    return "grid: {width: " + std::to_string(cells) + ", height: " + std::to_string(cells) +
           ", cell_size: 1}\nsaltation: {model: continuum}\nwind: {speed: " + std::to_string(speed) +
           ", direction_deg: " + std::to_string(degrees) + "}\nrun: {time_step: 600}\n";
  }
  /// Rms of what differs from the mean over 3 × 3 cells: of waves of less than five cells, hardly of others [m].
  static double roughness(const Simulation& s) {
    const std::vector<float> sand = s.terrain().values(Layer::sand);
    const Grid& g = s.terrain().grid();
    double sum = 0;
    for (int y = 0; y < g.height; ++y)
      for (int x = 0; x < g.width; ++x) {
        double mean = 0;
        for (int b = -1; b <= 1; ++b)
          for (int a = -1; a <= 1; ++a)
            mean += static_cast<double>(
                sand[static_cast<std::size_t>(wrap(y + b, g.height) * g.width + wrap(x + a, g.width))]);
        sum += std::pow(static_cast<double>(sand[static_cast<std::size_t>(y * g.width + x)]) - mean / 9, 2);
      }
    return std::sqrt(sum / g.cells());
  }
};

/// A bed that is rough by 2 mm from cell to cell. (With the turn of the flux taken a line before it, it would be ten times
/// as rough in the end in diagonal winds.)
TEST_P(ObliqueWinds, SmoothWhatIsRoughFromCellToCell) {
  for (const double speed : {6.5, 9.0, 16.0})
    for (const int degrees : {0, 14, 27, 45, 63, 90, 117, 135, 225, 300, 315}) {
      SCOPED_TRACE(testing::Message() << speed << " m/s, " << degrees << " degrees");
      auto s = test::with_sand(exec(), world(48, degrees, speed), [](int x, int y) {
        return 3 + 0.004 *
                       random_words(1, Purpose::terrain_noise, static_cast<std::uint32_t>(x),
                                    static_cast<std::uint32_t>(y), 0)
                           .word[0] /
                       4294967296.0;
      });
      test::run(*s, 2);
      const double before = roughness(*s);
      test::run(*s, 150);
      EXPECT_LT(roughness(*s), 0.5 * before);
    }
}

/// The heap is symmetric about the wind's axis, and so is the dune that becomes of it: nearly, because the sweep goes along
/// x in this wind.
TEST_P(ObliqueWinds, LeadADuneAsStraightAsAnyOther) {
  constexpr int cells = 90;
  auto s = test::with_sand(exec(), world(cells, 45, 9), [](int x, int y) {
    return 4 * std::exp(-0.5 * (std::pow(x - 34.5, 2) + std::pow(y - 34.5, 2)) / 64);
  });
  test::run(*s, 1000);
  test::expect_sound(*s, "at the end");
  const std::vector<float> sand = s->terrain().values(Layer::sand);
  const auto at = [&](int x, int y) {
    return static_cast<double>(sand[static_cast<std::size_t>(y * cells + x)]);
  };
  double all = 0, moved = 0, astray = 0, unlike = 0;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      all += at(x, y);
      moved += at(x, y) * (x + y - 69) / std::sqrt(2.0);
      astray += at(x, y) * (y - x) / std::sqrt(2.0);
      unlike += std::abs(at(x, y) - at(y, x)) / 2;
    }
  EXPECT_GT(moved / all, 2) << "m downwind";
  EXPECT_NEAR(astray / all, 0, 0.1 * moved / all) << "m to the left";
  EXPECT_LT(unlike / all, 0.08) << "of the sand lies on the other side";
}
DESERT_ON_EACH_BACKEND(ObliqueWinds);

}  // namespace
}  // namespace desert_sim

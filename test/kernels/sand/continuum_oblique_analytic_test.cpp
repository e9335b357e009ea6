// Winds off the axes of the grid: they raise no waves of a few cells, and lead dunes as straight as winds
// along an axis.

#include <algorithm>
#include <cmath>

#include "kernels/field/random.hpp"
#include "test/kernels/sand/continuum_worlds.hpp"

namespace desert_sim {
namespace {

class ObliqueWinds : public test::OnBackend {
 protected:
  static std::string world(int cells, double degrees, double speed) {
    return "grid: {width: " + std::to_string(cells) + ", height: " + std::to_string(cells) +
           ", cell_size: 1}\nsand: {model: continuum}\nwind: {speed: " + std::to_string(speed) +
           ", direction_deg: " + std::to_string(degrees) + "}\nrun: {time_step: 600}\n";
  }
  /// Rms of what differs from the mean over 3 × 3 cells: of waves of less than five cells, hardly of others
  /// [m]. Of cells that lie `margin` cells from the edges.
  static double roughness(const Simulation& s, int margin = 0) {
    const std::vector<float> sand = s.terrain().values(Layer::sand);
    const Grid& g = s.terrain().grid();
    double sum = 0;
    for (int y = margin; y < g.height - margin; ++y)
      for (int x = margin; x < g.width - margin; ++x) {
        double mean = 0;
        for (int b = -1; b <= 1; ++b)
          for (int a = -1; a <= 1; ++a)
            mean += static_cast<double>(
                sand[static_cast<std::size_t>(wrap(y + b, g.height) * g.width + wrap(x + a, g.width))]);
        sum += std::pow(static_cast<double>(sand[static_cast<std::size_t>(y * g.width + x)]) - mean / 9, 2);
      }
    return std::sqrt(sum / ((g.width - 2 * margin) * (g.height - 2 * margin)));
  }
};

/// A bed that is rough by 2 mm from cell to cell. (Were the flux turned where it leaves and not where it
/// lands, it would be rougher in the end than before, in diagonal winds.)
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

/// The same on a slope across the wind, down which the flux turns.
TEST_P(ObliqueWinds, SmoothASlopeAcrossThem) {
  for (const double rise : {-0.3, -0.15, 0.15, 0.3})
    for (const int degrees : {0, 27, 45, 135}) {
      SCOPED_TRACE(testing::Message() << degrees << " degrees, slope " << rise);
      const double along = degrees * pi / 180;
      std::string open = world(48, degrees, 9);
      open.insert(open.find("cell_size"), "boundary: open, ");
      auto s = test::with_sand(exec(), open, [&](int x, int y) {
        return 14 + rise * (std::cos(along) * (y - 24) - std::sin(along) * (x - 24)) +
               0.004 *
                   random_words(1, Purpose::terrain_noise, static_cast<std::uint32_t>(x),
                                static_cast<std::uint32_t>(y), 0)
                       .word[0] /
                   4294967296.0;
      });
      test::run(*s, 2);
      const double before = roughness(*s, 14);
      test::run(*s, 60);
      EXPECT_LT(roughness(*s, 14), 0.5 * before);
    }
}

/// The heap is symmetric about the wind's axis, and so is the dune that becomes of it: nearly, because the
/// sweep goes along x in this wind.
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

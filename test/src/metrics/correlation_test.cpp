// Wavelengths and motions of reliefs that are known exactly.

#include "src/metrics/correlation.hpp"

#include <gtest/gtest.h>

#include <array>

#include "src/metrics/crest_orientation.hpp"
#include "test/src/metrics/fields.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

struct Ridges {
  int kx, ky;
};

class RidgesAtAngles : public ::testing::TestWithParam<Ridges> {};

/// n / |k| apart, along the crests at right angles to k.
TEST_P(RidgesAtAngles, HaveTheirOrientationAndWavelength) {
  const auto [kx, ky] = GetParam();
  const Field f = test::ridges(192, kx, ky);
  const Orientation o = crest_orientation(f, 2);
  EXPECT_LT(line_angle_between_deg(o.crest_deg, direction_of(kx, ky) + 90), 0.6) << o.crest_deg;
  EXPECT_GT(o.coherence, 0.999);
  EXPECT_NEAR(wavelength(f, o.crest_deg + 90).value(), 192 / std::hypot(kx, ky), 0.15);
}

INSTANTIATE_TEST_SUITE_P(All, RidgesAtAngles,
                         ::testing::Values(Ridges{8, 0}, Ridges{0, 8}, Ridges{12, 0}, Ridges{8, 3},
                                           Ridges{-7, 7}, Ridges{5, 9}, Ridges{16, -4}));

TEST(Correlation, IsOneOfAFieldWithItselfAndMinusOneOfItsOpposite) {
  const Field f = test::ridges(64, 4, 0), opposite = test::ridges(64, 4, 0, 180 * degree);
  EXPECT_NEAR(Correlation(f, f).at(0, 0), 1, 1e-5);
  EXPECT_NEAR(Correlation(f, f).at(4, 0), 0, 1e-5);  // a quarter of the wavelength
  EXPECT_NEAR(Correlation(f, f).at(8, 3), -1, 1e-5);
  EXPECT_NEAR(Correlation(f, opposite).at(0, 0), -1, 1e-5);
}

/// By its definition, cell by cell.
TEST(Correlation, OfAnOpenFieldIsThatOfTheOverlap) {
  const Field f = test::relief(7, 5, 1, false, [](int x, int y) { return (x * x + 3 * y * x) % 5; });
  double h = 0, g = 0, hh = 0, gg = 0, hg = 0;
  for (int y = 1; y < 5; ++y)
    for (int x = 0; x < 5; ++x) {
      const double a = f.at(x, y), b = f.at(x + 2, y - 1);
      h += a / 20, g += b / 20, hh += a * a / 20, gg += b * b / 20, hg += a * b / 20;
    }
  EXPECT_NEAR(Correlation(f, f).at(2, -1), (hg - h * g) / std::sqrt((hh - h * h) * (gg - g * g)), 1e-5);
  EXPECT_NEAR(Correlation(f, f).at(0, 0), 1, 1e-5);
}

TEST(Wavelength, OfOneHumpThereIsNone) {
  const Field f = test::relief(64, 64, 1, true, [](int x, int y) {
    return 3 * std::exp(-(std::pow(x - 32, 2) + std::pow(y - 32, 2)) / 50);
  });
  EXPECT_FALSE(wavelength(f, 0));
}

/// Three humps without order: the motion has one peak.
Field humps(double dx, double dy, bool periodic) {
  return test::relief(120, 90, 2, periodic, [=](int x, int y) {
    double height = 0;
    for (const auto& [cx, cy, r] : {std::array{30.0, 25.0, 5.0}, {70, 40, 7}, {45, 62, 4}})
      height += r * std::exp(-(std::pow(x - cx - dx, 2) + std::pow(y - cy - dy, 2)) / (2 * r * r));
    return height;
  });
}

TEST(Displacement, OfAShiftedPatternIsTheShift) {
  for (const bool periodic : {true, false}) {
    const auto d = displacement(humps(0, 0, periodic), humps(7, -4, periodic));
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->x, 14, 0.1) << periodic;
    EXPECT_NEAR(d->y, -8, 0.1) << periodic;
    EXPECT_GT(d->correlation, 0.9999);
  }
}

TEST(Displacement, IsFoundBetweenCells) {
  const auto d = displacement(humps(0, 0, true), humps(2.4, 0.3, true));
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->x, 4.8, 0.1);
  EXPECT_NEAR(d->y, 0.6, 0.1);
}

TEST(Displacement, BeyondAQuarterOfTheGridOrOfOtherPatternsIsNotTold) {
  EXPECT_FALSE(displacement(humps(0, 0, true), humps(40, 0, true)));
  EXPECT_FALSE(displacement(humps(0, 0, true), test::relief(120, 90, 2, true, [](int x, int y) {
                              return std::sin(0.7 * x) * std::cos(1.1 * y);
                            })));
}

TEST(Correlation, OfTwoGridsIsRefused) {
  const std::string why = test::refusal([] { Correlation(test::ridges(64, 4, 0), test::ridges(32, 4, 0)); });
  EXPECT_NE(why.find("64 x 64"), std::string::npos) << why;
  EXPECT_NE(why.find("32 x 32"), std::string::npos) << why;
}

}  // namespace
}  // namespace desert_sim

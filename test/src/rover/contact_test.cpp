// Wheels on rippled sand: heights of contact have the ripples' wavelength, and without micro_relief they
// have none.

#include "src/rover/contact.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "test/src/rover/field.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string sand =
    "{grid: {width: 24, height: 8, cell_size: 1}, terrain: [{uniform: {layer: sand, value: 1}}], "
    "wind: {speed: 10, direction_deg: 0}, micro_relief: {crest_length: 1}}";
constexpr double wavelength = 0.013 + 0.02 * 9, height = 0.0467 * wavelength;  // of that wind

std::unique_ptr<GridGround> ground(bool micro_relief) {
  const std::unique_ptr<Exec> exec = make_exec("cpu", 1);
  const auto world = test::simulate(*exec, sand);
  const auto snapshot = world->views().snapshot(GridGround::layers_of_snapshot(micro_relief));
  return micro_relief ? GridGround::with_micro_relief(*snapshot, 0.3)
                      : std::make_unique<GridGround>(*snapshot, 0.3);
}

/// Heights at which a wheel that rolls downwind stands, a hundredth of a metre apart.
std::vector<double> contacts(double radius, const GroundSource& on) {
  RoverParameters p;
  p.wheel_radius = radius;
  const Contact contact(p, Suspension(p));
  std::vector<double> heights;
  for (int n = 0; n < 2000; ++n) heights.push_back(contact.surface(2 + 0.01 * n, 4.1, 0, on));
  return heights;
}

double power_at(const std::vector<double>& heights, double wave_number) {
  std::complex<double> sum;
  for (std::size_t n = 0; n < heights.size(); ++n)
    sum += std::polar(1 - std::cos(2 * pi * static_cast<double>(n) / 2000),
                      -2 * pi * wave_number * 0.01 * static_cast<double>(n)) *
           (heights[n] - 1);
  return std::norm(sum / 2000.0);
}

TEST(RelativeMoisture, IsThatOfTheMoistDepth) {
  EXPECT_DOUBLE_EQ(relative_moisture(0.3, 5, 0.3), 1);
  EXPECT_DOUBLE_EQ(relative_moisture(0.3, 5, 0.3, 2), 0.5);
  EXPECT_DOUBLE_EQ(relative_moisture(0.15, 1, 0.3, 2), 0.5);
}

TEST(RoverOnRipples, ASmallWheelFeelsTheirWavelength) {
  const std::vector<double> z = contacts(0.05, *ground(true));
  double best = 0, at = 0, all = 0;
  for (double k = 1; k < 20; k += 0.05) {
    const double power = power_at(z, k);
    all += power;
    if (power > best) best = power, at = k;
  }
  EXPECT_NEAR(at * wavelength, 1, 0.1);
  double near = 0;
  for (double k = 0.8 / wavelength; k < 1.2 / wavelength; k += 0.05) near += power_at(z, k);
  EXPECT_GT(near / all, 0.6);
}

TEST(RoverOnRipples, WheelsStandOnCrestsAndALargerOneSinksLessIntoTroughs) {
  const auto on = ground(true);
  const std::vector<double> small = contacts(0.03, *on), large = contacts(0.5, *on);
  const auto [low, high] = std::minmax_element(small.begin(), small.end());
  EXPECT_GT(*high - *low, 0.8 * height);
  EXPECT_LT(*high - *low, 1.05 * height);
  double higher = 0;
  for (std::size_t n = 0; n < small.size(); ++n) higher += (large[n] - small[n]) / 2000;
  EXPECT_GT(higher, 0.1 * height);
}

TEST(RoverOnRipples, WithoutMicroReliefTheGroundIsFlat) {
  for (const double z : contacts(0.05, *ground(false))) ASSERT_NEAR(z, 1, 1e-6);
}

}  // namespace
}  // namespace desert_sim

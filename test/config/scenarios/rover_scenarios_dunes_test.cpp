// The scenarios for rovers: their fronts are slow and move evenly, and who is parked upwind stays there.

#include <algorithm>
#include <cmath>

#include "test/support/running.hpp"

namespace desert_sim {
namespace {

/// Where the easternmost slip face of each row ends: there sand is two metres deep, and less east of it [m].
/// Rows without have a negative number.
std::vector<double> fronts(const Field& sand) {
  constexpr double depth = 2;
  std::vector<double> found(static_cast<std::size_t>(sand.height), -1);
  for (int y = 0; y < sand.height; ++y)
    for (int x = sand.width - 2; x >= 0 && found[static_cast<std::size_t>(y)] < 0; --x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(sand.width) + static_cast<std::size_t>(x);
      const double here = sand.values[i], next = sand.values[i + 1];
      if (here >= depth)
        found[static_cast<std::size_t>(y)] = (x + 0.5 + (here - depth) / (here - next)) * sand.cell_size;
    }
  return found;
}

double quantile(std::vector<double> numbers, double share) {
  std::sort(numbers.begin(), numbers.end());
  return numbers[static_cast<std::size_t>(share * static_cast<double>(numbers.size() - 1))];
}

struct RoverScenario {
  const char* name;
  double x, y;  ///< where its header parks a rover [m]
};

class RoverScenarios : public testing::TestWithParam<RoverScenario> {};

/// Half a minute of ROS time, state by state as a node shows them.
TEST_P(RoverScenarios, FrontsMoveSlowlyAndEvenly) {
  Running scene(shipped(GetParam().name));
  const RunParameters& run = scene.simulation().scenario().run;
  const double states_per_second = run.acceleration / run.time_step;
  EXPECT_NEAR(states_per_second, 10, 0.01);
  const int states = static_cast<int>(std::lround(30 * states_per_second));
  std::vector<std::vector<double>> motion;  // of each row [m], state by state
  std::vector<double> last = fronts(scene.field(Layer::sand));
  motion.resize(last.size());
  for (int n = 0; n < states; ++n) {
    const std::vector<double> now = fronts(scene.run(1).field(Layer::sand));
    for (std::size_t row = 0; row < now.size(); ++row)
      motion[row].push_back(last[row] < 0 || now[row] < 0 ? 1e9 : now[row] - last[row]);
    last = now;
  }
  std::vector<double> speeds, unevenness;  // of rows with one front all the while [m/s] of ROS time
  for (const std::vector<double>& row : motion) {
    if (std::any_of(row.begin(), row.end(), [](double m) { return std::abs(m) > 0.5; })) continue;
    double sum = 0;
    for (double m : row) sum += m;
    speeds.push_back(sum / states * states_per_second);
    unevenness.push_back(quantile(row, 1) / quantile(row, 0.5));
  }
  ASSERT_GT(speeds.size(), 30u);
  DESERT_REPORT(
      "%zu fronts: %.1f, %.1f, %.1f cm/s (10, 50, 80 %%); largest motion of a state over the median %.2f, "
      "%.2f",
      speeds.size(), 100 * quantile(speeds, 0.1), 100 * quantile(speeds, 0.5), 100 * quantile(speeds, 0.8),
      quantile(unevenness, 0.5), quantile(unevenness, 0.9));
  EXPECT_GT(quantile(speeds, 0.1), 0.02);
  EXPECT_LT(quantile(speeds, 0.8), 0.05);
  EXPECT_LT(quantile(unevenness, 0.5), 2);
  scene.expect_balanced();
}

/// Ten minutes of ROS time, in far longer steps than the scenario's: dunes come as far in them.
TEST_P(RoverScenarios, AParkedRoverIsNotBuried) {
  Running scene(shipped(GetParam().name, {"run.time_step=1800"}));
  const RunParameters& run = scene.simulation().scenario().run;
  const Field before = scene.field(Layer::elevation);
  const Field after =
      scene.run(static_cast<int>(600 * run.acceleration / run.time_step)).field(Layer::elevation);
  double changed = 0, elsewhere = 0;
  for (int y = 0; y < before.height; ++y)
    for (int x = 0; x < before.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(before.width) + static_cast<std::size_t>(x);
      const double change = std::abs(static_cast<double>(after.values[i]) - before.values[i]);
      elsewhere = std::max(elsewhere, change);
      if (std::hypot((x + 0.5) * before.cell_size - GetParam().x,
                     (y + 0.5) * before.cell_size - GetParam().y) < 3)
        changed = std::max(changed, change);
    }
  DESERT_REPORT("within 3 m of the rover the ground changed by %.3f m, elsewhere by up to %.1f m", changed,
                elsewhere);
  EXPECT_LT(changed, 0.1);
  EXPECT_GT(elsewhere, 1);
}

#if DESERT_WITH_IO
INSTANTIATE_TEST_SUITE_P(Shipped, RoverScenarios,
                         testing::Values(RoverScenario{"rover_barchans", 12, 64},
                                         RoverScenario{"rover_transverse", 10, 48}),
                         [](const auto& test) { return std::string(test.param.name + 6); });
#else
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RoverScenarios);
#endif

}  // namespace
}  // namespace desert_sim

// Whatever a scenario switches on: no quantum is made or lost, no depth is negative, nothing is NaN.

#include "test/support/cases.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

struct Size {
  int width, height;
};

class Mass : public test::OnBackend {
 protected:
  /// Runs all cases on a grid and looks at the books after 1 and after `steps` steps.
  void all_cases(Size size, const char* boundary, int steps, bool transforms = true) {
    for (const test::Case& c : test::process_cases(transforms)) {
      const std::string where =
          c.name + ", " + std::to_string(size.width) + " x " + std::to_string(size.height) + ", " + boundary;
      SCOPED_TRACE(where);
      auto s = simulation(test::grid_yaml(size.width, size.height, boundary) + c.yaml);
      test::run(*s, 1);
      test::expect_sound(*s, "after the first step");
      test::run(*s, steps - 1);
      test::expect_sound(*s, "after " + std::to_string(steps) + " steps");
      if (HasFailure()) return;
    }
  }
};

TEST_P(Mass, IsKeptOnAPeriodicGrid) { all_cases({48, 48}, "periodic", 15); }
TEST_P(Mass, IsKeptOnAnOpenGrid) { all_cases({48, 48}, "open", 15); }
TEST_P(Mass, IsKeptOnAnOddPeriodicGrid) { all_cases({37, 64}, "periodic", 10); }
TEST_P(Mass, IsKeptOnAnOddOpenGrid) { all_cases({65, 33}, "open", 10); }

TEST_P(Mass, IsKeptOnTinyGrids) {
  for (const Size size : {Size{1, 1}, Size{1, 40}, Size{40, 1}, Size{2, 3}, Size{5, 2}, Size{3, 3}})
    for (const char* boundary : {"periodic", "open"}) all_cases(size, boundary, 5);
}

TEST_P(Mass, IsKeptWhenTheHeightScaleIsCoarse) {
  auto s = simulation(
      "grid: {width: 40, height: 40, boundary: open}\n"
      "terrain: [ramp: {layer: bedrock, value: 2500, slope_x: 50, slope_y: 30}, uniform: {layer: sand, "
      "value: 2}]\n"
      "wind: {speed: 7, direction_deg: 100}\nabrasion: {rate: 0.1}\n");
  EXPECT_GT(s->terrain().scale().exponent, -20);
  test::run(*s, 10);
  test::expect_sound(*s, "coarse quantum");
}

TEST_P(Mass, IsKeptThroughEdits) {
  auto s = simulation(
      "grid: {width: 50, height: 40}\nterrain: [uniform: {layer: sand, value: 2}]\nabrasion: {rate: 0.01}\n");
  for (int n = 0; n < 12; ++n) {
    command::EditTerrain edit;
    edit.layer = n % 3 == 2 ? "bedrock" : "sand";
    edit.merge = static_cast<BrushMerge>(n % 6);
    edit.x = 5 * n;
    edit.y = 40 - 3 * n;
    edit.radius = 1 + n;
    edit.radius_y = 3;
    edit.shape = n % 2 ? BrushShape::ellipse : BrushShape::circle;
    edit.angle_deg = 20 * n;
    edit.inner = 0.3;
    edit.value = 6;
    s->apply(edit);
    s->step();
    test::expect_sound(*s, "after edit " + std::to_string(n));
  }
}

/// A hop of more cells than 16 bits count must neither lose sand nor move it somewhere else than the wind
/// says.
TEST_P(Mass, IsKeptByHopsLongerThanTheGrid) {
  auto s = simulation(
      "grid: {width: 16, height: 16, cell_size: 1}\nterrain: [uniform: {layer: sand, value: 2}]\n"
      "wind: {speed: 50, direction_deg: 30}\nrun: {time_step: 100}\n");
  test::run(*s, 3);
  test::expect_sound(*s, "hops of 5000 cells");
}

DESERT_ON_EACH_BACKEND(Mass);

}  // namespace
}  // namespace desert_sim

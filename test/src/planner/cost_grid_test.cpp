// Costs in buckets, and what is too near to lethal ground.
#include "src/planner/cost_grid.hpp"

#include <cmath>
#include <limits>
#include <set>

#include "src/core/error.hpp"
#include "test/src/planner/grids.hpp"

namespace desert_sim {
namespace {

constexpr GridFrame frame{40, 30, 0.5, 10, -5};

TEST(CostGrid, BucketsRiseFromTheBestGroundToTheWorst) {
  const CostGrid grid(frame, {4, 8, 0.1, 0.5});
  EXPECT_EQ(grid.cost_of(1), CostGrid::cheapest);
  EXPECT_EQ(grid.cost_of(0.76F), CostGrid::cheapest);
  EXPECT_GT(grid.cost_of(0.74F), grid.cost_of(0.76F));
  EXPECT_EQ(grid.cost_of(0.11F), std::lround(4 * (1 + 8 * 0.875 * 0.875)));
  for (const float t : {0.1F, 0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_EQ(grid.cost_of(t), CostGrid::lethal) << t;
}

TEST(CostGrid, LethalIsWhatIsNearerToLethalGroundThanTheRadius) {
  CostGrid grid(frame, {16, 8, 0, 1.5});
  test::fill(grid, [](int x, int y) { return x == 20 && y == 15 ? 0.0F : 1.0F; });
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const bool near_edge = x < 3 || y < 3 || x >= frame.width - 3 || y >= frame.height - 3;
      const bool near_rock = (x - 20) * (x - 20) + (y - 15) * (y - 15) <= 9;
      EXPECT_EQ(grid.cost(grid.cell(x, y)) == CostGrid::lethal, near_edge || near_rock) << x << " " << y;
    }
  EXPECT_TRUE(grid.itself_lethal(grid.cell(20, 15)));
  EXPECT_FALSE(grid.itself_lethal(grid.cell(21, 15)));
}

/// Any order of changes leads to the grid that is made at once, and each change is told.
TEST(CostGrid, ChangesAddUp) {
  std::mt19937 dice(3);
  std::vector<float> ground = test::random_ground(frame, dice, 20);
  CostGrid grid(frame, {});
  std::vector<CellIndex> changed;
  grid.update({0, 0, frame.width, frame.height}, ground.data(), changed);
  for (int round = 0; round < 200; ++round) {
    const std::vector<std::uint8_t> before = grid.costs();
    const int x = static_cast<int>(dice() % 35U), y = static_cast<int>(dice() % 25U);
    std::vector<float> box;
    for (int n = 0; n < 25; ++n) {
      const float t = dice() % 3 == 0 ? 0 : static_cast<float>(dice() % 100) / 100.0F;
      box.push_back(t);
      ground[static_cast<std::size_t>((y + n / 5) * frame.width + x + n % 5)] = t;
    }
    changed.clear();
    grid.update({x, y, 5, 5}, box.data(), changed);
    const std::set<CellIndex> told(changed.begin(), changed.end());
    for (CellIndex c = 0; c < before.size(); ++c)
      EXPECT_TRUE(before[c] == grid.cost(c) || told.count(c) == 1);
  }
  CostGrid anew(frame, {});
  changed.clear();
  anew.update({0, 0, frame.width, frame.height}, ground.data(), changed);
  EXPECT_EQ(anew.costs(), grid.costs());
}

TEST(CostGrid, MarksComeAndGo) {
  CostGrid grid(frame, {});
  test::fill(grid, [](int, int) { return 0.9F; });
  const std::vector<std::uint8_t> before = grid.costs();
  std::vector<CellIndex> changed;
  grid.mark({18, 3}, 1, true, changed);
  grid.mark({18.5, 3}, 1, true, changed);
  EXPECT_EQ(grid.cost(*grid.cell_at({18, 3})), CostGrid::lethal);
  grid.mark({18, 3}, 1, false, changed);
  EXPECT_EQ(grid.cost(*grid.cell_at({18.5, 3})), CostGrid::lethal);
  grid.mark({18.5, 3}, 1, false, changed);
  EXPECT_EQ(grid.costs(), before);
  grid.mark({18.5, 3}, 1, false, changed);
  EXPECT_EQ(grid.costs(), before) << "a mark that is not there cannot be taken away";
}

TEST(CostGrid, CellsAndPoints) {
  CostGrid grid(frame, {});
  test::fill(grid, [](int x, int) { return x < 20 ? 1.0F : 0.0F; });
  EXPECT_EQ(grid.cell_at({10.1, -4.9}), grid.cell(0, 0));
  EXPECT_EQ(grid.cell_at({29.99, 9.99}), grid.cell(39, 29));
  EXPECT_FALSE(grid.cell_at({30.01, 0}));
  EXPECT_FALSE(grid.cell_at({9.99, 0}));
  EXPECT_FALSE(grid.cell_at({std::numeric_limits<double>::quiet_NaN(), 0}));
  const auto near = grid.nearest_passable({20.3, 2.3}, 2);
  ASSERT_TRUE(near);
  EXPECT_EQ(grid.x_of(*near), 18);
  EXPECT_FALSE(grid.nearest_passable({25, 2.3}, 2));
}

/// A list of all cells in 20 m would have a billion entries.
TEST(CostGrid, SearchesFarOnCellsOfAMillimetre) {
  const GridFrame fine{40, 30, 0.001, 0, 0};
  CostGrid grid(fine, {16, 8, 0, 0.001});
  std::vector<float> values(40 * 30, 0);
  values[29 * 40 + 39] = 1;
  std::vector<CellIndex> changed;
  grid.update({0, 0, 40, 30}, values.data(), changed);
  EXPECT_FALSE(grid.nearest_passable({0.0005, 0.0005}, 20)) << "it is beside a lethal one";
  std::fill(values.begin(), values.end(), 1.0F);
  grid.update({0, 0, 40, 30}, values.data(), changed);
  EXPECT_TRUE(grid.nearest_passable({0.0005, 0.0005}, 20));
  grid.mark({0.02, 0.015}, 20, true, changed);
  EXPECT_FALSE(grid.nearest_passable({0.0005, 0.0005}, 20));
  grid.mark({0.02, 0.015}, 20, false, changed);
  EXPECT_TRUE(grid.nearest_passable({0.0005, 0.0005}, 20));
}

TEST(CostGrid, RefusesWhatIsOutOfRange) {
  EXPECT_THROW(CostGrid({0, 5, 1, 0, 0}, {}), ConfigError);
  EXPECT_THROW(CostGrid({5, 5, 0, 0, 0}, {}), ConfigError);
  EXPECT_THROW(CostGrid(frame, {0, 8, 0, 0.5}), ConfigError);
  EXPECT_THROW(CostGrid(frame, {16, 61, 0, 0.5}), ConfigError);
  EXPECT_THROW(CostGrid(frame, {16, 8, 1, 0.5}), ConfigError);
  EXPECT_THROW(CostGrid(frame, {16, 8, 0, 21}), ConfigError);
  CostGrid grid(frame, {});
  const std::vector<float> values(100, 1);
  std::vector<CellIndex> changed;
  EXPECT_THROW(grid.update({31, 0, 10, 10}, values.data(), changed), ConfigError);
  EXPECT_TRUE(changed.empty());
}

}  // namespace
}  // namespace desert_sim

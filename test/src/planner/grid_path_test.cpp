// Costs of lines, shortened and resampled paths, and costs by heading.
#include "src/planner/grid_path.hpp"

#include <cmath>

#include "src/core/error.hpp"
#include "src/planner/field_planner.hpp"
#include "src/planner/ompl_planner.hpp"
#include "test/src/planner/grids.hpp"

namespace desert_sim {
namespace {

constexpr GridFrame frame{60, 60, 0.5, 0, 0};

TEST(GridPath, ALineCostsItsLengthOnTheBestGround) {
  CostGrid grid(frame, {});
  test::fill(grid, [](int, int) { return 1.0F; });
  for (const GridPoint& to :
       {GridPoint{20, 5}, GridPoint{5, 20}, GridPoint{17.3, 22.1}, GridPoint{2.2, 1.9}}) {
    const auto cost = line_cost(grid, {5, 5}, to);
    ASSERT_TRUE(cost);
    EXPECT_NEAR(*cost, std::hypot(to.x - 5, to.y - 5), 1e-9);
    EXPECT_NEAR(*line_cost(grid, to, {5, 5}), *cost, 1e-9);
  }
  EXPECT_NEAR(*line_cost(grid, {5, 5}, {5, 5}), 0, 1e-12);
  EXPECT_FALSE(line_cost(grid, {5, 5}, {31, 5})) << "off the grid";
}

TEST(GridPath, LinesMeetEveryCellTheyCross) {
  CostGrid grid(frame, {});
  test::fill(grid, [](int x, int) { return x < 30 ? 1.0F : 0.5F; });
  const double worse = grid.cost_of(0.5F) / 4.0;
  EXPECT_NEAR(*line_cost(grid, {10, 10}, {20, 10}), 5 + 5 * worse, 1e-9);
  EXPECT_NEAR(*line_cost(grid, {20, 20}, {10, 10}), std::sqrt(2.0) * (5 + 5 * worse), 1e-9);
  test::fill(grid, [](int x, int y) { return x == 30 && y > 20 ? 0.0F : 1.0F; });
  EXPECT_FALSE(line_cost(grid, {10, 15}, {20, 15}));
  EXPECT_TRUE(line_cost(grid, {10, 8}, {20, 8}));
  EXPECT_TRUE(line_cost(grid, {15.25, 15}, {18, 15}, 1)) << "a rover on lethal ground may leave it";
  EXPECT_FALSE(line_cost(grid, {12, 15}, {18, 15}, 1));
}

TEST(GridPath, ShortenedPathsCostNoMore) {
  std::mt19937 dice(4);
  CostGrid grid(frame, {});
  std::vector<CellIndex> changed;
  grid.update({0, 0, frame.width, frame.height}, test::random_ground(frame, dice, 12).data(), changed);
  FieldPlanner field(grid);
  field.compute(*grid.nearest_passable({27, 27}, 5));
  const auto cells = field.path_from(*grid.nearest_passable({3, 3}, 5));
  ASSERT_GT(cells.size(), 20U);
  GridPath centres;
  for (const CellIndex c : cells) centres.push_back(grid.centre(c));
  const GridPath path = shortened(grid, cells);
  EXPECT_LT(path.size(), cells.size());
  EXPECT_LE(*path_cost(grid, path), *path_cost(grid, centres) * (1 + 1e-9));
  EXPECT_LE(path_length(path), path_length(centres) + 1e-9);
  EXPECT_EQ(path.front().x, centres.front().x);
  EXPECT_EQ(path.back().y, centres.back().y);
}

TEST(GridPath, OnOpenGroundOneLineIsLeft) {
  CostGrid grid(frame, {});
  test::fill(grid, [](int, int) { return 1.0F; });
  FieldPlanner field(grid);
  field.compute(grid.cell(50, 30));
  EXPECT_EQ(shortened(grid, field.path_from(grid.cell(5, 5))).size(), 2U);
}

TEST(GridPath, ResampledPathsKeepTheirPoints) {
  const GridPath path{{0, 0}, {1, 0}, {1, 2.5}};
  const GridPath fine = resampled(path, 0.5);
  EXPECT_EQ(fine.size(), 8U);
  for (std::size_t n = 1; n < fine.size(); ++n)
    EXPECT_LE(std::hypot(fine[n].x - fine[n - 1].x, fine[n].y - fine[n - 1].y), 0.5 + 1e-9);
  EXPECT_NEAR(path_length(fine), 3.5, 1e-12);
}

/// A ramp to the east: dearer up than down, and drifting across.
HeadingCosts ramp() {
  auto grid = std::make_shared<CostGrid>(frame, CostParameters{});
  test::fill(*grid, [](int, int) { return 0.9F; });
  HeadingLayers layers;
  layers.elevation = test::values_of(frame, [](int x, int) { return 0.1F * static_cast<float>(x); });
  layers.slip.assign(3600, 0.3F);
  layers.slip_downhill.assign(3600, -0.2F);
  layers.slip_across.assign(3600, 0.1F);
  return {grid, layers, {}};
}

TEST(HeadingCosts, DependOnTheHeading) {
  const HeadingCosts costs = ramp();
  const GridPoint p{10, 10};
  EXPECT_NEAR(*costs.metre(p, 1, 0), 1 + 4 * 0.3, 1e-6);
  EXPECT_NEAR(*costs.metre(p, -1, 0), 1, 1e-6);
  EXPECT_NEAR(*costs.metre(p, 0, 1), 1 + 4 * 0.05 + 4 * 0.1, 1e-6);
  EXPECT_GT(*costs.line({10, 10}, {20, 10}), *costs.line({20, 10}, {10, 10}));
  HeadingLayers wrong;
  wrong.slip.assign(7, 0);
  EXPECT_THROW(HeadingCosts(std::make_shared<CostGrid>(frame, CostParameters{}), wrong, {}), ConfigError);
}

TEST(HeadingCosts, WindAndWaterCost) {
  auto grid = std::make_shared<CostGrid>(frame, CostParameters{});
  test::fill(*grid, [](int, int) { return 0.9F; });
  HeadingLayers layers;
  layers.wind_x.assign(3600, 5);
  layers.water_depth.assign(3600, 0.02F);
  layers.sinkage.assign(3600, 0.01F);
  const HeadingCosts costs(grid, layers, {});
  EXPECT_NEAR(*costs.metre({10, 10}, -1, 0), 1 + 0.02 * 5 + 10 * 0.02 + 20 * 0.01, 1e-6);
  EXPECT_NEAR(*costs.metre({10, 10}, 1, 0), 1 + 10 * 0.02 + 20 * 0.01, 1e-6);
  layers.water_velocity_x.assign(3600, 0.6F);
  layers.water_velocity_y.assign(3600, -0.8F);
  const HeadingCosts flood(grid, layers, {});
  EXPECT_NEAR(*flood.metre({10, 10}, 1, 0), 1 + (10 + 15) * 0.02 + 20 * 0.01, 1e-6);
}

TEST(OmplPlanner, FindsAWayRoundAWallThatCostsLessThanTheKnownOne) {
  auto grid = std::make_shared<CostGrid>(frame, CostParameters{});
  test::fill(*grid, [](int x, int y) { return x == 30 && y < 45 ? 0.0F : 1.0F; });
  const HeadingCosts costs(grid, {}, {});
  const GridPoint start{5, 5}, goal{25, 5};
  const GridPath around{{5, 5}, {5, 28}, {25, 28}, {25, 5}};
  const double shortest = std::hypot(10, 18) * 2;  // over the wall's end, about
  for (const GridPath& known : {around, GridPath()}) {
    const OmplResult result = plan_with_ompl(costs, start, goal, known, {20000, 20, 1});
    ASSERT_TRUE(result.problem.empty()) << result.problem;
    ASSERT_TRUE(path_cost(*grid, result.path));
    EXPECT_LT(result.cost, 1.15 * shortest);
    EXPECT_GT(result.cost, 0.95 * shortest);
    EXPECT_EQ(result.path.front().x, start.x);
    EXPECT_EQ(result.path.back().x, goal.x);
  }
}

/// On any ground it is no worse than what is known, and finds a way or says that it did not.
TEST(OmplPlanner, RefinesKnownPathsOnAnyGround) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 dice(seed);
    auto grid = std::make_shared<CostGrid>(frame, CostParameters{});
    std::vector<CellIndex> changed;
    grid->update({0, 0, frame.width, frame.height}, test::random_ground(frame, dice, 25).data(), changed);
    const auto any = [&] {
      return *grid->nearest_passable({static_cast<double>(dice() % 30), static_cast<double>(dice() % 30)},
                                     20);
    };
    const CellIndex start = any(), goal = seed % 5 == 0 ? start : any();
    FieldPlanner field(*grid);
    field.compute(goal);
    const GridPath known = shortened(*grid, field.path_from(start));
    const HeadingCosts costs(grid, {}, {});
    const OmplResult result =
        plan_with_ompl(costs, grid->centre(start), grid->centre(goal), known, {1000, 20, 1});
    if (known.empty()) {
      EXPECT_TRUE(result.path.empty());
      EXPECT_FALSE(result.problem.empty());
      continue;
    }
    ASSERT_FALSE(result.path.empty());
    EXPECT_LE(result.cost, *costs.path(known) + 1e-9);
    EXPECT_TRUE(path_cost(*grid, result.path)) << "seed " << seed;
  }
}

TEST(OmplPlanner, SaysWhereThereIsNoWay) {
  auto grid = std::make_shared<CostGrid>(frame, CostParameters{});
  test::fill(*grid, [](int x, int) { return x == 30 ? 0.0F : 1.0F; });
  const HeadingCosts costs(grid, {}, {});
  const OmplResult result = plan_with_ompl(costs, {5, 5}, {25, 5}, {}, {2000, 5, 1});
  EXPECT_TRUE(result.path.empty());
  EXPECT_NE(result.problem.find("no path"), std::string::npos);
}

}  // namespace
}  // namespace desert_sim

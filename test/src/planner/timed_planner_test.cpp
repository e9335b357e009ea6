// Paths through ground that changes: waiting, fleeing, going round.
#include "src/planner/timed_planner.hpp"

#include <cmath>

#include "src/core/error.hpp"
#include "test/src/planner/grids.hpp"

namespace desert_sim {
namespace {

constexpr GridFrame frame{60, 21, 1, 0, 0};
constexpr CostParameters thin{16, 8, 0, 0};

std::shared_ptr<const CostGrid> ground(const test::Traversability& t) {
  auto grid = std::make_shared<CostGrid>(frame, thin);
  test::fill(*grid, t);
  return grid;
}

/// A wall across the terrain's whole width.
std::shared_ptr<const CostGrid> wall(int from, int to) {
  return ground([=](int x, int) { return x >= from && x <= to ? 0.0F : 1.0F; });
}
std::shared_ptr<const CostGrid> free_ground() { return wall(-1, -2); }

void expect_passable(const TimedCosts& costs, const std::vector<TimedPoint>& path) {
  for (const TimedPoint& p : path)
    for (std::size_t n = 0; n < costs.times.size(); ++n) {
      // Lethal from the moment before the first at which it is told to be, up to the one after the last.
      const CellIndex cell = *costs.grids[n]->cell_at(p.point);
      if (costs.grids[n]->cost(cell) != CostGrid::lethal) continue;
      const double from = n > 0 ? costs.times[n - 1] : costs.times[n];
      const double to = n + 1 < costs.times.size() ? costs.times[n + 1] : 1e18;
      EXPECT_FALSE(p.departure > from + 1e-6 && p.arrival < to - 1e-6)
          << "at (" << p.point.x << ", " << p.point.y << ") from " << p.arrival << " to " << p.departure;
    }
}

TEST(TimedPlanner, OnStillGroundItTakesTheShortestTime) {
  const TimedCosts costs{{100}, {free_ground()}};
  TimedPlanner planner(costs, {0.5, 2});
  const auto& grid = *costs.grids.front();
  const auto path = planner.plan(grid.cell(5, 10), grid.cell(25, 10));
  ASSERT_EQ(path.size(), 21U);
  EXPECT_EQ(path.front().arrival, 100);
  EXPECT_NEAR(path.back().arrival, 100 + 20 / 0.5, 1e-9);
  for (const TimedPoint& p : path) EXPECT_NEAR(p.departure, p.arrival, 1e-9);
}

TEST(TimedPlanner, WaitsUntilADuneHasPassed) {
  const TimedCosts costs{{0, 100, 200}, {wall(20, 24), wall(20, 24), free_ground()}};
  TimedPlanner planner(costs, {0.5, 2});
  const auto& grid = *costs.grids.front();
  const auto path = planner.plan(grid.cell(5, 10), grid.cell(40, 10));
  ASSERT_FALSE(path.empty());
  expect_passable(costs, path);
  double waited = 0;
  for (const TimedPoint& p : path) waited += p.departure - p.arrival;
  EXPECT_GT(waited, 100);
  // It is free from 200 s on, and 18 m away from where it waits, at x = 18 (the wall has a cell of margin).
  EXPECT_GT(path.back().arrival, 200 + 20 / 0.5);
  EXPECT_LT(path.back().arrival, 200 + 26 / 0.5);
}

TEST(TimedPlanner, HurriesThroughAGapBeforeItCloses) {
  const TimedCosts costs{{0, 60, 120}, {free_ground(), free_ground(), wall(30, 34)}};
  TimedPlanner planner(costs, {0.5, 0});
  const auto& grid = *costs.grids.front();
  const auto early = planner.plan(grid.cell(15, 10), grid.cell(45, 10));
  ASSERT_FALSE(early.empty());
  expect_passable(costs, early);
  EXPECT_NEAR(early.back().arrival, 60, 1e-9);
  EXPECT_TRUE(planner.plan(grid.cell(2, 10), grid.cell(45, 10)).empty()) << "it closes before, for good";
}

/// Ground that is passable at moments, but not between two of them, does not count as passable.
TEST(TimedPlanner, BetweenMomentsTheWorseOneCounts) {
  const TimedCosts costs{{0, 50, 100}, {wall(10, 20), wall(21, 30), wall(31, 40)}};
  TimedPlanner planner(costs, {1, 0});
  const auto& grid = *costs.grids.front();
  const auto path = planner.plan(grid.cell(5, 10), grid.cell(25, 10));
  ASSERT_FALSE(path.empty());
  expect_passable(costs, path);
  EXPECT_GT(path.back().arrival, 100);
}

TEST(TimedPlanner, FleesFromWhereADuneWillBe) {
  const TimedCosts costs{{0, 100}, {free_ground(), wall(5, 15)}};
  TimedPlanner planner(costs, {0.5, 0});
  const auto& grid = *costs.grids.front();
  const auto path = planner.plan(grid.cell(12, 10), grid.cell(30, 10));
  ASSERT_FALSE(path.empty());
  EXPECT_LT(path.back().arrival, 50);
}

/// The ground west of x is lethal from then on, but for a strip of it.
std::shared_ptr<const CostGrid> flood(int x, int strip_from, int strip_to) {
  return ground([=](int cx, int cy) { return cx < x && (cy < strip_from || cy > strip_to) ? 0.0F : 1.0F; });
}

TEST(TimedPlanner, WhereNoWayLeadsToTheGoalItKnowsTheNearestShelter) {
  const auto grid = free_ground();
  const CellIndex start = grid->cell(30, 10), goal = grid->cell(10, 10);
  const TimedCosts costs{{0, 30, 60}, {grid, grid, flood(40, 3, 5)}};
  TimedPlanner planner(costs, {0.5, 0});
  ASSERT_TRUE(planner.plan(start, goal).empty()) << "the goal is 40 s away";
  const std::vector<TimedPoint> path = planner.shelter();
  ASSERT_FALSE(path.empty());
  expect_passable(costs, path);
  EXPECT_EQ(path.front().point.x, grid->centre(start).x);
  EXPECT_EQ(path.back().point.y, 4.5) << "the strip has a cell of margin";
  EXPECT_TRUE(std::isinf(path.back().departure));
  // From 30 s on only the strip counts as passable, and along it a rover comes as near as it can.
  EXPECT_NEAR(path.back().point.x, 10.5, 1e-9);
  EXPECT_FALSE(planner.plan(start, grid->cell(25, 10)).empty());
  EXPECT_TRUE(planner.shelter().empty()) << "a way leads to the goal";
  TimedPlanner lost({{0, 30, 60}, {grid, grid, flood(100, 30, 30)}}, {0.5, 0});
  EXPECT_TRUE(lost.plan(start, goal).empty());
  EXPECT_TRUE(lost.shelter().empty()) << "nowhere can it stay";
}

TEST(TimedPlanner, CostsSlowItDownAndStepsGoOnAtTheNewCost) {
  const auto slow = ground([](int, int) { return 0.01F; });
  const TimedCosts still{{0}, {slow}};
  TimedPlanner planner(still, {1, 3});
  const auto& grid = *slow;
  EXPECT_NEAR(planner.plan(grid.cell(5, 10), grid.cell(15, 10)).back().arrival, 40, 1e-9);
  const TimedCosts changing{{0, 6}, {slow, free_ground()}};
  TimedPlanner later(changing, {1, 3});
  // 1.5 m in 6 s at a quarter of the speed, and 8.5 m at all of it.
  EXPECT_NEAR(later.plan(grid.cell(5, 10), grid.cell(15, 10)).back().arrival, 6 + 8.5, 1e-9);
}

TEST(TimedPlanner, RefusesWhatDoesNotFitTogether) {
  EXPECT_THROW(TimedPlanner({}, {}), ConfigError);
  EXPECT_THROW(TimedPlanner({{0, 1}, {free_ground()}}, {}), ConfigError);
  EXPECT_THROW(TimedPlanner({{1, 1}, {free_ground(), free_ground()}}, {}), ConfigError);
  EXPECT_THROW(TimedPlanner({{0}, {free_ground()}}, {0, 1}), ConfigError);
  auto other = std::make_shared<CostGrid>(GridFrame{3, 3, 1, 0, 0}, thin);
  EXPECT_THROW(TimedPlanner({{0, 1}, {free_ground(), other}}, {}), ConfigError);
}

}  // namespace
}  // namespace desert_sim

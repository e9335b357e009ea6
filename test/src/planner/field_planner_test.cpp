// The field of costs to a goal: against an independent Dijkstra, and repaired against computed anew, to the
// bit.
#include "src/planner/field_planner.hpp"

#include <queue>

#include "test/src/planner/grids.hpp"

namespace desert_sim {
namespace {

using Value = FieldPlanner::Value;

/// By the textbook, with a heap, from the definition in field_planner.hpp.
std::vector<Value> dijkstra(const CostGrid& grid, CellIndex goal) {
  std::vector<Value> value(grid.size(), FieldPlanner::unreachable);
  using Entry = std::pair<Value, CellIndex>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  if (grid.cost(goal) != CostGrid::lethal) open.push({0, goal});
  while (!open.empty()) {
    const auto [at, cell] = open.top();
    open.pop();
    if (value[cell] != FieldPlanner::unreachable) continue;
    value[cell] = at;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = grid.x_of(cell) + dx, y = grid.y_of(cell) + dy;
        if (x < 0 || y < 0 || x >= grid.frame().width || y >= grid.frame().height) continue;
        const CellIndex from = grid.cell(x, y);
        if (grid.cost(from) == CostGrid::lethal || value[from] != FieldPlanner::unreachable) continue;
        open.push({at + (dx != 0 && dy != 0 ? 7U : 5U) * grid.cost(from), from});
      }
  }
  return value;
}

/// The grid's border of lethal cells has no coordinates: all of the rest.
void expect_same(const FieldPlanner& field, const CostGrid& grid, CellIndex goal) {
  const std::vector<Value> truth = dijkstra(grid, goal);
  ASSERT_EQ(field.values(), truth);
}

struct Ground {
  const char* name;
  GridFrame frame;
  int obstacles;
  int changes;  ///< in a round
  bool walls;   ///< whether changes are mostly between passable and lethal
};

void PrintTo(const Ground& g, std::ostream* out) { *out << g.name; }

class Fields : public testing::TestWithParam<Ground> {};

TEST_P(Fields, RepairedAreThoseOfDijkstraToTheBit) {
  const Ground& ground = GetParam();
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 dice(seed);
    CostGrid grid(ground.frame, {seed % 2 ? 16 : 5, 8, 0, 0.5});
    const std::vector<float> start = test::random_ground(ground.frame, dice, ground.obstacles);
    std::vector<CellIndex> changed;
    grid.update({0, 0, ground.frame.width, ground.frame.height}, start.data(), changed);
    const auto any_cell = [&] {
      return grid.cell(static_cast<int>(dice() % static_cast<unsigned>(ground.frame.width)),
                       static_cast<int>(dice() % static_cast<unsigned>(ground.frame.height)));
    };
    const CellIndex goal = any_cell();
    FieldPlanner field(grid), reference(grid);
    field.compute(goal);
    expect_same(field, grid, goal);
    for (int round = 0; round < 60; ++round) {
      changed.clear();
      for (int n = 0; n < ground.changes; ++n) {
        const CellIndex c = any_cell();
        const float t = ground.walls ? (dice() % 2 ? 0.0F : 0.9F) : static_cast<float>(dice() % 101) / 100.0F;
        grid.update({grid.x_of(c), grid.y_of(c), 1, 1}, &t, changed);
      }
      field.note(changed);
      if (round % 3 == 2) {
        field.repair({});
        ASSERT_EQ(field.pending(), 0U);
        expect_same(field, grid, goal);
      } else {
        const CellIndex rover = any_cell();
        field.repair(rover);
        ASSERT_EQ(field.differences(reference), 0U) << "round " << round << ", seed " << seed;
        ASSERT_EQ(field.value(rover), reference.value(rover));
        ASSERT_EQ(field.path_from(rover).empty(), reference.value(rover) >= FieldPlanner::unreachable);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Grounds, Fields,
                         testing::Values(Ground{"open", {60, 40, 0.5, 0, 0}, 0, 10, false},
                                         Ground{"rocks", {50, 70, 0.5, 0, 0}, 40, 8, false},
                                         Ground{"walls", {40, 40, 0.5, 0, 0}, 10, 6, true},
                                         Ground{"mostly_lethal", {40, 40, 0.5, 0, 0}, 60, 30, true},
                                         Ground{"narrow", {120, 5, 0.5, 0, 0}, 2, 3, false},
                                         Ground{"many_changes", {40, 40, 0.5, 0, 0}, 5, 400, false}),
                         [](const auto& each) { return each.param.name; });

/// A goal that is buried, and free again.
TEST(FieldPlanner, AGoalThatBecomesLethalIsOutOfReachUntilItIsFree) {
  const GridFrame frame{30, 30, 0.5, 0, 0};
  CostGrid grid(frame, {});
  test::fill(grid, [](int, int) { return 0.8F; });
  const CellIndex goal = grid.cell(20, 20), rover = grid.cell(5, 5);
  FieldPlanner field(grid);
  field.compute(goal);
  const std::vector<Value> before = field.values();
  std::vector<CellIndex> changed;
  grid.mark(grid.centre(goal), 1, true, changed);
  field.note(changed);
  field.repair(rover);
  EXPECT_EQ(field.value(rover), FieldPlanner::unreachable);
  EXPECT_TRUE(field.path_from(rover).empty());
  changed.clear();
  grid.mark(grid.centre(goal), 1, false, changed);
  field.note(changed);
  field.repair({});
  EXPECT_EQ(field.values(), before);
}

/// What does not matter to the rover is not repaired.
TEST(FieldPlanner, ChangesBehindTheRoverCostNothing) {
  const GridFrame frame{200, 200, 0.5, 0, 0};
  CostGrid grid(frame, {});
  test::fill(grid, [](int, int) { return 1.0F; });
  FieldPlanner field(grid);
  field.compute(grid.cell(100, 190));
  std::vector<CellIndex> changed;
  grid.mark({50, 25}, 5, true, changed);
  field.note(changed);
  field.repair(grid.cell(100, 150));
  EXPECT_EQ(field.statistics().expanded, 0U);
  EXPECT_GT(field.pending(), 0U);
  field.repair(grid.cell(100, 10));
  EXPECT_GT(field.statistics().expanded, 0U);
  FieldPlanner reference(grid);
  EXPECT_EQ(field.differences(reference), 0U);
}

TEST(FieldPlanner, PathsAreOnesOfNeighboursThatCostWhatTheFieldSays) {
  std::mt19937 dice(9);
  const GridFrame frame{80, 60, 0.5, 0, 0};
  CostGrid grid(frame, {});
  std::vector<CellIndex> changed;
  grid.update({0, 0, frame.width, frame.height}, test::random_ground(frame, dice, 30).data(), changed);
  const CellIndex goal = *grid.nearest_passable({35, 25}, 10), rover = *grid.nearest_passable({5, 5}, 10);
  FieldPlanner field(grid);
  field.compute(goal);
  const std::vector<CellIndex> path = field.path_from(rover);
  ASSERT_FALSE(path.empty());
  EXPECT_EQ(path.front(), rover);
  EXPECT_EQ(path.back(), goal);
  Value sum = 0;
  for (std::size_t n = 1; n < path.size(); ++n) {
    const int dx = std::abs(grid.x_of(path[n]) - grid.x_of(path[n - 1])),
              dy = std::abs(grid.y_of(path[n]) - grid.y_of(path[n - 1]));
    ASSERT_EQ(std::max(dx, dy), 1);
    sum += (dx + dy == 2 ? 7U : 5U) * grid.cost(path[n - 1]);
  }
  EXPECT_EQ(sum, field.value(rover));
}

}  // namespace
}  // namespace desert_sim

/// What ~costmap_updates sends.
#include "desert_sim/ros/held_costs.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace {

using namespace desert_sim;

constexpr int width = 8;

void expect_box(const CellBox& box, int x0, int y0, int x1, int y1) {
  EXPECT_EQ((std::vector<int>{box.x0, box.y0, box.x1, box.y1}), (std::vector<int>{x0, y0, x1, y1}));
}

TEST(HeldCosts, CostsOfTraversability) {
  EXPECT_EQ(cost_of(1), 0);
  EXPECT_EQ(cost_of(0.5f), 50);
  EXPECT_EQ(cost_of(1e-6f), 99);
  EXPECT_EQ(cost_of(0), lethal_cost);
  EXPECT_EQ(cost_of(std::nanf("")), unknown_cost);
}

TEST(HeldCosts, SmallChangesWaitUntilTheyAddUp) {
  HeldCosts held;
  held.configure(3);
  std::vector<std::int8_t> now(width * 5, 40);
  held.hold(width, now);
  for (int change = 1; change <= 3; ++change) {
    now[2 * width + 6] = static_cast<std::int8_t>(40 + change);
    EXPECT_TRUE(held.changes(now).empty()) << change;
  }
  now[2 * width + 6] = 44;
  now[3 * width + 1] = 36;
  now[4 * width + 7] = 42;
  const CellBox box = held.changes(now);
  expect_box(box, 1, 2, 7, 4);
  const std::vector<std::int8_t> sent = held.take(now, box);
  ASSERT_EQ(sent.size(), 12u);
  EXPECT_EQ(sent[5], 44);
  EXPECT_EQ(sent[6], 36);
  EXPECT_TRUE(held.changes(now).empty());
  now[4 * width + 7] = 44;  // 42 was never sent
  expect_box(held.changes(now), 7, 4, 8, 5);
}

TEST(HeldCosts, LethalAndUnknownAreAlwaysRight) {
  HeldCosts held;
  held.configure(98);
  std::vector<std::int8_t> now(width, 99);
  held.hold(width, now);
  now[1] = 5;
  EXPECT_TRUE(held.changes(now).empty());
  now[3] = lethal_cost;
  expect_box(held.changes(now), 3, 0, 4, 1);
  held.take(now, {0, 0, width, 1});
  now[3] = 99;
  now[5] = unknown_cost;
  expect_box(held.changes(now), 3, 0, 6, 1);
}

}  // namespace

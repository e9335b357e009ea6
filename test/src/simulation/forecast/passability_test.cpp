// How long cells are passable, and since when, by a sequence of maps of costs that is made by hand.

#include "src/simulation/forecast/passability.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace desert_sim {
namespace {

constexpr float never = std::numeric_limits<float>::infinity();
using Costs = std::vector<std::int8_t>;

TEST(Passability, IsWhereACostIsNeitherLethalNorUnknown) {
  EXPECT_TRUE(is_passable(0));
  EXPECT_TRUE(is_passable(99));
  EXPECT_FALSE(is_passable(100));
  EXPECT_FALSE(is_passable(-1));
}

TEST(Passability, LastsUpToTheMomentBeforeTheFirstLethalOne) {
  //               always  never  closes  opens  closes and opens  opens and closes  unknown for a while
  Passability p(Costs{0, 100, 10, 100, 0, 100, 0});
  p.add(5, Costs{99, 100, 20, 100, 100, 7, -1});
  p.add(10, Costs{3, 100, 100, 50, 8, 100, 3});
  EXPECT_EQ(p.until(), (std::vector<float>{never, 0, 5, 0, 0, 0, 0}));
  EXPECT_EQ(p.from(), (std::vector<float>{0, never, never, 10, 10, never, 10}));
  p.add(15, Costs{3, 100, 1, 50, 8, 4, 100});
  EXPECT_EQ(p.until(), (std::vector<float>{never, 0, 5, 0, 0, 0, 0})) << "what closed once stays closed";
  EXPECT_EQ(p.from(), (std::vector<float>{0, never, 15, 10, 10, 15, never}));
}

TEST(Passability, OfTheBeginningAloneIsForEverOrNever) {
  const Passability p(Costs{0, 100});
  EXPECT_EQ(p.until(), (std::vector<float>{never, 0}));
  EXPECT_EQ(p.from(), (std::vector<float>{0, never}));
}

}  // namespace
}  // namespace desert_sim

// What a ring gives and takes, by hand.

#include "src/simulation/commands/ring.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace desert_sim {
namespace {

std::vector<Quanta> dealt(long long amount, const std::vector<Quanta>& stock) {
  std::vector<Quanta> change(stock.size(), 0);
  distribute_to_ring(amount, stock, change);
  return change;
}

using Changes = std::vector<Quanta>;

TEST(Ring, GivesEqualPartsAndTheRestToTheFirst) {
  EXPECT_EQ(dealt(7, {-1, 5, 0, -1, 9}), (Changes{0, 3, 2, 0, 2}));
  EXPECT_EQ(dealt(2, {4, 4, 4}), (Changes{1, 1, 0}));
  EXPECT_EQ(dealt(0, {4, 4, 4}), (Changes{0, 0, 0}));
}

TEST(Ring, TakesInProportionToTheStock) {
  EXPECT_EQ(dealt(-30, {-1, 20, 40, -1, 0}), (Changes{0, -10, -20, 0, 0}));
  EXPECT_EQ(dealt(-60, {20, 40, 0}), (Changes{-20, -40, 0})) << "all there is";
  EXPECT_EQ(dealt(-2, {1, 1, 1}), (Changes{-1, -1, 0}));
}

TEST(Ring, LeavesTheCellsOfTheShapeAlone) {
  Changes change{5, 0, 7};
  distribute_to_ring(-3, {-1, 8, -1}, change);
  EXPECT_EQ(change, (Changes{5, -3, 7}));
}

TEST(Ring, IsExactForAnyAmount) {
  std::mt19937_64 random(5);
  for (int n = 0; n < 2000; ++n) {
    std::vector<Quanta> stock(1 + random() % 200);
    for (Quanta& held : stock) held = random() % 3 ? static_cast<Quanta>(random() % load_limit) : -1;
    const RingTotals totals = ring_totals(stock);
    if (totals.cells == 0) continue;
    const bool take = n % 2 == 0;
    const auto amount =
        static_cast<long long>(random() % static_cast<std::uint64_t>(take ? totals.stock + 1 : 1LL << 36));
    if (!take && amount / totals.cells >= load_limit) continue;
    const Changes change = dealt(take ? -amount : amount, stock);
    EXPECT_EQ(std::accumulate(change.begin(), change.end(), 0LL), take ? -amount : amount);
    for (std::size_t k = 0; k < stock.size(); ++k) {
      if (stock[k] < 0) {
        EXPECT_EQ(change[k], 0);
      } else if (take) {
        EXPECT_GE(stock[k] + change[k], 0);
      }
    }
  }
}

}  // namespace
}  // namespace desert_sim

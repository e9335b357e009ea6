// The dice that round small amounts: on average right, exact for whole numbers, and without pattern.

#include "kernels/field/dice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "kernels/backend/exec.hpp"

namespace desert_sim {
namespace {

constexpr int width = 256, cells = width * width;

/// The dice of one step on the CPU.
Dice roll(std::uint64_t step, std::uint64_t seed = 1) {
  CpuExec exec(1);
  std::vector<std::uint32_t> keys(static_cast<std::size_t>(Roll::count));
  Dice dice = dice::roll(exec, seed, step, keys.data());
  dice.device_keys = nullptr;
  return dice;
}

TEST(Dice, LeaveWholeNumbersAsTheyAre) {
  const Dice dice = roll(3);
  for (Quanta amount : {0, 1, 2, 100, 255, 256, 257, 1 << 20, 1 << 23, 1 << 24, 1 << 30})
    for (int cell = 0; cell < 20000; ++cell)
      ASSERT_EQ(dice[Roll::lift].whole_at_most(static_cast<float>(amount), wall_height, cell), amount)
          << "cell " << cell;
}

TEST(Dice, RoundSmallAmountsRightOnAverage) {
  for (double amount : {1e-4, 0.01, 0.3, 0.5, 0.999, 7.25, 200.9}) {
    constexpr int steps = 16;
    long long sum = 0;
    for (std::uint64_t step = 0; step < steps; ++step) {
      const Dice dice = roll(step);
      for (int cell = 0; cell < cells; ++cell) {
        const Quanta whole = dice[Roll::deposit].whole_at_most(static_cast<float>(amount), 1000, cell);
        ASSERT_LT(std::abs(whole - amount), 1);
        sum += whole;
      }
    }
    const double n = cells * steps, rest = amount - std::floor(amount);
    EXPECT_NEAR(static_cast<double>(sum), n * amount, 4 * std::sqrt(n * rest * (1 - rest)) + 1) << amount;
  }
}

/// What goes through a face is one amount from either side: rounded with its sign, and right on average, too.
TEST(Dice, RoundAmountsWithASignAlikeFromBothSides) {
  const Die die = roll(5)[Roll::pipe_x];
  for (double amount : {0.01, 0.3, 7.25, 200.9, 1000.6}) {
    long long sum = 0;
    for (int cell = 0; cell < cells; ++cell) {
      const Quanta whole = die.whole(static_cast<float>(amount), cell);
      ASSERT_EQ(die.whole(static_cast<float>(-amount), cell), -whole) << amount << ", cell " << cell;
      sum += whole;
    }
    const double mean = amount < 256 ? amount : std::round(amount), rest = mean - std::floor(mean);
    EXPECT_NEAR(static_cast<double>(sum), cells * mean, 4 * std::sqrt(cells * rest * (1 - rest)) + 1)
        << amount;
  }
}

/// A regular die adds up to the sum within some quanta (3 were found) after any number of turns. One that is
/// rolled is off by 15 after a thousand turns, and one that stands still by hundreds.
TEST(Dice, ThatTurnRegularlyAddUpToTheSumAtEachCell) {
  constexpr int turns = 1000;
  for (double amount : {0.01, 0.3, 0.5, 0.618, 7.25, 200.9}) {
    std::vector<long long> sums(500);
    double farthest = 0;
    for (int turn = 0; turn < turns; ++turn) {
      const Die die = dice::regular(1, Roll::pipe_y, static_cast<std::uint64_t>(turn));
      for (std::size_t cell = 0; cell < sums.size(); ++cell) {
        sums[cell] += die.whole(static_cast<float>(amount), static_cast<int>(cell));
        farthest = std::max(farthest, std::abs(static_cast<double>(sums[cell]) - amount * (turn + 1)));
      }
    }
    EXPECT_LT(farthest, 5) << amount;
  }
}

TEST(Dice, AreNotRolledForLargeAmounts) {
  const Dice dice = roll(0);
  for (int cell = 0; cell < 1000; ++cell) {
    EXPECT_EQ(dice[Roll::lift].whole_at_most(1000.4f, 2000, cell), 1000);
    EXPECT_EQ(dice[Roll::lift].whole_at_most(1000.6f, 2000, cell), 1001);
  }
}

TEST(Dice, TakeNoMoreThanThereIsAndNothingOfNothing) {
  const Dice dice = roll(0);
  for (int cell = 0; cell < 1000; ++cell) {
    EXPECT_LE(dice[Roll::lift].whole_at_most(2.9f, 3, cell), 3);
    EXPECT_EQ(dice[Roll::lift].whole_at_most(1e30f, 7, cell), 7);
    EXPECT_EQ(dice[Roll::lift].whole_at_most(0.9f, 0, cell), 0);
    EXPECT_EQ(dice[Roll::lift].whole_at_most(-0.9f, 9, cell), 0);
    EXPECT_EQ(dice[Roll::lift].whole_at_most(std::nanf(""), 9, cell), 0);
  }
  for (Quanta available : {(1 << 24) + 1, (1 << 25) + 3, (1 << 30) - 1}) {
    const float most = static_cast<float>(available);
    for (float share : {0.5f, 0.9999999f, 1.0f, 1.0000001f})
      EXPECT_LE(dice[Roll::lift].whole_at_most(most * share, available, 1), available);
  }
}

TEST(Dice, MoveWholeCellsByTheDisplacementOnAverage) {
  const Dice dice = roll(9);
  for (int displacement : {5 * 65536, 0, -3 * 65536, 13107, -13107, 347341, -347341}) {
    double sum = 0;
    for (int cell = 0; cell < cells; ++cell) {
      const int moved = Die::whole_cells_if(true, displacement, dice[Roll::hop].word(cell));
      ASSERT_EQ(moved % 65536, 0);
      if (displacement % 65536 == 0) {
        ASSERT_EQ(moved, displacement);
      }
      sum += moved;
    }
    EXPECT_NEAR(sum / cells, displacement, 65536 * 0.5 * 4 / width) << displacement;
  }
}

/// The correlation of two sequences of dice, over all cells.
double correlation(const std::function<std::uint32_t(int)>& a, const std::function<std::uint32_t(int)>& b) {
  double sum = 0;
  for (int cell = 0; cell < cells; ++cell)
    sum += (a(cell) / 4294967296.0 - 0.5) * (b(cell) / 4294967296.0 - 0.5);
  return 12 * sum / cells;
}

/// Of independent dice the correlations would be normal with a deviation of 1/256.
TEST(Dice, AreIndependentOfNeighboursStepsRollsAndSeeds) {
  constexpr double limit = 4.5 / width;
  for (std::uint64_t step : {0u, 1u, 1000u}) {
    const Dice now = roll(step), next = roll(step + 1), other = roll(step, 2);
    const auto word = [](const Die& die, int away = 0) {
      return [die, away](int cell) { return die.word(cell + away); };
    };
    const auto here = word(now[Roll::lift]);
    for (int away : {1, 2, 3, width - 1, width, width + 1, 2 * width})
      EXPECT_LT(std::abs(correlation(here, word(now[Roll::lift], away))), limit) << "cell + " << away;
    EXPECT_LT(std::abs(correlation(here, word(next[Roll::lift]))), limit) << "next step";
    EXPECT_LT(std::abs(correlation(here, word(now[Roll::deposit]))), limit) << "another roll";
    EXPECT_LT(std::abs(correlation(here, word(now[Roll::lift].of_part(1)))), limit) << "another part";
    EXPECT_LT(std::abs(correlation(here, word(other[Roll::lift]))), limit) << "another seed";
    EXPECT_LT(std::abs(correlation(here, [&](int cell) { return here(cell) << 16; })), limit) << "halves";
    EXPECT_NEAR(correlation(here, here), 1, 0.02);
  }
}

}  // namespace
}  // namespace desert_sim

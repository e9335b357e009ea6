// The blocks of slab models: each cell in one, those of a colour far enough apart; and permutations.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <vector>

#include "kernels/slabs/blocks.hpp"

namespace desert_sim::slabs {
namespace {

/// Cells between two, the shorter way on a ring.
int apart(int a, int b, int cells, bool periodic) {
  const int distance = std::abs(a - b);
  return periodic ? std::min(distance, cells - distance) : distance;
}

TEST(SlabBlocks, EachCellIsInOneAndThoseOfAColourAreFarApart) {
  for (int cells : {1, 7, 8, 15, 16, 17, 31, 32, 33, 47, 100, 301})
    for (bool periodic : {true, false})
      for (std::uint32_t word : {0u, 0x40000000u, 0x9e3779b9u, 0xffffffffu}) {
        SCOPED_TRACE(testing::Message() << cells << (periodic ? " periodic" : " open") << ", word " << word);
        const BlockAxis axis(cells, periodic);
        std::vector<int> block_of(static_cast<std::size_t>(cells), -1);
        for (int n = 0; n < axis.blocks(); ++n) {
          const BlockAxis::Interval i = axis.interval(n, axis.shift(word));
          ASSERT_GE(i.size, 0);
          ASSERT_LE(i.size, axis.most_cells());
          for (int k = 0; k < i.size; ++k) {
            ASSERT_TRUE(periodic || i.begin + k < cells);
            int& owner = block_of[static_cast<std::size_t>((i.begin + k) % cells)];
            ASSERT_EQ(owner, -1) << "in two blocks: " << i.begin + k;
            owner = n;
          }
        }
        EXPECT_EQ(axis.of_colour(0) + axis.of_colour(1), axis.blocks());
        for (int a = 0; a < cells; ++a)
          for (int b = 0; b < cells; ++b) {
            const int n = block_of[static_cast<std::size_t>(a)], m = block_of[static_cast<std::size_t>(b)];
            ASSERT_GE(n, 0) << a;
            if (n == m || n % 2 != m % 2) continue;
            ASSERT_GT(apart(a, b, cells, periodic), least_side) << a << " and " << b;
          }
      }
}

TEST(SlabBlocks, AllFourColoursHaveTheirTurn) {
  const Blocks blocks{BlockAxis(33, true), BlockAxis(50, false), Die{12345u, nullptr}};
  std::set<std::pair<int, int>> seen;
  int cells = 0;
  for (int turn = 0; turn < Blocks::colours; ++turn)
    for (int n = 0; n < blocks.most_of_a_colour(); ++n) {
      const Block b = blocks.block(turn, n);
      ASSERT_LE(b.cells(), blocks.most_cells());
      if (b.cells() == 0) continue;
      EXPECT_TRUE(seen.insert({b.line, b.place}).second);
      cells += b.cells();
    }
  EXPECT_EQ(cells, 33 * 50);
}

TEST(SlabBlocks, HowFarACellLiesOutside) {
  const Block b{10, 20, 8, 9};
  EXPECT_EQ(b.beyond(10, 20), 0);
  EXPECT_EQ(b.beyond(17, 28), 0);
  EXPECT_EQ(b.beyond(7, 24), 3);
  EXPECT_EQ(b.beyond(18, 31), 3);
}

TEST(SlabBlocks, PermutationsReachEveryNumberOnce) {
  for (int bits = 0; bits <= 8; ++bits) {
    std::set<std::vector<int>> all;
    for (std::uint32_t key = 0; key < 50; ++key) {
      std::vector<int> order;
      for (int n = 0; n < 1 << bits; ++n) order.push_back(permuted(n, bits, key * 977));
      EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), order.size());
      EXPECT_GE(*std::min_element(order.begin(), order.end()), 0);
      EXPECT_LT(*std::max_element(order.begin(), order.end()), 1 << bits);
      all.insert(order);
    }
    if (bits >= 6) {
      EXPECT_GT(all.size(), 45u) << "orders differ from key to key";
    }
  }
}

}  // namespace
}  // namespace desert_sim::slabs

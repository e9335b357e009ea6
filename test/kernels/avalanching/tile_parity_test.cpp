// Sweeps inside tiles: the reference on the CPU, the reference on the GPU, and the GPU's tuned kernel give
// the same bits, on ordinary terrain and at the ends of what can be counted.

#include "test/support/tile_field.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

void expect_same_bits(test::TileField field, float share) {
  const auto cpu = make_exec("cpu", 2), cuda = make_exec("cuda");
  for (int offset : {0, 4, 20}) {
    field.first_shift = offset / 8;  // 0, 0 and 2
    for (int sweeps : {1, 4, 8}) {
      SCOPED_TRACE(field.name + ", offset " + std::to_string(offset) + ", " + std::to_string(sweeps) +
                   " sweeps, share " + std::to_string(share));
      for (float continue_threshold : {100.0f, 0.1f}) {
        const float edge_factor = continue_threshold > 1 ? 1 : 0.5f;
        const auto reference =
            field.relaxed(*cpu, offset, sweeps, true, share, continue_threshold, edge_factor);
        EXPECT_TRUE(reference ==
                    field.relaxed(*cuda, offset, sweeps, true, share, continue_threshold, edge_factor))
            << "the reference, threshold " << continue_threshold;
        EXPECT_TRUE(reference ==
                    field.relaxed(*cuda, offset, sweeps, false, share, continue_threshold, edge_factor))
            << "the tuned kernel, threshold " << continue_threshold;
      }
    }
  }
}

/// The shares at which the law by pairs, or by quads, is tried.
std::vector<float> shares_of(bool by_gradient) {
  return by_gradient ? std::vector<float>{0.3f, 0.75f} : std::vector<float>{0.3f, 0.65f, 1.0f};
}

class TileParity : public ::testing::TestWithParam<int> {};

TEST_P(TileParity, IsBitForBit) {
  DESERT_NEED_GPU();
  test::TileField field = test::tile_fields()[static_cast<std::size_t>(GetParam())];
  for (const bool by_gradient : {false, true}) {
    field.by_gradient = by_gradient;
    for (float share : shares_of(by_gradient)) expect_same_bits(field, share);
  }
}

TEST(TilesOfFamilies, AreTheSameBitForBit) {
  DESERT_NEED_GPU();
  for (test::TileField field : test::tile_fields_with_coarse_changes())
    for (const bool by_gradient : {false, true}) {
      field.by_gradient = by_gradient;
      expect_same_bits(field, 0.65f);
    }
}

/// In passing, where blocks lie in one tile each, and as a pass of its own.
TEST_P(TileParity, WhatIsFilledAfterwardsIsBitForBit) {
  DESERT_NEED_GPU();
  const auto cpu = make_exec("cpu", 2), cuda = make_exec("cuda");
  test::TileField field = test::tile_fields()[static_cast<std::size_t>(GetParam())];
  for (int offset : {0, 4, 20, 6}) {
    field.by_gradient = offset == 4, field.first_shift = offset / 2 % 4;  // 0, 2, 2 and 3
    SCOPED_TRACE(field.name + ", offset " + std::to_string(offset));
    EXPECT_TRUE(field.relaxed_and_measured(*cpu, offset) == field.relaxed_and_measured(*cuda, offset));
    if (field.coarse().cells() == 0) continue;
    EXPECT_TRUE(field.relaxed_and_restricted(*cpu, offset) == field.relaxed_and_restricted(*cuda, offset));
  }
}

/// More tiles than a GPU has at once.
TEST(ManyTiles, AreTheSameBitForBit) {
  DESERT_NEED_GPU();
  const auto cpu = make_exec("cpu", 2), cuda = make_exec("cuda");
  const test::TileField field = test::tiled(test::tile_fields().front(), 13, 20);
  ASSERT_GE((Tiles{field.grid, 0}.count()), 1200);
  for (int offset : {0, 12}) {
    EXPECT_TRUE(field.relaxed(*cpu, offset, 4, true) == field.relaxed(*cuda, offset, 4, false));
    EXPECT_TRUE(field.relaxed_and_restricted(*cpu, offset) == field.relaxed_and_restricted(*cuda, offset));
    EXPECT_TRUE(field.relaxed_and_measured(*cpu, offset) == field.relaxed_and_measured(*cuda, offset));
  }
}

TEST(ClosedTiles, AreTheSameBitForBit) {
  DESERT_NEED_GPU();
  test::TileField field = test::tile_fields().front();
  for (int n = 0; n < Tiles{field.grid, Tiles::side - 1}.count(); ++n)
    field.active_flags.push_back(n * n % 3);
  expect_same_bits(field, 1);
}

INSTANTIATE_TEST_SUITE_P(All, TileParity, ::testing::Range(0, static_cast<int>(test::tile_fields().size())));

}  // namespace
}  // namespace desert_sim

// Sweeps inside tiles: the reference on the CPU, the reference on the GPU, and the GPU's tuned kernel give
// the same bits, on ordinary terrain and at the ends of what can be counted.

#include "support/tile_field.hpp"
#include "support/world.hpp"

namespace desert_sim {
namespace {

class TileParity : public ::testing::TestWithParam<int> {};

TEST_P(TileParity, IsBitForBit) {
  DESERT_NEED_GPU();
  const auto cpu = make_exec("cpu", 2), cuda = make_exec("cuda");
  const test::TileField field = test::tile_fields()[static_cast<std::size_t>(GetParam())];
  SCOPED_TRACE(field.name);
  for (int offset : {0, 4, 20})
    for (int sweeps : {1, 4, 8})
      for (float transfer : {1.0f, 0.3f}) {
        SCOPED_TRACE("offset " + std::to_string(offset) + ", " + std::to_string(sweeps) + " sweeps, k_c " +
                     std::to_string(transfer));
        const auto reference = field.relaxed(*cpu, offset, sweeps, true, transfer);
        EXPECT_TRUE(reference == field.relaxed(*cuda, offset, sweeps, true, transfer)) << "the reference";
        EXPECT_TRUE(reference == field.relaxed(*cuda, offset, sweeps, false, transfer)) << "the tuned kernel";
      }
}

INSTANTIATE_TEST_SUITE_P(All, TileParity, ::testing::Range(0, static_cast<int>(test::tile_fields().size())));

}  // namespace
}  // namespace desert_sim

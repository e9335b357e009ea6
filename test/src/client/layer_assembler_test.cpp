/// What a client makes of a stream of a layer: the same as of the elevation, under the layer's name and unit.
#include "include/desert_sim/client/layer_assembler.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/messages.hpp"

namespace {

using namespace desert_sim;
using client_test::tile;

LayerGrid::Ptr keyframe(std::uint32_t number, std::uint32_t step, std::vector<float> data) {
  const auto width = static_cast<std::uint32_t>(data.size());
  auto grid = boost::make_shared<LayerGrid>(client_test::empty_keyframe<LayerGrid>(number, step, width, 1));
  grid->layer = "wind_x";
  grid->unit = "m/s";
  grid->data = std::move(data);
  return grid;
}

LayerUpdate::Ptr update(std::uint32_t keyframe, std::uint32_t sequence, std::uint32_t step,
                        const LayerTile& changed) {
  auto u = client_test::update_of<LayerUpdate>(keyframe, sequence, step, changed);
  u->layer = "wind_x";
  return u;
}

TEST(LayerStreams, AreMapsWithNameAndUnit) {
  LayerAssembler assembler;
  const MapChange first = assembler.process(keyframe(3, 10, {1, 2, 3, 4}));
  EXPECT_TRUE(first.replaced);
  EXPECT_EQ(first.map->info().layer, "wind_x");
  EXPECT_EQ(first.map->info().unit, "m/s");
  const MapChange second = assembler.process(update(3, 1, 11, tile(1, 0, 2, 1, 7)));
  EXPECT_EQ(second.cells.x, 1u);
  EXPECT_EQ(second.cells.width, 2u);
  EXPECT_EQ(assembler.map()->values(), (std::vector<float>{1, 7, 7, 4}));
  EXPECT_EQ(assembler.map()->info().unit, "m/s");
  EXPECT_EQ(first.map->values(), (std::vector<float>{1, 2, 3, 4})) << "a map never changes";
}

TEST(LayerStreams, HaveNanWhereNothingIsKnown) {
  LayerAssembler assembler;
  assembler.process(keyframe(1, 1, {1, NAN, 3}));
  EXPECT_TRUE(std::isnan(assembler.map()->at(1, 0)));
  assembler.process(update(1, 1, 2, tile(1, 0, 1, 1, 2)));
  EXPECT_EQ(assembler.map()->at(1, 0), 2);
  assembler.process(update(1, 2, 3, tile(2, 0, 1, 1, NAN)));
  EXPECT_TRUE(std::isnan(assembler.map()->at(2, 0)));
  EXPECT_EQ(assembler.counts().refused, 0u);
  // Cells of 2 m, the first from x = 10 to 12.
  EXPECT_EQ(assembler.map()->value(11, -19), 1);
  EXPECT_FALSE(assembler.map()->value(14, -19)) << "it lies between a known and an unknown cell";
  EXPECT_EQ(assembler.map()->cell_value(13.9, -19), 2);
  EXPECT_FALSE(assembler.map()->cell_value(14.1, -19));
  EXPECT_FALSE(assembler.map()->cell_value(16.1, -19));
  EXPECT_FALSE(assembler.map()->cell_value(NAN, -19));
}

TEST(LayerStreams, ValuesOfCellsReachToTheEdges) {
  LayerAssembler assembler;
  assembler.process(keyframe(1, 1, {1, 2}));
  EXPECT_EQ(assembler.map()->cell_value(10, -20), 1);
  EXPECT_EQ(assembler.map()->cell_value(14, -18), 2);
  EXPECT_EQ(assembler.map()->cell_value(11.99, -19), 1);
  EXPECT_EQ(assembler.map()->cell_value(12.01, -19), 2);
}

TEST(LayerStreams, NoticeALossAndGoOnWithAKeyframe) {
  LayerAssembler assembler;
  assembler.process(keyframe(1, 1, {0, 0}));
  assembler.process(update(1, 2, 3, tile(0, 0, 1, 1, 9)));
  EXPECT_EQ(assembler.need(), KeyframeNeed::lost);
  EXPECT_NE(assembler.counts().last_gap.find("update 1 of keyframe 1 is missing"), std::string::npos);
  EXPECT_EQ(assembler.map()->values(), (std::vector<float>{0, 0})) << "the last valid map stays";
  const MapChange whole = assembler.process(keyframe(2, 4, {9, 0}));
  EXPECT_EQ(assembler.need(), KeyframeNeed::none);
  EXPECT_FALSE(whole.replaced);
  EXPECT_EQ(whole.cells.width, 1u) << "one cell differs";
}

TEST(LayerStreams, RefuseUpdatesOfAnotherLayer) {
  LayerAssembler assembler;
  assembler.process(keyframe(1, 1, {0, 0}));
  const LayerUpdate::Ptr other = update(1, 1, 2, tile(0, 0, 1, 1, 9));
  other->layer = "wind_y";
  assembler.process(other);
  EXPECT_EQ(assembler.counts().refused, 1u);
  EXPECT_NE(assembler.counts().last_refusal.find("its layer is 'wind_y', that of the keyframe 'wind_x'"),
            std::string::npos)
      << assembler.counts().last_refusal;
  EXPECT_EQ(assembler.need(), KeyframeNeed::lost);
}

TEST(LayerStreams, RefuseKeyframesOfAnotherSizeThanTheySay) {
  LayerAssembler assembler;
  const LayerGrid::Ptr broken = keyframe(1, 1, {0, 0});
  broken->data.pop_back();
  assembler.process(broken);
  EXPECT_EQ(assembler.map(), nullptr);
  EXPECT_NE(assembler.counts().last_refusal.find("1 values for 2 x 1 cells"), std::string::npos)
      << assembler.counts().last_refusal;
}

}  // namespace

// What others lack of the surface, found where the terrain lies, against the same done cell by cell.

#include <random>

#include "src/core/error.hpp"
#include "support/held_terrain.hpp"
#include "support/world.hpp"

namespace desert_sim {
namespace {

class HeldElevation : public test::OnBackend {};

TEST_P(HeldElevation, ChangesAreThoseOfABruteForceComparison) {
  std::mt19937 random(5);
  std::normal_distribution<float> ripple(0, 0.01f), slide(0, 1);
  for (const auto& [width, height] : {std::pair{70, 45}, {1, 1}, {32, 33}, {200, 7}, {3, 150}}) {
    test::HeldTerrain terrain(exec(), width, height);
    std::vector<float> elevation(static_cast<std::size_t>(width * height), 100);
    terrain.set(elevation);
    terrain.hold();
    std::vector<float> held = terrain.elevation();
    ASSERT_EQ(terrain.held(), held);
    std::uniform_int_distribution<std::size_t> cell(0, elevation.size() - 1);
    for (int round = 0; round < 12; ++round) {
      const float threshold = round % 4 == 3 ? 0 : std::pow(10.0f, -static_cast<float>(random() % 300) / 100);
      const int tile = std::vector<int>{32, 8, 1, 65536, 16, 5}[random() % 6];
      for (std::size_t n = 0; n < elevation.size() / 7 + 1; ++n) elevation[cell(random)] += ripple(random);
      for (int n = 0; n < round; ++n) elevation[cell(random)] += slide(random);
      terrain.set(elevation);
      SCOPED_TRACE(testing::Message() << width << " x " << height << ", round " << round << ", threshold "
                                      << threshold << ", tile " << tile);
      const auto expected = test::expected_changes(terrain.elevation(), held, width, threshold, tile);
      test::expect_same(terrain.take(threshold, tile), expected);
      ASSERT_EQ(terrain.held(), held);
      EXPECT_TRUE(terrain.take(threshold, tile).empty()) << "they are held now";
    }
  }
}

const char* const world =
    "grid: {width: 90, height: 70, cell_size: 1}\n"
    "terrain: [noise: {layer: bedrock, low: 100, high: 110, scale: 19},\n"
    "          noise: {layer: sand, low: 0.5, high: 3, scale: 9, seed: 2}]\n";

TEST_P(HeldElevation, OfASimulationTellsWhatStepsChanged) {
  auto s = simulation(world);
  EXPECT_FALSE(s->holds_elevation());
  EXPECT_THROW(s->begin_elevation_changes(0.01, 32), StateError);
  test::run(*s, 2);
  s->hold_elevation();
  ASSERT_TRUE(s->holds_elevation());
  std::vector<float> held = s->snapshot({Layer::elevation})->layers.at(Layer::elevation);
  std::size_t changed = 0;
  const std::size_t usual = s->staging().slot_bytes();
  for (int round = 0; round < 6; ++round) {
    s->staging().release();
    s->staging().set_slot_bytes(round % 2 ? 1 : usual);  // a row of tiles at a time
    test::run(*s, 3);
    const float threshold = 0.02f * static_cast<float>(round);
    const auto pending = s->begin_elevation_changes(threshold, 16);
    const std::vector<float> now = s->snapshot({Layer::elevation})->layers.at(Layer::elevation);
    test::run(*s, 2);  // meanwhile
    const auto expected = test::expected_changes(now, held, 90, threshold, 16);
    test::expect_same(pending.get()->tiles, expected);
    changed += expected.size();
  }
  EXPECT_GT(changed, 30u) << "too little happened to tell anything";
  s->forget_elevation();
  EXPECT_FALSE(s->holds_elevation());
}

/// Only the tiles that changed, and of those a byte a cell: what the bus carries.
TEST_P(HeldElevation, OnlyTilesThatChangedArePacked) {
  test::HeldTerrain terrain(exec(), 256, 256);
  std::vector<float> elevation(256 * 256, 10);
  terrain.set(elevation);
  terrain.hold();
  elevation[40 * 256 + 200] += 0.05f;
  elevation[255 * 256 + 3] += 5;
  terrain.set(elevation);
  const std::vector<TileChange> changes = terrain.take(0.01f, 32);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].steps.size(), 32u * 32u);
  EXPECT_EQ(changes[0].bits, 4);
  EXPECT_EQ(changes[1].elevations.size(), 32u * 32u) << "more than 127 steps";
  EXPECT_EQ(packed_tiles::packed_units(1024) * packed_tiles::pack_unit, 1024u + 16u);
}

DESERT_ON_EACH_BACKEND(HeldElevation);

}  // namespace
}  // namespace desert_sim

// What others lack of a layer, found where the terrain lies, against the same done cell by cell.

#include <cmath>
#include <map>
#include <random>

#include "src/simulation/memory/memory.hpp"
#include "test/support/held_terrain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class HeldLayer : public test::OnBackend {};

TEST_P(HeldLayer, ChangesAreThoseOfABruteForceComparison) {
  std::mt19937 random(5);
  std::normal_distribution<float> ripple(0, 0.01f), slide(0, 1);
  for (const auto& [width, height] : {std::pair{70, 45}, {1, 1}, {32, 33}, {200, 7}, {3, 150}}) {
    test::HeldTerrain terrain(exec(), width, height);
    std::vector<float> elevation(static_cast<std::size_t>(width * height), 100);
    terrain.set(elevation);
    terrain.hold();
    std::vector<float> held = terrain.values();
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
      const auto expected = test::expected_changes(terrain.values(), held, width, {threshold}, tile);
      test::expect_same(terrain.take({threshold}, tile), expected);
      ASSERT_EQ(terrain.held(), held);
      EXPECT_TRUE(terrain.take({threshold}, tile).empty()) << "they are held now";
    }
  }
}

/// Of floats, some of which are NaN or 0, and become so or are so no more.
TEST_P(HeldLayer, ChangesFromAndToNanAndASpecialZeroAreSentWhole) {
  constexpr int width = 70, height = 45;
  std::mt19937 random(6);
  std::normal_distribution<float> ripple(0, 0.01f);
  std::uniform_int_distribution<std::size_t> cell(0, width * height - 1);
  for (const bool zero_is_special : {false, true}) {
    test::HeldTerrain terrain(exec(), width, height, Layer::wind_shadow);
    std::vector<float> values(width * height, 0.5f);
    terrain.set(values);
    terrain.hold();
    std::vector<float> held = values;
    std::size_t as_steps = 0, as_values = 0;
    for (int round = 0; round < 24; ++round) {
      const held_layer::Tolerance tolerance{round % 4 == 3 ? 0 : 0.005f, zero_is_special};
      for (std::size_t n = 0; n < 400; ++n) values[cell(random)] += ripple(random);
      for (int n = 0; n < round % 6; ++n) {
        values[cell(random)] = NAN;
        values[cell(random)] = 0;
        values[cell(random)] = 0.002f * static_cast<float>(n);
      }
      terrain.set(values);
      const auto expected = test::expected_changes(values, held, width, tolerance, 16);
      SCOPED_TRACE(testing::Message() << "round " << round << ", zero is special: " << zero_is_special);
      test::expect_same(terrain.take(tolerance, 16), expected);
      ASSERT_TRUE(test::same_bits(terrain.held(), held));
      EXPECT_TRUE(terrain.take(tolerance, 16).empty()) << "they are held now";
      for (const TileChange& tile : expected) ++(tile.bits ? as_steps : as_values);
      for (std::size_t i = 0; i < values.size(); ++i) {
        ASSERT_EQ(std::isnan(held[i]), std::isnan(values[i]));
        ASSERT_TRUE(!zero_is_special || values[i] != 0 || held[i] == 0);
      }
    }
    EXPECT_GT(as_steps, 20u);
    EXPECT_GT(as_values, 20u);
  }
}

const char* const held_world =
    "grid: {width: 90, height: 70, cell_size: 1}\n"
    "terrain: [noise: {layer: bedrock, low: 100, high: 110, scale: 19},\n"
    "          noise: {layer: sand, low: 0.5, high: 3, scale: 9, seed: 2}]\n";

TEST_P(HeldLayer, OfASimulationTellsWhatStepsChanged) {
  auto s = simulation(held_world);
  EXPECT_FALSE(s->views().holds(Layer::elevation));
  EXPECT_FALSE(test::begin_changes(*s, 0.01f, 32));
  test::run(*s, 2);
  test::hold(*s);
  ASSERT_TRUE(s->views().holds(Layer::elevation));
  std::vector<float> held = s->views().snapshot({Layer::elevation})->layers.at(Layer::elevation);
  std::size_t changed = 0;
  const std::size_t usual = s->views().staging().slot_bytes();
  for (int round = 0; round < 6; ++round) {
    s->views().staging().release();
    s->views().staging().set_slot_bytes(round % 2 ? 1 : usual);  // a row of tiles at a time
    test::run(*s, 3);
    const float threshold = 0.02f * static_cast<float>(round);
    const auto pending = test::begin_changes(*s, threshold, 16);
    const std::vector<float> now = s->views().snapshot({Layer::elevation})->layers.at(Layer::elevation);
    test::run(*s, 2);  // meanwhile
    const auto expected = test::expected_changes(now, held, 90, {threshold}, 16);
    test::expect_same(pending.get()->tiles, expected);
    changed += expected.size();
  }
  EXPECT_GT(changed, 30u) << "too little happened to tell anything";
  s->views().forget(Layer::elevation);
  EXPECT_FALSE(s->views().holds(Layer::elevation));
}

/// Layers of each kind: stored quanta and floats, derived, computed on request, and absent ones.
TEST_P(HeldLayer, OfAnyLayerOfASimulation) {
  auto s = simulation(held_world);
  const std::vector<Layer> layers{Layer::bedrock,       Layer::sand,        Layer::wind_x,
                                  Layer::slope,         Layer::wind_shadow, Layer::traversability,
                                  Layer::water_surface, Layer::water};
  std::map<Layer, std::vector<float>> held;
  HeldQueries queries;
  for (Layer layer : layers) queries[layer].hold = HeldQuery::Hold::present;
  EXPECT_TRUE(s->views().begin_changes(queries).empty()) << "nothing was held, and nothing was asked for";
  for (Layer layer : layers) held[layer] = s->views().snapshot({layer})->layers.at(layer);
  std::map<Layer, std::size_t> changed;
  for (int round = 0; round < 4; ++round) {
    test::run(*s, 4);
    s->views().release_requested_layers();
    for (Layer layer : layers) queries[layer] = {true, {0.002f, layer == Layer::traversability}, 16};
    const PendingChanges pending = s->views().begin_changes(queries);
    ASSERT_EQ(pending.size(), layers.size());
    for (Layer layer : layers) {
      SCOPED_TRACE(info(layer).name);
      const std::vector<float> now = s->views().snapshot({layer})->layers.at(layer);
      const auto expected = test::expected_changes(now, held[layer], 90, queries[layer].tolerance, 16);
      test::expect_same(pending.at(layer).get()->tiles, expected);
      changed[layer] += expected.size();
    }
  }
  for (Layer layer : layers)
    EXPECT_EQ(changed[layer] == 0, layer == Layer::bedrock || layer == Layer::water)
        << info(layer).name << ": " << changed[layer];
}

TEST_P(HeldLayer, OnlyWhatIsAskedForIsComputedAndKept) {
  auto s = simulation(held_world);
  const std::size_t before = s->terrain().bytes(), layer = 4 * 90 * 70;
  test::hold(*s, Layer::slope);
  EXPECT_TRUE(s->views().holds(Layer::slope));
  EXPECT_FALSE(s->views().holds(Layer::traversability));
  EXPECT_EQ(s->terrain().bytes(), before + layer) << "the slope alone";
  HeldQueries queries;
  queries[Layer::traversability].changes = true;
  EXPECT_TRUE(s->views().begin_changes(queries).empty()) << "nothing is held of it";
  EXPECT_EQ(s->terrain().bytes(), before + layer);
  const std::size_t held = total_bytes(s->memory());
  s->views().forget(Layer::slope);
  EXPECT_EQ(total_bytes(s->memory()), held - layer);
}

/// Only the tiles that changed, and of those a byte a cell: what the bus carries.
TEST_P(HeldLayer, OnlyTilesThatChangedArePacked) {
  test::HeldTerrain terrain(exec(), 256, 256);
  std::vector<float> elevation(256 * 256, 10);
  terrain.set(elevation);
  terrain.hold();
  elevation[40 * 256 + 200] += 0.05f;
  elevation[255 * 256 + 3] += 5;
  terrain.set(elevation);
  const std::vector<TileChange> changes = terrain.take({0.01f}, 32);
  ASSERT_EQ(changes.size(), 2u);
  EXPECT_EQ(changes[0].steps.size(), 32u * 32u);
  EXPECT_EQ(changes[0].bits, 4);
  EXPECT_EQ(changes[1].values.size(), 32u * 32u) << "more than 127 steps";
  EXPECT_EQ(packed_tiles::packed_units(1024) * packed_tiles::pack_unit, 1024u + 16u);
}

DESERT_ON_EACH_BACKEND(HeldLayer);

}  // namespace
}  // namespace desert_sim

// Plants as others see them: which species grows where, and their list.

#include <algorithm>

#include "test/support/plants.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using test::Plant;
using test::PlantBench;
using test::undemanding;

class PlantMarking : public test::OnBackend {
 protected:
  void mark(PlantBench& b, int first = 0, int rows = 0) {
    b.terrain.terrain.allocate(Layer::plants);
    const TerrainView view = b.terrain.terrain.view();
    with_backend(exec(), [&](auto& e) {
      plants::find_dominant_species(e, view, first, rows ? rows : view.grid.height, b.work.neighbourhood(),
                                    b.work.plants(), b.work.species.data());
    });
  }
};

TEST_P(PlantMarking, TheDensestPlantGivesACellItsSpecies) {
  PlantBench b(exec(), 40, 30, {undemanding(), undemanding(), undemanding()});
  // In the middle between the first two, the wider one is denser; the third stands alone, over the edge.
  b.put(
      {{10.5f, 10.5f, 0, 3, 1, 0, 0, 1}, {14.5f, 10.5f, 0, 6, 1, 0, 0, 0}, {39.5f, 20.5f, 0, 2, 1, 0, 0, 2}});
  mark(b);
  const auto at = [&](int x, int y) { return b.terrain.at(Layer::plants, x, y); };
  EXPECT_EQ(at(10, 10), 2);
  EXPECT_EQ(at(14, 10), 1);
  EXPECT_EQ(at(12, 10), 1);
  EXPECT_EQ(at(8, 10), 2) << "outside the wide one's radius";
  EXPECT_EQ(at(39, 20), 3);
  EXPECT_EQ(at(0, 20), 3) << "over the edge of the torus";
  EXPECT_EQ(at(25, 25), 0) << "bare";
}

TEST_P(PlantMarking, OfEqualPlantsTheFirstInOrderAndOnlyTheRowsAskedFor) {
  PlantBench b(exec(), 20, 20, {undemanding(), undemanding()});
  b.put({{10.5f, 1.5f, 0, 2, 1, 0, 0, 1}, {10.5f, 1.5f, 0, 2, 1, 0, 0, 0}, {10.5f, 8.5f, 0, 2, 1, 0, 0, 1}});
  mark(b, 18, 6);  // rows 18, 19, 0 … 3
  EXPECT_EQ(b.terrain.at(Layer::plants, 10, 1), b.plants().front().species + 1);
  EXPECT_EQ(b.terrain.at(Layer::plants, 10, 8), 0) << "not asked for";
}

TEST_P(PlantMarking, APlantThatIsBuriedDoesNotShow) {
  PlantBench b(exec(), 20, 20, {undemanding()});
  b.put({{10.5f, 10.5f, -10, 2, 1, 0, 0, 0}});
  mark(b);
  EXPECT_EQ(b.terrain.at(Layer::plants, 10, 10), 0);
}

const char* const meadow =
    "grid: {width: 60, height: 50, cell_size: 2, origin_x: 100, origin_y: -40}\n"
    "terrain:\n"
    "  - noise: {layer: bedrock, low: 0, high: 4, scale: 40}\n"
    "  - uniform: {layer: soil, value: 2}\n"
    "  - noise: {layer: moisture, low: 0.01, high: 0.25, scale: 30, seed: 4}\n"
    "  - noise: {layer: water, low: 0, high: 5, scale: 30, threshold: 0.6, seed: 5}\n"
    "vegetation: {enabled: true}\n"
    "species:\n"
    "  - {preset: bush, light_lowest: -2, light_highest: 3, spawn: 5, spawn_density: 100, hue: 300}\n"
    "  - {preset: seaweed, spawn: 20}\n";

TEST_P(PlantMarking, ASnapshotShowsSpeciesAndTheWatersSurface) {
  auto s = simulation(meadow);
  test::run(*s, 20);
  const auto hash = s->state().hash();
  const auto all = s->views().snapshot(
      {Layer::plants, Layer::vegetation, Layer::water_surface, Layer::elevation, Layer::water});
  EXPECT_EQ(s->state().hash(), hash) << "a look changes nothing";
  ASSERT_EQ(all->crown_colours.size(), 2u);
  EXPECT_GT(all->crown_colours[0][0], all->crown_colours[0][1]) << "violet bushes";
  const auto& marks = all->layers.at(Layer::plants);
  const auto& density = all->layers.at(Layer::vegetation);
  int of[3] = {};
  for (std::size_t i = 0; i < marks.size(); ++i) {
    ++of[static_cast<int>(marks[i])];
    if (marks[i] == 0) {
      EXPECT_LT(density[i], 0.5);
    }
    const float surface = all->layers.at(Layer::elevation)[i] + all->layers.at(Layer::water)[i];
    EXPECT_NEAR(all->layers.at(Layer::water_surface)[i], surface, 1e-5);
  }
  for (int n = 0; n < 3; ++n) EXPECT_GT(of[n], 4) << "kind " << n;
}

TEST_P(PlantMarking, AListHasEveryPlantInItsOrder) {
  auto s = simulation(meadow);
  test::run(*s, 20);
  const int count = s->state().plants.count;
  ASSERT_GT(count, 100);
  const std::vector<std::uint32_t> words = plants::words(s->state().plants);
  const auto word = [&](plants::Column c, int n) {
    return words[static_cast<std::size_t>(c) * static_cast<std::size_t>(count) + static_cast<std::size_t>(n)];
  };
  for (std::size_t slot :
       {s->views().staging().slot_bytes(), 7 * sizeof(plants::PlantRecord)}) {  // in one piece, in many
    s->views().staging().set_slot_bytes(slot);
    const auto list = s->views().begin_plants().get();
    EXPECT_EQ(list->origin_x, 100);
    EXPECT_EQ(list->origin_y, -40);
    EXPECT_EQ(list->step, 20u);
    ASSERT_EQ(list->species.size(), 2u);
    EXPECT_EQ(list->species[0].name, "bush");
    ASSERT_EQ(list->plants.size(), static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) {
      const plants::PlantRecord& plant = list->plants[static_cast<std::size_t>(n)];
      EXPECT_EQ(plant.x, float_from_bits(word(plants::Column::x, n)));
      EXPECT_EQ(plant.y, float_from_bits(word(plants::Column::y, n)));
      EXPECT_EQ(plant.radius, float_from_bits(word(plants::Column::radius, n)));
      EXPECT_EQ(plant.species, word(plants::Column::species, n));
      EXPECT_NEAR(plant.health / 255.0, float_from_bits(word(plants::Column::health, n)), 0.5 / 255 + 1e-6);
      const double z = s->terrain().scale().datum +
                       static_cast<std::int32_t>(word(plants::Column::z, n)) * s->terrain().scale().quantum();
      EXPECT_NEAR(plant.z, z, 1e-5);
    }
  }
}

TEST_P(PlantMarking, WherePlantsAreOffThereAreNone) {
  auto s = simulation("grid: {width: 20, height: 20}\n");
  EXPECT_FALSE(s->views().shows(Layer::plants));
  EXPECT_TRUE(s->views().shows(Layer::water_surface));
  const auto list = s->views().begin_plants().get();
  EXPECT_TRUE(list->plants.empty());
  EXPECT_TRUE(list->species.empty());
  const auto marks = s->views().snapshot({Layer::plants})->layers.at(Layer::plants);
  EXPECT_EQ(*std::max_element(marks.begin(), marks.end()), 0);
}

DESERT_ON_EACH_BACKEND(PlantMarking);

}  // namespace
}  // namespace desert_sim

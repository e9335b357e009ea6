// Planting and clearing: by species, region and density; journalled; refused whole or applied whole.

#include <algorithm>
#include <cmath>

#include "src/simulation/session.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const meadow =
    "grid: {width: 80, height: 60, cell_size: 2, origin_x: 1000, origin_y: -500}\n"
    "terrain: [uniform: {layer: soil, value: 4}]\nwind: {speed: 2}\n"
    "vegetation: {enabled: true, max_plants: 3000}\n"
    "species: [{name: grass, max_radius: 1, root: 0.5, light_highest: 2, moisture_lowest: 0, water_use: 0, "
    "spawn: 0, "
    "maturity_time: 1e9}, {preset: tree, light_highest: 2, moisture_lowest: 0, water_use: 0, spawn: 0}]\n";

command::EditPlants planting(const std::string& species, double x, double y, double radius, double density) {
  command::EditPlants edit;
  edit.species = species;
  edit.x = x;
  edit.y = y;
  edit.radius = radius;
  edit.density = density;
  return edit;
}

class PlantEdits : public test::OnBackend {
 protected:
  static std::vector<float> column(const Simulation& s, plants::Column c) {
    const std::vector<std::uint32_t> words = plants::words(s.state().plants);
    const auto count = static_cast<std::size_t>(s.state().plants.count);
    std::vector<float> values;
    for (std::size_t n = 0; n < count; ++n)
      values.push_back(float_from_bits(words[static_cast<std::size_t>(c) * count + n]));
    return values;
  }
  static std::string refusal(Simulation& s, const command::EditPlants& edit) {
    const std::uint64_t before = s.state().hash();
    std::string why = "was not refused";
    try {
      s.apply(edit);
    } catch (const ConfigError& e) {
      why = e.what();
    }
    EXPECT_EQ(s.state().hash(), before) << "a refused edit changed something";
    return why;
  }
};

TEST_P(PlantEdits, PlantsOfASpeciesStandInTheRegionAsDenseAsAsked) {
  auto s = simulation(meadow);
  command::EditPlants edit = planting("grass", 1060, -440, 20, 0.5);
  edit.size = 0.75;
  const CommandResult result = s->apply(edit);
  const double expected = 3.14159 * 400 * 0.5;
  EXPECT_NEAR(result.plants, expected, 4 * std::sqrt(expected));
  EXPECT_EQ(s->state().plants.count, result.plants);
  EXPECT_EQ(s->state().plant_counts()[0].plants, result.plants);
  EXPECT_EQ(s->state().plant_counts()[1].plants, 0);
  const std::vector<float> x = column(*s, plants::Column::x), y = column(*s, plants::Column::y);
  for (std::size_t n = 0; n < x.size(); ++n) EXPECT_LE(std::hypot(x[n] - 60, y[n] - 60), 20.001);
  const std::vector<float> cover = test::real(*s, Layer::vegetation);
  EXPECT_GT(std::count_if(cover.begin(), cover.end(), [](float v) { return v > 0; }), 50)
      << "seen before the next step";
  for (float radius : column(*s, plants::Column::radius)) EXPECT_FLOAT_EQ(radius, 0.75f);
}

TEST_P(PlantEdits, RegionsGoThroughPeriodicBorders) {
  auto s = simulation(meadow);
  EXPECT_GT(s->apply(planting("grass", 1000, -500, 10, 1)).plants, 250);
  int corners[4] = {};
  const std::vector<float> x = column(*s, plants::Column::x), y = column(*s, plants::Column::y);
  for (std::size_t n = 0; n < x.size(); ++n) ++corners[(x[n] > 80) + 2 * (y[n] > 60)];
  for (int count : corners) EXPECT_GT(count, 50);
}

TEST_P(PlantEdits, ClearsByRegionAndSpecies) {
  auto s = simulation(meadow);
  command::EditPlants field = planting("grass", 1080, -440, 60, 0.2);
  field.shape = BrushShape::rectangle;
  field.radius_y = 50;
  s->apply(field);
  field.species = "tree";
  field.density = 0.02;
  field.size = 0.2;
  s->apply(field);
  const auto before = s->state().plant_counts();
  ASSERT_GT(before[0].plants, 1000);
  ASSERT_GT(before[1].plants, 100);
  command::EditPlants clearing = planting("tree", 1080, -440, 25, 0);
  clearing.operation = PlantEdit::clear;
  const long long fewer = s->apply(clearing).plants;
  EXPECT_LT(fewer, 0);
  EXPECT_EQ(s->state().plant_counts()[0].plants, before[0].plants);
  EXPECT_EQ(s->state().plant_counts()[1].plants, before[1].plants + fewer);
  clearing.species = "";
  clearing.shape = BrushShape::polygon;
  clearing.points = {{1000, -500}, {1160, -500}, {1160, -440}, {1000, -440}};
  s->apply(clearing);
  for (float y : column(*s, plants::Column::y)) EXPECT_GE(y, 60);
  EXPECT_GT(s->state().plants.count, 0);
}

TEST_P(PlantEdits, NoneStandOnRockOrOnObstacles) {
  auto s = simulation(
      "grid: {width: 40, height: 40}\n"
      "terrain: [column: {layer: soil, x: 10, y: 20, size_x: 20, size_y: 40, height: 3}, obstacle: {x: 10, "
      "y: 10, "
      "size_x: 8, size_y: 8}]\nvegetation: {enabled: true}\nspecies: [{preset: bush}]\n");
  s->apply(planting("bush", 20, 20, 100, 1));
  EXPECT_GT(s->state().plants.count, 500);
  const std::vector<float> x = column(*s, plants::Column::x), y = column(*s, plants::Column::y);
  for (std::size_t n = 0; n < x.size(); ++n) {
    EXPECT_LT(x[n], 20);
    EXPECT_GT(std::hypot(std::floor(x[n]) + 0.5 - 10, std::floor(y[n]) + 0.5 - 10), 4);
  }
}

TEST_P(PlantEdits, AreRefusedWhole) {
  auto s = simulation(meadow);
  s->apply(planting("grass", 1060, -440, 20, 0.5));
  s->step();
  const auto expect = [&](const command::EditPlants& edit, std::initializer_list<const char*> texts) {
    const std::string why = refusal(*s, edit);
    for (const char* text : texts)
      EXPECT_NE(why.find(text), std::string::npos) << "no '" << text << "' in: " << why;
  };
  expect(planting("oak", 0, 0, 1, 1), {"species", "'oak'", "grass, tree"});
  expect(planting("gras", 0, 0, 1, 1), {"species", "did you mean 'grass'?"});
  expect(planting("", 0, 0, 1, 1), {"species"});
  expect(planting("grass", 1080, -440, 200, 2), {"density", "3000", "max_plants"});
  expect(planting("grass", 0, 0, -1, 1), {"radius", "-1"});
  expect(planting("grass", NAN, 0, 1, 1), {"x", "nan"});
  expect(planting("grass", 0, 0, 1, 1e9), {"density"});
  command::EditPlants shape = planting("grass", 0, 0, 1, 1);
  shape.shape = BrushShape::patch;
  expect(shape, {"shape", "patch"});
  shape.shape = BrushShape::polygon;
  shape.points = {{0, 0}, {1, 1}};
  expect(shape, {"points"});
  auto bare = simulation("grid: {width: 8, height: 8}\n");
  EXPECT_NE(refusal(*bare, planting("grass", 0, 0, 1, 1)).find("vegetation.enabled"), std::string::npos);
}

/// On cells of a kilometre, a density that is allowed would draw a thousand million places a cell.
TEST_P(PlantEdits, ThatWouldDrawTooManyPlacesAreRefusedAtOnce) {
  auto s = simulation(
      "grid: {width: 60, height: 50, cell_size: 1000}\nterrain: [uniform: {layer: soil, value: 4}]\n"
      "vegetation: {enabled: true}\nspecies: [{preset: bush}]\n");
  const std::string all = refusal(*s, planting("bush", 30000, 25000, 1e6, 1000));
  for (const char* text : {"density: 1000", "3e+12 places", "at most 1e+07", "0.00333333 1/m^2"})
    EXPECT_NE(all.find(text), std::string::npos) << "no '" << text << "' in: " << all;
  command::EditPlants polygon = planting("bush", 0, 0, 1, 1);
  polygon.shape = BrushShape::polygon;
  for (int n = 0; n < 500; ++n)
    polygon.points.push_back({30000 + 20000 * std::cos(0.0125 * n), 25000 + 20000 * std::sin(0.0125 * n)});
  EXPECT_NE(refusal(*s, polygon).find("at most 2e+06"), std::string::npos);
  EXPECT_GT(s->apply(planting("bush", 30500, 25500, 300, 1e-3)).plants, 200)
      << "a small region is no trouble";
}

TEST_P(PlantEdits, AreReplayedFromTheJournal) {
  const test::TemporaryFolder folder;
  const auto session = [&](const std::string& journal) {
    return std::make_unique<Session>(test::scenario_of(meadow), no_raster_loader, GetParam(), 1, journal);
  };
  std::uint64_t hash = 0;
  {
    auto s = session(folder.path("j"));
    s->step();
    s->apply(planting("grass", 1000.1, -440, 20.3, 1.0 / 3));
    s->step();
    command::EditPlants stroke = planting("tree", 0, 0, 5.5, 0.1);
    stroke.shape = BrushShape::capsule;
    stroke.points = {{1010, -480}, {1100.5, -430}};
    stroke.size = 0.3;
    stroke.seed = 7;
    s->apply(stroke);
    stroke.operation = PlantEdit::clear;
    stroke.radius = 2;
    s->step();
    s->apply(stroke);
    s->step();
    hash = s->simulation().state().hash();
  }
  const Journal journal = read_journal(folder.path("j"));
  ASSERT_EQ(journal.entries.size(), 3u);
  auto again = session("");
  std::size_t next = 0;
  for (std::uint64_t tick = 0; tick <= journal.ticks; ++tick) {
    for (; next < journal.entries.size() && journal.entries[next].tick == tick; ++next)
      again->apply(journal.entries[next].command);
    if (tick < journal.ticks) again->step();
  }
  EXPECT_EQ(again->simulation().state().hash(), hash);
}

DESERT_ON_EACH_BACKEND(PlantEdits);

}  // namespace
}  // namespace desert_sim

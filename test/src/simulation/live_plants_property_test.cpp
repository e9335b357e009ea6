// Species that change while their plants live, and plants that begin to live in the middle of a run.

#include <gmock/gmock.h>

#include "src/scenario/live_parameters.hpp"
#include "src/simulation/checkpoint.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using ::testing::HasSubstr;

const std::string ground =
    "grid: {width: 24, height: 18, boundary: open}\n"
    "terrain: [uniform: {layer: soil, value: 2}, noise: {layer: sand, low: 0, high: 1},\n"
    "          uniform: {layer: moisture, value: 0.1}]\n"
    "rain: {rate: 1.0e-5}\n";
/// The traits after `bush` and `tree`; the rest of the file follows.
std::string plants(const std::string& bush = ", spawn: 60", const std::string& tree = ", spawn: 20",
                   const std::string& rest = "") {
  return "species: [{preset: bush, moisture_lowest: 0, light_highest: 2" + bush +
         "}, {preset: tree, moisture_lowest: 0, light_highest: 2" + tree + "}]\n" + rest;
}
const std::string living = "vegetation: {enabled: true}\n";

class LivePlants : public test::OnBackend {
 protected:
  /// The command at the start comes to the same as a scenario that has it.
  void expect_same_as_scenario(const std::string& before, const std::vector<std::string>& settings,
                               const std::string& after) {
    const auto changed = simulation(before), started = simulation(after);
    changed->apply(command::SetParameters{settings});
    test::run(*changed, 40);
    test::run(*started, 40);
    ASSERT_GT(started->state().plants.count, 5);
    EXPECT_EQ(changed->state().hash(), started->state().hash());
    const auto neither = simulation(before);
    test::run(*neither, 40);
    EXPECT_NE(neither->state().hash(), started->state().hash()) << "it has an effect";
  }
  void expect_refused(Simulation& s, const std::vector<std::string>& settings, const std::string& reason) {
    const std::string before = dump_scenario(s.state().present_scenario());
    const std::uint64_t hash = s.state().hash();
    EXPECT_THAT(test::refusal([&] { s.apply(command::SetParameters{settings}); }), HasSubstr(reason));
    EXPECT_EQ(dump_scenario(s.state().present_scenario()), before);
    EXPECT_EQ(s.state().hash(), hash);
  }
};

TEST_P(LivePlants, TakeTraitsAsAScenarioWouldGiveThem) {
  const std::string before = ground + living + plants();
  expect_same_as_scenario(before, {"species.0.spawn=150", "species.1.max_radius=1.5"},
                          ground + living + plants(", spawn: 150", ", spawn: 20, max_radius: 1.5"));
  expect_same_as_scenario(
      before, {"competition=[[1, 40], [0, 1]]"},
      ground + living + plants(", spawn: 60", ", spawn: 20", "competition: [[1, 40], [0, 1]]\n"));
  expect_same_as_scenario(
      before, {"competition.0.1=40"},
      ground + living + plants(", spawn: 60", ", spawn: 20", "competition: [[1, 40], [1, 1]]\n"));
}

TEST_P(LivePlants, GetOtherSpeciesBesideThem) {
  const std::string third = "{preset: palm, spawn: 90, moisture_lowest: 0, light_highest: 2}", two = plants();
  expect_same_as_scenario(ground + living + two, {"species.2=" + third},
                          ground + living + two.substr(0, two.rfind(']')) + ", " + third + "]\n");
}

TEST_P(LivePlants, BeginToLive) {
  expect_same_as_scenario(ground + plants(), {"vegetation.enabled=true"}, ground + living + plants());
  const std::string list = plants().substr(std::string("species: ").size());
  expect_same_as_scenario(ground, {"vegetation.enabled=true", "species=" + list}, ground + living + plants());
}

TEST_P(LivePlants, GoOnFromACheckpointWithTheirNewSpecies) {
  const test::TemporaryFolder folder;
  const auto s = simulation(ground + plants());
  test::run(*s, 5);
  s->apply(command::SetParameters{{"vegetation.enabled=true"}});
  test::run(*s, 20);
  s->apply(command::SetParameters{{"species.0.max_radius=0.4", "species.2={preset: palm}"}});
  test::run(*s, 5);
  test::expect_sound(*s, "with new species");
  save_checkpoint(folder.path("c"), *s);
  const auto loaded = load_checkpoint(folder.path("c"), exec());
  ASSERT_EQ(loaded->state().hash(), s->state().hash());
  EXPECT_EQ(loaded->state().plant_counts().size(), 3u);
  test::run(*s, 10);
  test::run(*loaded, 10);
  EXPECT_EQ(s->state().hash(), loaded->state().hash());
}

/// Where slabs move, the wind by which seeds spread is that of the step, whether somebody looks before it or
/// not.
TEST_P(LivePlants, SpreadAlikeAmongSlabsWhetherSomebodyLooksOrNot) {
  const std::string garden =
      "grid: {width: 48, height: 40}\nterrain: [uniform: {layer: soil, value: 2}, uniform: {layer: moisture, "
      "value: 0.1}]\n"
      "wind: {speed: 6}\nsand: {model: werner}\nvegetation: {enabled: true}\nspecies: [{preset: bush, spawn: "
      "10, spawn_density: 0, spawn_wind: 1000, moisture_lowest: 0, light_highest: 2}]\n";
  const auto looked_at = simulation(garden), alone = simulation(garden);
  command::EditPlants plants;
  plants.species = "bush";
  plants.x = plants.y = 20;
  plants.radius = 12;
  plants.density = 0.2;
  plants.size = 1;
  for (float direction : {0.0f, 120.0f, 240.0f}) {
    for (Simulation* const s : {looked_at.get(), alone.get()}) {
      s->apply(command::SetWind{direction, 8, 0});
      s->apply(plants);
      if (s == looked_at.get()) s->pipeline().refresh_derived();
      s->step();
    }
    plants.seed += 1;
    EXPECT_EQ(looked_at->state().hash(), alone->state().hash()) << direction;
  }
}

TEST_P(LivePlants, ArePlantedAndUndoneOnceTheyCanLive) {
  const auto s = simulation(ground + plants(", spawn: 0", ", spawn: 0"));
  s->commands().history().set_memory(default_undo_memory);
  command::EditPlants edit;
  edit.species = "bush";
  edit.x = 10, edit.y = 9, edit.radius = 5, edit.density = 0.4, edit.size = 0.3;
  EXPECT_THAT(test::refusal([&] { s->apply(edit); }), HasSubstr("vegetation.enabled"));
  s->apply(command::SetParameters{{"vegetation.enabled=true"}});
  const std::uint64_t before = s->state().hash();
  EXPECT_GT(s->apply(edit).plants, 0);
  EXPECT_NE(s->state().hash(), before);
  s->apply(command::SetParameters{{"species.2={preset: palm, spawn: 0}"}});
  edit.species = "palm", edit.seed = 3;
  EXPECT_GT(s->apply(edit).plants, 0);
  const std::uint64_t both = s->state().hash();
  for (int n = 0; n < 3; ++n) s->apply(command::Undo{});  // the palms, their species, the bushes
  EXPECT_EQ(s->state().hash(), before);
  EXPECT_EQ(s->scenario().species.size(), 2u);
  for (int n = 0; n < 3; ++n) s->apply(command::Redo{});
  EXPECT_EQ(s->state().hash(), both);
}

TEST_P(LivePlants, AreRefusedWhatWouldLoseThem) {
  const auto s = simulation(ground + living + plants());
  test::run(*s, 10);
  expect_refused(*s, {"vegetation.enabled=false"}, "vegetation.enabled: false would end the plants");
  expect_refused(*s, {"species=[{preset: bush}]", "competition=[[1]]"}, "species.1: 'tree' is missing");
  expect_refused(*s, {"species=[{preset: tree}, {preset: bush}]"},
                 "species.0.name: 'tree' would take the place of 'bush'");
  expect_refused(*s, {"species.0.max_radius=-1"}, "species.0.max_radius: -1 is not in");
  expect_refused(*s, {"species.3={preset: palm}"}, "'3' is not an index into a list of 2");
  expect_refused(*s, {"species.2={preset: tree}"}, "'tree' is already the name");
  expect_refused(*s, {"competition=[[1]]"}, "competition: has 1 entries");
  expect_refused(*s, {"vegetation.max_plants=9"}, "vegetation.max_plants: cannot change");
}

TEST_P(LivePlants, DoNotBeginAmongStillOnes) {
  const auto s = simulation(ground + plants());
  command::EditTerrain still;
  still.layer = "vegetation";
  still.x = 10, still.y = 9, still.radius = 4, still.value = 0.5;
  s->apply(still);
  expect_refused(*s, {"vegetation.enabled=true"}, "vegetation.enabled: still plants are on ");
  still.merge = BrushMerge::replace;
  still.value = 0, still.inner = 1, still.radius = 8;
  s->apply(still);
  EXPECT_NO_THROW(s->apply(command::SetParameters{{"vegetation.enabled=true"}}));
  test::run(*s, 30);
  EXPECT_GT(s->state().plants.count, 0);
}

TEST_P(LivePlants, OfTheSlabModelGrowByOtherCurves) {
  const std::string slabs =
      "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 5}]\n"
      "sand: {model: nield_baas}\nslab_plants: {growth_time: 4}\n";
  const auto changed = simulation(slabs), same = simulation(slabs);
  for (Simulation* s : {changed.get(), same.get()}) {
    command::EditTerrain grass;
    grass.layer = "grass";
    grass.x = 12, grass.y = 10, grass.radius = 6, grass.value = 0.6;
    s->apply(grass);
    test::run(*s, 6);
  }
  changed->apply(command::SetParameters{{"growth_curves.grass=[[-1, -1], [1, -1]]"}});
  test::run(*changed, 8);
  test::run(*same, 8);
  const auto sum = [](const std::vector<float>& values) {
    double total = 0;
    for (float v : values) total += v;
    return total;
  };
  EXPECT_LT(sum(changed->terrain().values(Layer::grass)), sum(same->terrain().values(Layer::grass)))
      << "grass that only dies";
}

DESERT_ON_EACH_BACKEND(LivePlants);

}  // namespace
}  // namespace desert_sim

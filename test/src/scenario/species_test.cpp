// The list of species: presets and what overrides them, the matrix, and what is refused.

#include "src/scenario/live_parameters.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

std::string species_refusal(const std::string& yaml) {
  try {
    test::scenario_of(yaml);
  } catch (const ConfigError& e) {
    return e.what();
  }
  ADD_FAILURE() << "was not refused: " << yaml;
  return "";
}

void expect_refused(const std::string& yaml, std::initializer_list<const char*> texts) {
  const std::string why = species_refusal(yaml);
  for (const char* text : texts)
    EXPECT_NE(why.find(text), std::string::npos) << "no '" << text << "' in: " << why;
}

TEST(SpeciesList, PresetsAreFoundAndOverridden) {
  const Scenario s = test::scenario_of(
      "species: [{preset: tree}, {preset: bush, growth: 0.3, name: shrub}, {preset: bush}, {name: own, stem: "
      "4}]\n");
  ASSERT_EQ(s.species.size(), 4u);
  EXPECT_EQ(s.species[0].name, "tree");
  EXPECT_EQ(s.species[1].name, "shrub");
  EXPECT_EQ(s.species[1].traits.growth, 0.3f);
  EXPECT_EQ(s.species[1].traits.max_radius, 2);
  EXPECT_EQ(s.species[2].traits.growth, 0.2f);
  EXPECT_EQ(s.species[3].traits.stem, 4);
  EXPECT_EQ(s.species[3].traits.max_radius, 20) << "else as a tree";
  EXPECT_EQ(s.competition, std::vector<float>(16, 1.0f));
}

TEST(SpeciesList, ThePresetsAreThoseOfTheModel) {
  EXPECT_EQ(species_presets(), (std::vector<std::string>{"bush", "palm", "seaweed", "tree"}));
  for (const std::string& name : species_presets()) {
    SCOPED_TRACE(name);
    EXPECT_NO_THROW(species_preset(name));
    test::scenario_of("vegetation: {enabled: true}\nspecies: [{preset: " + name + "}]\n");
  }
  // The tree is what a species is if nothing is said: every default stands in one place more, and is the
  // same.
  const SpeciesTraits tree = species_preset("tree").traits, defaults;
  for_each_parameter(defaults, [&](const auto& row, const auto& value) {
    EXPECT_EQ(tree.*(row.member), value) << row.name;
  });
  const SpeciesTraits seaweed = species_preset("seaweed").traits, palm = species_preset("palm").traits;
  EXPECT_EQ(seaweed.water_resistance, 1);
  EXPECT_GT(palm.sand, tree.sand);
  EXPECT_LT(palm.water_use, tree.water_use);
  EXPECT_GT(palm.stem, tree.stem);
}

TEST(SpeciesList, HaveAHue) {
  EXPECT_EQ(test::scenario_of("species: [{preset: palm, hue: 300}]\n").species[0].appearance.hue, 300);
  EXPECT_NE(species_preset("palm").appearance.hue, species_preset("tree").appearance.hue);
  expect_refused("species: [{preset: tree, hue: 400}]", {"species.0.hue", "400", "360"});
}

TEST(SpeciesList, TheMatrixIsReadRowByRow) {
  const Scenario s =
      test::scenario_of("species: [{preset: tree}, {preset: bush}]\ncompetition: [[1, 0.5], [2, 0]]\n");
  EXPECT_EQ(s.competition, (std::vector<float>{1, 0.5f, 2, 0}));
}

TEST(SpeciesList, RefusesWhatItCannotUse) {
  expect_refused("species: [{preset: oak}]", {"species.0.preset", "oak", "bush, palm, seaweed, tree"});
  expect_refused("species: [{preset: tree, leaves: 3}]", {"species.0.leaves", "unknown key"});
  expect_refused("species: [{preset: tree, growth: .nan}]", {"species.0.growth", "nan"});
  expect_refused("species: [{preset: tree, max_radius: 21}]", {"species.0.max_radius", "21", "20"});
  expect_refused("species: [{growth: 1}]", {"species.0", "name"});
  expect_refused("species: [{preset: tree}, {preset: tree}]",
                 {"species.1.name", "already the name of another species"});
  expect_refused("species: {preset: tree}", {"species", "a list is expected"});
  expect_refused("species: [tree]", {"species.0"});
  expect_refused("species: [{preset: tree, light_lowest: 2}]", {"species.0.light_highest"});
  expect_refused("species: [{preset: tree, moisture_lowest: 0.9}]", {"species.0.moisture_highest"});
  expect_refused("species: [{preset: tree}]\ncompetition: [[1, 2]]", {"competition.0", "2 entries"});
  expect_refused("species: [{preset: tree}]\ncompetition: [[-1]]", {"competition.0.0", "-1"});
  expect_refused("competition: [[1]]", {"competition"});
  expect_refused("vegetation: {enabled: true}", {"vegetation.enabled", "species"});
  std::string many = "species: [";
  for (int n = 0; n < 17; ++n) many += "{name: s" + std::to_string(n) + "},";
  expect_refused(many + "]", {"17", "16"});
}

TEST(SpeciesList, AreNoWiderThanTheLargestPlant) {
  expect_refused("species: [{preset: bush}, {preset: tree, max_radius: 30}]\n",
                 {"species.1.max_radius: 30 m is more than vegetation.largest_plant, 20 m"});
  const Scenario s =
      test::scenario_of("species: [{preset: tree, max_radius: 30}]\nvegetation: {largest_plant: 30}\n");
  EXPECT_EQ(s.species[0].traits.max_radius, 30);
  EXPECT_NE(fixed_reason("vegetation.largest_plant"), nullptr);
}

TEST(SpeciesList, VegetationIsEitherPaintedOrGrown) {
  const std::string painted = "terrain: [uniform: {layer: vegetation, value: 0.5}]\n";
  EXPECT_NO_THROW(test::scenario_of(painted));
  expect_refused(painted + "vegetation: {enabled: true}\nspecies: [{preset: bush}]\n",
                 {"terrain.0.uniform.layer", "vegetation"});
}

TEST(SpeciesList, KeepsItsPlantsWhileItRuns) {
  const Scenario s = test::scenario_of("vegetation: {enabled: true}\nspecies: [{preset: bush}]\n");
  for (const char* setting : {"vegetation.enabled=false", "vegetation.max_plants=9", "species.0.groth=1",
                              "species=[]", "species.0.name=shrub", "species.0={preset: tree}"})
    EXPECT_THROW(with_live_settings(s, {setting}), ConfigError) << setting;
  EXPECT_EQ(with_live_settings(s, {"vegetation.draw=0.5"}).get<VegetationParameters>().draw, 0.5f);
  EXPECT_EQ(with_live_settings(s, {"vegetation.draw=0.5"}).species.size(), 1u);
  const Scenario more = with_live_settings(s, {"species.0.stem=0.5", "species.1={preset: tree}"});
  ASSERT_EQ(more.species.size(), 2u);
  EXPECT_EQ(more.species[0].traits.stem, 0.5f);
  EXPECT_EQ(more.competition, CompetitionMatrix({1, 1, 1, 1}));
  const Scenario changed = with_live_settings(more, {"competition.0.1=3", "species.2={preset: palm}"});
  EXPECT_EQ(changed.competition, CompetitionMatrix({1, 3, 1, 1, 1, 1, 1, 1, 1}));
}

}  // namespace
}  // namespace desert_sim

// Climates: one word for rain, evaporation and species, which a scenario can override.

#include "src/scenario/climate.hpp"

#include "kernels/soil/moisture.hpp"
#include "kernels/soil/soil.hpp"
#include "kernels/water/rain.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

TEST(Climate, EachBringsRainAndPlantsOfItsOwn) {
  EXPECT_EQ(climates(), (std::vector<std::string>{"arid", "forest", "savanna", "wetland"}));
  for (const std::string& name : climates()) {
    SCOPED_TRACE(name);
    const Scenario s = test::scenario_of("climate: " + name + "\n");
    EXPECT_GT(s.get<RainParameters>().rate, 0);
    EXPECT_TRUE(s.get<VegetationParameters>().enabled && s.get<MoistureParameters>().enabled &&
                s.get<SoilParameters>().enabled);
    EXPECT_FALSE(s.species.empty());
    EXPECT_GT(climate_doc(name).size(), 20u);
  }
  const auto rain = [](const char* name) {
    const Scenario s = test::scenario_of(std::string("climate: ") + name + "\n");
    return s.get<RainParameters>().rate * s.get<RainParameters>().share_low;
  };
  EXPECT_LT(rain("arid"), rain("savanna"));
  EXPECT_LT(rain("savanna"), rain("forest"));
  EXPECT_LT(rain("forest"), rain("wetland"));
}

TEST(Climate, WhatTheScenarioSaysOverridesIt) {
  const Scenario s = test::scenario_of(
      "climate: forest\nrain: {rate: 0.001}\nsoil: {enabled: false}\nspecies: [{preset: palm}]\n");
  EXPECT_EQ(s.get<RainParameters>().rate, 0.001f);
  EXPECT_FALSE(s.get<SoilParameters>().enabled);
  EXPECT_EQ(s.get<SoilParameters>().forming, 0.03f) << "is still the climate's";
  ASSERT_EQ(s.species.size(), 1u);
  EXPECT_EQ(s.species[0].name, "palm");
  EXPECT_EQ(s.competition, std::vector<float>(1, 1.0f)) << "a matrix belongs to its list";
}

TEST(Climate, ADumpedScenarioIsTheSameWithoutItsName) {
  const Scenario s = test::scenario_of("climate: wetland\n");
  const std::string dumped = dump_scenario(s);
  EXPECT_EQ(dumped.find("climate"), std::string::npos);
  EXPECT_EQ(dump_scenario(test::scenario_of(dumped)), dumped);
}

TEST(Climate, AnUnknownOneIsRefusedWithTheKnown) {
  for (const char* yaml : {"climate: tropical\n", "climate: [forest]\n"}) {
    try {
      test::scenario_of(yaml);
      ADD_FAILURE() << "was not refused: " << yaml;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("is not one of: arid, forest, savanna, wetland"),
                std::string::npos)
          << e.what();
    }
  }
}

}  // namespace
}  // namespace desert_sim

// Growth curves of plants in the slab model nield_baas: their points, and what is refused.

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

enum Kind { grass, mesquite, shrub };

TEST(GrowthCurves, ThoseOfTheFileAreLinearBetweenTheirPoints) {
  const GrowthCurves curves = test::scenario_of("{}").growth_curves;
  struct Expected {
    Kind kind;
    float burial, growth;
  };
  for (const Expected& e : {Expected{grass, -2, -1},  // worked out by hand
                            {grass, -0.65f, -0.5f},
                            {grass, 0, -1 / 15.0f},
                            {grass, 0.1f, 0},
                            {grass, 0.275f, 0.15f},
                            {grass, 0.45f, 0.3f},
                            {grass, 0.65f, 0.15f},
                            {grass, 1.125f, -0.5f},
                            {grass, 9, -1},
                            {mesquite, 0.3f, 0.15f},
                            {mesquite, 1.55f, 0.15f},
                            {mesquite, 3.25f, -0.5f},
                            {shrub, -1.4f, -1},
                            {shrub, 0, 0.075f},
                            {shrub, 0.1f, 0.0375f},
                            {shrub, 1.2f, -0.5f}})
    EXPECT_NEAR(curves.of[e.kind].at(e.burial), e.growth, 1e-6)
        << growth_curve_names[e.kind] << " buried by " << e.burial << " m";
}

TEST(GrowthCurves, AScenarioReplacesSingleCurves) {
  const Scenario own = test::scenario_of("growth_curves: {grass: [[-1, 0.25], [3, 2.25]]}\n");
  const Scenario again = test::scenario_of(dump_scenario(own));
  for (const Scenario* s : {&own, &again}) {
    EXPECT_EQ(s->growth_curves.of[grass].count, 2);
    EXPECT_EQ(s->growth_curves.of[grass].at(1), 1.25f);
    EXPECT_EQ(s->growth_curves.of[shrub].count, 5);
  }
}

TEST(GrowthCurves, FaultyOnesAreRefused) {
  const auto expect_refused = [](const std::string& curves, std::initializer_list<const char*> texts) {
    try {
      test::scenario_of("growth_curves: " + curves + "\n");
      ADD_FAILURE() << curves << " was not refused";
    } catch (const ConfigError& e) {
      for (const char* text : texts)
        EXPECT_NE(std::string(e.what()).find(text), std::string::npos)
            << "no '" << text << "' in: " << e.what();
    }
  };
  expect_refused("3", {"growth_curves", "3"});
  expect_refused("{moss: [[0, 0], [1, 1]]}", {"growth_curves.moss", "grass, mesquite, shrub"});
  expect_refused("{grass: 4}", {"growth_curves.grass", "4", "2 to 8 points"});
  expect_refused("{grass: [[0, 0]]}", {"growth_curves.grass", "has 1 points", "2 to 8"});
  expect_refused("{grass: [[0,0],[1,0],[2,0],[3,0],[4,0],[5,0],[6,0],[7,0],[8,0]]}", {"has 9 points"});
  expect_refused("{shrub: [[0, 0], [1]]}", {"growth_curves.shrub.1", "[burial, growth]"});
  expect_refused("{shrub: [[0, 0], [0, 1]]}", {"growth_curves.shrub.1.0", ": 0", "ascending"});
  expect_refused("{shrub: [[0, 0], [.nan, 1]]}", {"growth_curves.shrub.1.0", "[-100, 100] m/year"});
  expect_refused("{shrub: [[0, 11], [1, much]]}", {"growth_curves.shrub.0.1", ": 11", "[-10, 10] 1/year"});
}

}  // namespace
}  // namespace desert_sim

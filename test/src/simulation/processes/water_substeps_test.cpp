// Steps of pipes that need more than water.most_substeps are warned of.

#include "kernels/water/water_parameters.hpp"
#include "src/simulation/session.hpp"
#include "test/support/log_lines.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// Still water 20 m deep on cells of a metre: a step of a second needs ⌈√(2 g 20)/0.65⌉ = 31 sub-steps.
Scenario deep_water(int most_substeps) {
  return test::parsed(
      "grid: {width: 16, height: 16, cell_size: 1}\nterrain: [uniform: {layer: water, value: 20}]\n"
      "saltation: {enabled: false}\navalanching: {enabled: false}\n"
      "water: {enabled: true, evaporation: 0, most_substeps: " +
      std::to_string(most_substeps) + "}\n");
}

TEST(WaterSubsteps, AreEnoughWithoutAWord) {
  const test::LogLines log;
  Session session(deep_water(31), no_raster_loader, "cpu", 1);
  for (int n = 0; n < 3; ++n) session.step();
  EXPECT_TRUE(log.lines.empty()) << log.lines.front();
  EXPECT_TRUE(session.simulation().pipeline().warnings().empty());
}

/// Once for each simulation, while the pipeline says it as long as it is so.
TEST(WaterSubsteps, ThatAreTooFewAreWarnedOfOnce) {
  const test::LogLines log;
  Session session(deep_water(30), no_raster_loader, "cpu", 1);
  for (int n = 0; n < 3; ++n) session.step();
  ASSERT_EQ(log.lines.size(), 1u);
  for (const char* part :
       {"step 1: virtual_pipes: water 20 m deep", "needs 31 sub-steps in a step of 1 s",
        "water.most_substeps allows 30", "raise water.most_substeps or lower run.time_step"})
    EXPECT_NE(log.lines[0].find(part), std::string::npos) << part << " is not in: " << log.lines[0];
  EXPECT_EQ(session.simulation().pipeline().warnings().count("virtual_pipes"), 1u);

  session.apply(command::SetParameters{{"water.most_substeps=31"}, 0});
  session.step();
  EXPECT_TRUE(session.simulation().pipeline().warnings().empty());

  session.apply(command::Reset{});
  session.step();
  EXPECT_EQ(log.lines.size(), 2u) << "a simulation that begins anew is warned of anew";
}

/// shallow_water has as many as it needs.
TEST(WaterSubsteps, OfShallowWaterAreNotLimited) {
  const test::LogLines log;
  Scenario scenario = deep_water(1);
  scenario.get<WaterParameters>().model = WaterModel::shallow_water;
  Session session(scenario, no_raster_loader, "cpu", 1);
  session.step();
  EXPECT_TRUE(log.lines.empty()) << log.lines.front();
}

}  // namespace
}  // namespace desert_sim

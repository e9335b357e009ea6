// A simulation as its owner sees it: clock, snapshots, commands that are refused, the sentinel.

#include <limits>

#include "src/simulation/processes/sand_slopes.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const world =
    "grid: {width: 24, height: 16, cell_size: 2, origin_x: 5, origin_y: 6}\n"
    "terrain: [uniform: {layer: bedrock, value: 200}, uniform: {layer: sand, value: 3}]\nrun: {time_step: "
    "0.5}\n";

class ASimulation : public test::OnBackend {};

TEST_P(ASimulation, CountsStepsAndTime) {
  auto s = simulation(world);
  test::run(*s, 5);
  EXPECT_EQ(s->steps(), 5u);
  EXPECT_EQ(s->time(), 2.5);
}

TEST_P(ASimulation, SnapshotsHoldWhatWasAskedForAndOutliveTheNextSteps) {
  auto s = simulation(world);
  test::run(*s, 2);
  const auto snapshot = s->views().snapshot({Layer::elevation, Layer::wind_x, Layer::soil});
  EXPECT_EQ(snapshot->width, 24);
  EXPECT_EQ(snapshot->height, 16);
  EXPECT_EQ(snapshot->cell_size, 2);
  EXPECT_EQ(snapshot->origin_x, 5);
  EXPECT_EQ(snapshot->origin_y, 6);
  EXPECT_EQ(snapshot->step, 2u);
  EXPECT_EQ(snapshot->time, 1);
  EXPECT_EQ(snapshot->wind_above.x, 5);
  EXPECT_EQ(snapshot->find(Layer::sand), nullptr);
  ASSERT_NE(snapshot->find(Layer::soil), nullptr) << "not in use, but asked for";
  EXPECT_EQ((*snapshot->find(Layer::soil))[0], 0);
  const float before = (*snapshot->find(Layer::elevation))[0];
  test::run(*s, 3);
  s.reset();
  EXPECT_EQ((*snapshot->find(Layer::elevation))[0], before);
}

TEST_P(ASimulation, GivesTheMemoryOfRequestedLayersBack) {
  auto s = simulation(world);
  test::run(*s, 1);
  const std::size_t before = s->terrain().bytes();
  const std::vector<float> slope = *s->views().snapshot({Layer::slope, Layer::roughness})->find(Layer::slope);
  EXPECT_EQ(s->terrain().bytes(), before + 2 * 4 * 24 * 16);
  s->views().release_requested_layers();
  EXPECT_EQ(s->terrain().bytes(), before);
  EXPECT_EQ(*s->views().snapshot({Layer::slope})->find(Layer::slope), slope) << "made anew";
}

TEST_P(ASimulation, ShowsElevationAfterAnEditAndWindBeforeTheFirstStep) {
  auto s = simulation(world);
  const auto start = s->views().snapshot({Layer::elevation, Layer::wind_x, Layer::wind_y});
  for (float v : *start->find(Layer::elevation)) EXPECT_EQ(v, 203);
  for (float v : *start->find(Layer::wind_x)) EXPECT_EQ(v, 5);
  for (float v : *start->find(Layer::wind_y)) EXPECT_EQ(v, 0);
  command::EditTerrain edit;
  edit.x = 5 + 2 * 3.5;
  edit.y = 6 + 2 * 4.5;
  edit.radius = 3;
  edit.value = 10;
  s->apply(edit);
  EXPECT_NEAR((*s->views().snapshot({Layer::elevation})->find(Layer::elevation))[4 * 24 + 3], 213, 1e-4);
}

TEST_P(ASimulation, ListsTheLayersInUse) {
  auto s = simulation(world);
  for (Layer layer : s->state().layers_in_use()) EXPECT_TRUE(s->terrain().has(layer));
  EXPECT_FALSE(s->terrain().has(Layer::soil));
  EXPECT_FALSE(s->terrain().has(Layer::echo));
  EXPECT_TRUE(s->terrain().has(Layer::wind_shadow));
}

TEST_P(ASimulation, TakesWindFromCommands) {
  auto s = simulation(world);
  s->apply(command::SetWind{90, 8, 0});
  EXPECT_EQ(s->state().wind_above().x, 0);
  EXPECT_EQ(s->state().wind_above().y, 8);
  s->apply(command::SetWind{0, 4, 2});  // from (0, 8) in two seconds: four steps
  test::run(*s, 2);
  EXPECT_NEAR(s->state().wind_above().x, 2, 1e-6);
  EXPECT_NEAR(s->state().wind_above().y, 4, 1e-6);
  command::SetWindSchedule schedule;
  schedule.regime.regime = WindRegimeKind::timeline;
  schedule.regime.segments = {{180, 6, 1, 0, 1}, {270, 7, 1, 0, 1}};
  s->apply(schedule);
  EXPECT_EQ(s->state().wind_above().x, -6);
  test::run(*s, 2);
  EXPECT_EQ(s->state().wind_above().y, -7);
}

TEST_P(ASimulation, RefusesWrongWindsAndChangesNothing) {
  auto s = simulation(world);
  test::run(*s, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  const std::uint64_t before = s->state().hash();
  const auto refused = [&](const auto& command, const std::string& naming) {
    try {
      s->apply(command);
      ADD_FAILURE() << "was not refused: " << naming;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(naming), std::string::npos) << e.what();
    }
    EXPECT_EQ(s->state().wind_above().x, 5);
    EXPECT_EQ(s->state().hash(), before);
  };
  refused(command::SetWind{nan, 5, 0}, "direction_deg");
  refused(command::SetWind{400, 5, 0}, "direction_deg");
  refused(command::SetWind{0, -1, 0}, "speed");
  refused(command::SetWind{0, infinity, 0}, "speed");
  refused(command::SetWind{0, 5, -1}, "ramp");
  command::SetWindSchedule schedule;
  refused(schedule, "kind");
  schedule.regime.regime = WindRegimeKind::rose;
  refused(schedule, "segments");
  schedule.regime.segments = {{0, 5, 10, 0, 0}};
  refused(schedule, "probabilit");
  schedule.regime.segments = {{0, 5, 10, 0, 1}, {0, 500, 10, 0, 1}};
  refused(schedule, "segments.1: speed: 500");
  schedule.regime.segments = {{0, 5, 10, 20, 1}};
  refused(schedule, "ramp");
  schedule.regime.segments = {{0, 5, 10, 0, 1}};
  schedule.regime.hold_time = 0;
  refused(schedule, "hold_time");
  schedule.regime.hold_time = nan;
  refused(schedule, "hold_time");
}

TEST_P(ASimulation, NamesTheProcessLayerAndCellOfABrokenState) {
  auto s = simulation(
      std::string(world) +
      "avalanching: {enabled: false}\nsaltation: {enabled: false}\nreptation: {method: smoothing}\n"
      "wind: {speed: 0, warping: false, projection: false}\n");
  Terrain& terrain = const_cast<Terrain&>(s->terrain());
  std::vector<std::uint32_t> sand = terrain.raw_words(Layer::sand);
  sand[5 * 24 + 7] = static_cast<std::uint32_t>(-3);
  terrain.set_raw_words(Layer::sand, sand);
  try {
    test::run(*s, 100);
    FAIL() << "a negative depth went unnoticed";
  } catch (const StateError& e) {
    for (const char* text : {"reptation", "sand", "(7, 5)"})
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

TEST_P(ASimulation, TakesWindToTheWestForWhole) {
  auto s = simulation(
      "grid: {width: 8, height: 8}\nterrain: [uniform: {layer: sand, value: 1}]\n"
      "wind: {speed: 5, direction_deg: 180}\nrun: {check_every: 1}\n");
  EXPECT_NO_THROW(test::run(*s, 3)) << "negative, and not broken";
}

TEST_P(ASimulation, TimesProcessesInTheirOrder) {
  auto s = simulation(world);
  test::run(*s, 1);
  EXPECT_TRUE(s->pipeline().times().empty());
  s->pipeline().set_timing(true);
  test::run(*s, 3);
  std::string names;
  for (const ProcessTime& t : s->pipeline().times()) {
    names += std::string(t.process) + " ";
    EXPECT_GE(t.milliseconds, 0);
  }
  EXPECT_EQ(names, "wind wind_shadow saltation avalanching ");
}

TEST_P(ASimulation, ReportsNoResidualOnGentleGround) {
  auto s = simulation(world);
  EXPECT_EQ(sand_residual(s->state(), s->pipeline()).largest_excess, 0);
  test::run(*s, 2);
  EXPECT_LT(max_sand_slope_deg(s->state()), 34);
}

DESERT_ON_EACH_BACKEND(ASimulation);

TEST(MakeExec, SaysWhatItTookAndWhy) {
  std::string why;
  EXPECT_STREQ(make_exec("cpu", 1, &why)->backend(), "cpu");
  EXPECT_NE(why.find("asked"), std::string::npos);
  auto automatic = make_exec("auto", 1, &why);
  EXPECT_NE(why.find("because"), std::string::npos);
  EXPECT_STREQ(automatic->backend(), cuda_status().usable ? "cuda" : "cpu");
  EXPECT_FALSE(automatic->device_name().empty());
  EXPECT_THROW(make_exec("gpu"), ConfigError);
}

TEST(MakeExec, CudaWithoutADeviceIsAnErrorWithTheReason) {
  const CudaStatus status = cuda_status();
  if (status.usable) return;  // desert_run is tested with its device hidden
  try {
    make_exec("cuda");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find(status.reason), std::string::npos);
  }
}

TEST(CpuExec, HasTheThreadsThatAreAskedFor) {
  EXPECT_EQ(CpuExec(3).threads(), 3);
  EXPECT_GE(CpuExec(0).threads(), 1);
}

}  // namespace
}  // namespace desert_sim

// run.timeline and ramps: parameters change when they should, to the bit through checkpoints, and say so.

#include <cmath>

#include "kernels/avalanching/avalanching_parameters.hpp"
#include "kernels/sand/reptation.hpp"
#include "kernels/sand/saltation.hpp"
#include "kernels/water/rain.hpp"
#include "kernels/wind/wind_shadow_parameters.hpp"
#include "src/core/log.hpp"
#include "src/simulation/checkpoint.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string timeline_world =
    "grid: {width: 24, height: 20}\nterrain: [uniform: {layer: sand, value: 2}]\n"
    "wind: {speed: 4, warping: false, projection: false}\n";

class Timeline : public test::OnBackend {};

TEST_P(Timeline, ChangesAtItsTimesAtOnceOrOverARamp) {
  auto s = simulation(
      timeline_world +
      "rain: {rate: 1.0e-5}\n"
      "run: {time_step: 2, timeline: [{time: 10, set: {wind.speed: 6, avalanching.quality: fast}}, "
      "{time: 20, ramp: 40, set: {rain.rate: 5.0e-5}}]}\n");
  const auto rate_after = [&](int steps) {
    while (s->steps() < static_cast<std::uint64_t>(steps)) s->step();
    return static_cast<double>(s->scenario().get<RainParameters>().rate);
  };
  EXPECT_NE(s->commands().describe_changes().find("at 10 s: wind.speed=6"), std::string::npos)
      << s->commands().describe_changes();
  rate_after(5);  // times 0 … 8 s
  EXPECT_EQ(s->state().present_scenario().wind_regime.speed, 4);
  EXPECT_EQ(s->scenario().get<AvalanchingParameters>().quality, AvalancheQuality::good);
  EXPECT_NEAR(rate_after(6), 1e-5, 1e-9);
  EXPECT_EQ(s->state().present_scenario().wind_regime.speed, 6);
  EXPECT_NEAR(s->state().wind_above().x, 6, 1e-6);
  EXPECT_EQ(s->scenario().get<AvalanchingParameters>().quality, AvalancheQuality::fast);
  EXPECT_NEAR(rate_after(21), 3e-5, 1e-6);  // the step at 40 s
  EXPECT_NE(s->commands().describe_changes().find("rain.rate -> 5e-05"), std::string::npos)
      << s->commands().describe_changes();
  EXPECT_NEAR(rate_after(31), 5e-5, 1e-9);
  EXPECT_EQ(s->commands().describe_changes(), "");
  const MaterialBalance water = s->state().balance()[static_cast<std::size_t>(Material::water)];
  EXPECT_GT(water.in, 0);
  EXPECT_EQ(water.residual(), 0);
}

TEST_P(Timeline, ACheckpointInTheMiddleOfARampContinuesToTheBit) {
  const std::string text =
      "grid: {width: 24, height: 20}\nwind: {speed: 4, warping: false, projection: false}\n"
      "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 8}, uniform: {layer: sand, value: 1}]\n"
      "run: {timeline: [{time: 5, ramp: 30, set: {rain.rate: 1.0e-3, saltation.lift: 0.2}}, "
      "{time: 25, set: {moisture.enabled: true}}]}\n";
  auto whole = simulation(text);
  test::run(*whole, 40);
  auto first = simulation(text);
  test::run(*first, 20);
  const test::TemporaryFolder folder;
  save_checkpoint(folder.path("half"), *first);
  auto second = load_checkpoint(folder.path("half"), exec());
  EXPECT_EQ(second->commands().describe_changes(), first->commands().describe_changes());
  test::run(*second, 20);
  EXPECT_EQ(second->state().hash(), whole->state().hash());
  EXPECT_NEAR(second->scenario().get<SaltationParameters>().lift, 0.2, 1e-7);
}

TEST_P(Timeline, SetParametersRampsTooAndStopsWhatRampedBefore) {
  auto s = simulation(timeline_world);
  s->apply(command::SetParameters{{"saltation.lift=0", "reptation.method=off"}, 20});
  EXPECT_EQ(s->scenario().get<ReptationParameters>().method, ReptationMethod::off);
  test::run(*s, 11);
  EXPECT_NEAR(s->scenario().get<SaltationParameters>().lift, 0.5, 0.02);
  s->apply(command::SetParameters{{"saltation.lift=0.9"}});
  test::run(*s, 15);
  EXPECT_FLOAT_EQ(s->scenario().get<SaltationParameters>().lift, 0.9f);
  EXPECT_THROW(s->apply(command::SetParameters{{"saltation.lift=0.5"}, -1}), ConfigError);
  EXPECT_THROW(s->apply(command::SetParameters{{"saltation.lift=-0.5"}, 10}), ConfigError);
  EXPECT_EQ(s->commands().describe_changes(), "");
}

/// Each ramp ends at values that go together, but on the way full_deg falls below start_deg for a while.
TEST_P(Timeline, RampsThatMeetAConditionBetweenParametersGoOn) {
  std::vector<std::string> messages;
  const LogSink before =
      set_log_sink([&](Severity, const std::string& message) { messages.push_back(message); });
  auto s = simulation(timeline_world +
                      "wind_shadow: {start_deg: 10, full_deg: 15}\n"
                      "run: {timeline: [{time: 1, ramp: 80, set: {wind_shadow.full_deg: 25}},\n"
                      "                 {time: 1, ramp: 20, set: {wind_shadow.start_deg: 20}}]}\n");
  test::run(*s, 100);
  set_log_sink(before);
  EXPECT_FLOAT_EQ(s->scenario().get<WindShadowParameters>().start_deg, 20);
  EXPECT_FLOAT_EQ(s->scenario().get<WindShadowParameters>().full_deg, 25);
  EXPECT_EQ(s->commands().describe_changes(), "");
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_NE(messages.front().find("must not be below start_deg"), std::string::npos) << messages.front();
}

TEST_P(Timeline, AnotherOneTakesItsPlaceInARunningSimulation) {
  const std::string timeline =
      "[{time: 10, set: {wind.speed: 6}}, {time: 14, every: 2, command: edit_terrain, "
      "layer: sand, x: 5, y: 5, radius: 3, value: 1}]";
  auto told = simulation(timeline_world + "run: {timeline: " + timeline + "}\n");
  auto live = simulation(timeline_world);
  test::run(*told, 8);
  test::run(*live, 8);
  live->apply(command::SetParameters{{"run.timeline=" + timeline}});
  test::run(*told, 12);
  test::run(*live, 12);
  EXPECT_EQ(live->state().hash(), told->state().hash());

  const auto refusal = [&](const std::string& setting) -> std::string {
    try {
      live->apply(command::SetParameters{{setting}});
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  const std::string before = live->commands().describe_changes();
  EXPECT_NE(
      refusal("run.timeline=[{time: 19, set: {wind.speed: 2}}]").find("run.timeline.0.time: 19 s is past"),
      std::string::npos);
  EXPECT_NE(refusal("run.timeline=[{time: 30, command: edit_terrain, layer: sand, x: 5, y: 5, radius: -1}]")
                .find("radius"),
            std::string::npos);
  EXPECT_NE(refusal("run.timeline=[{time: 30, set: {run.timeline: []}}]"), "");
  EXPECT_EQ(live->commands().describe_changes(), before) << "what is refused changes nothing";
  EXPECT_EQ(refusal("run.timeline=[{time: 10, set: {wind.speed: 6}}, {time: 20, set: {wind.speed: 3}}]"), "")
      << "an entry that it has may have happened";
  live->step();
  EXPECT_EQ(live->state().present_scenario().wind_regime.speed, 3);
  EXPECT_EQ(refusal("run.timeline=[]"), "");
  EXPECT_EQ(live->commands().describe_changes(), "");
}

TEST(TimelineFaults, AreAllNamed) {
  const auto faults_of = [](const std::string& timeline) -> std::string {
    try {
      test::parsed(timeline_world + "run: {timeline: " + timeline + "}\n");
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  for (const auto& [timeline, part] : std::vector<std::pair<std::string, std::string>>{
           {"5", "run.timeline: 5 is given where a list is expected"},
           {"[{ramp: 3, set: {rain.rate: 0}}]", "run.timeline.0.time: is missing"},
           {"[{time: -1, set: {rain.rate: 0}}]", "run.timeline.0.time: -1 is not a time"},
           {"[~]", "run.timeline.0: nothing is given where keys and values are expected"},
           {"[{time: 1}]", "run.timeline.0.set: must name parameters"},
           {"[{time: 1, set: {rain.rate: 0}, at: 5}]", "run.timeline.0.at: unknown key"},
           {"[{time: 5, set: {rain.rate: 0}}, {time: 4, set: {rain.rate: 0}}]",
            "run.timeline.1.time: is earlier"},
           {"[{time: 1, set: {rain.rat: 0}}]", "rain.rat: unknown parameter"},
           {"[{time: 1, set: {rain.rate: -1}}]", "rain.rate: -1 is not in [0, 1] m/s"},
           {"[{time: 1, set: {run.timeline: []}}]", "run.timeline.0.set"},
           {"[{time: 1, set: {grid.width: 7}}]", "grid.width: cannot change"},
           {"[{time: 1, set: {wind_shadow.full_deg: 5}}]", "must not be below start_deg"}})
    EXPECT_NE(faults_of(timeline).find(part), std::string::npos) << timeline << ":\n" << faults_of(timeline);
  EXPECT_EQ(
      faults_of("[{time: 1, set: {wind_shadow.start_deg: 2}}, {time: 1, set: {wind_shadow.full_deg: 5}}]"),
      "");
}

DESERT_ON_EACH_BACKEND(Timeline);

}  // namespace
}  // namespace desert_sim

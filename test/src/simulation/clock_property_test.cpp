// The desert's clock: run.time_step and run.acceleration change while a simulation runs, and nothing is lost
// by it.

#include <cmath>
#include <set>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string dunes =
    "grid: {width: 40, height: 30, boundary: open}\n"
    "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 15}, noise: {layer: sand, low: 0, high: 3}]\n"
    "wind: {speed: 6, direction_deg: 20}\nsaltation: {influx: 0.2}\n";

class DesertClock : public test::OnBackend {};

void set(Simulation& s, const std::vector<std::string>& settings) {
  s.apply(command::SetParameters{settings});
}

TEST_P(DesertClock, GoesOnFromWhatItShowsWhenTheStepChanges) {
  const auto s = simulation(dunes + "run: {time_step: 0.5}\n");
  test::run(*s, 4);
  EXPECT_EQ(s->time(), 2);
  set(*s, {"run.time_step=0.125"});
  EXPECT_EQ(s->time(), 2);
  test::run(*s, 3);
  EXPECT_EQ(s->time(), 2.375);
  set(*s, {"run.time_step=2"});  // two parts a step
  test::run(*s, 5);
  set(*s, {"run.time_step=0.25"});
  EXPECT_EQ(s->time(), 12.375);
  EXPECT_EQ(s->state().clock_origin.tick, 4u + 3u + 2 * 5u) << "no dice of a part are rolled twice";
  test::run(*s, 1);
  EXPECT_EQ(s->time(), 12.625);
  EXPECT_EQ(s->steps(), 13u);
  test::expect_sound(*s, "after all changes");
  set(*s, {"wind.speed=5"});
  EXPECT_EQ(s->time(), 12.625) << "another parameter leaves the clock alone";
}

TEST_P(DesertClock, PacedTimeIsTheSumOfWhatEachAccelerationTakes) {
  const auto s = simulation(dunes + "run: {time_step: 0.5}\n");
  test::run(*s, 2);
  EXPECT_EQ(s->state().paced_time(), 1) << "not tied: the desert's own time";
  set(*s, {"run.acceleration=0.25"});
  EXPECT_EQ(s->state().paced_time(), 1);
  test::run(*s, 2);
  EXPECT_EQ(s->state().paced_time(), 1 + 4);
  set(*s, {"run.acceleration=2", "run.time_step=1"});
  test::run(*s, 3);
  EXPECT_EQ(s->state().paced_time(), 5 + 1.5);
  set(*s, {"run.acceleration=0"});
  test::run(*s, 1);
  EXPECT_EQ(s->state().paced_time(), 6.5 + 1);
  EXPECT_EQ(s->time(), 6);
}

TEST_P(DesertClock, AccelerationChangesNoGrain) {
  const auto s = simulation(dunes), plain = simulation(dunes);
  test::run(*s, 2);
  set(*s, {"run.acceleration=0.01"});
  test::run(*s, 3);
  test::run(*plain, 5);
  EXPECT_EQ(s->state().hash(), plain->state().hash());
}

/// The steps, from 1 on, after which the shadow is another than before.
std::set<int> renewals(Simulation& s, int steps) {
  std::set<int> found;
  std::vector<std::uint32_t> last = s.terrain().raw_words(Layer::wind_shadow);
  for (int n = 1; n <= steps; ++n) {
    s.step();
    std::vector<std::uint32_t> now = s.terrain().raw_words(Layer::wind_shadow);
    if (now != last) found.insert(n);
    last = std::move(now);
  }
  return found;
}

TEST_P(DesertClock, TheShadowIsRenewedOnceASecondThroughChanges) {
  const auto s = simulation(dunes + "run: {time_step: 0.25}\n");
  EXPECT_EQ(renewals(*s, 7), (std::set<int>{1, 5})) << "steps that begin at 0 and 1 s";
  set(*s, {"run.time_step=0.125"});  // at 1.75 s
  EXPECT_EQ(renewals(*s, 9), (std::set<int>{3})) << "at 2 s";
  set(*s, {"run.time_step=0.25"});
  EXPECT_EQ(renewals(*s, 1), (std::set<int>{})) << "begins at 2.875 s";
  set(*s, {"run.time_step=0.03125"});  // at 3.125 s: 3 s have passed in the last step
  set(*s, {"run.time_step=0.0625"});   // twice without a step between
  EXPECT_EQ(renewals(*s, 14), (std::set<int>{1}));
  EXPECT_EQ(renewals(*s, 1), (std::set<int>{1})) << "at 4 s";
  set(*s, {"run.time_step=1"});
  EXPECT_EQ(renewals(*s, 2), (std::set<int>{1, 2})) << "longer steps always";
}

TEST_P(DesertClock, WhoLooksBetweenChangesChangesNothing) {
  const auto s = simulation(dunes), watched = simulation(dunes);
  for (const char* step : {"0.25", "0.05", "1", "0.5", "2", "0.125"}) {
    for (Simulation* each : {s.get(), watched.get()}) {
      test::run(*each, 2);
      set(*each, {"wind.speed=" + std::string(step)});
    }
    (void)watched->views().snapshot({Layer::wind_shadow});
    for (Simulation* each : {s.get(), watched.get()}) set(*each, {std::string("run.time_step=") + step});
    (void)watched->views().snapshot({Layer::wind_shadow});
    EXPECT_EQ(s->state().hash(), watched->state().hash()) << step;
  }
}

TEST_P(DesertClock, ACheckpointAfterChangesContinuesToTheBit) {
  const test::TemporaryFolder folder;
  const auto s = simulation(dunes + "run: {time_step: 0.3}\n");
  test::run(*s, 5);
  set(*s, {"run.time_step=0.07", "run.acceleration=0.2"});
  test::run(*s, 6);
  save_checkpoint(folder.path("c"), *s);
  const auto loaded = load_checkpoint(folder.path("c"), exec());
  EXPECT_EQ(loaded->time(), s->time());
  EXPECT_EQ(loaded->state().paced_time(), s->state().paced_time());
  EXPECT_TRUE(loaded->state().clock_origin == s->state().clock_origin);
  test::run(*s, 20);
  test::run(*loaded, 20);
  EXPECT_EQ(loaded->time(), s->time());
  EXPECT_EQ(loaded->state().hash(), s->state().hash());
}

TEST_P(DesertClock, EqualStepsAtAnotherTimeAreAnotherState) {
  const auto s = simulation("grid: {width: 8, height: 8}\nterrain: [uniform: {layer: bedrock, value: 1}]\n"),
             other =
                 simulation("grid: {width: 8, height: 8}\nterrain: [uniform: {layer: bedrock, value: 1}]\n");
  test::run(*s, 2);
  test::run(*other, 1);
  set(*other, {"run.time_step=0.5"});
  test::run(*other, 1);
  EXPECT_NE(s->state().hash(), other->state().hash());
}

/// Commands, timeline and ramps change both parameters.
const std::string changing = dunes +
                             "rain: {rate: 1.0e-4}\n"
                             "run: {time_step: 0.5, timeline: [{time: 3, ramp: 2, set: {run.time_step: 0.1, "
                             "run.acceleration: 0.5}}]}\n";

TEST_P(DesertClock, AJournalOfChangesIsReplayedToTheBit) {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("journal");
  std::uint64_t hash = 0;
  double time = 0, paced = 0;
  {
    Session live(test::scenario_of(changing), no_raster_loader, GetParam(), 1, path);
    const auto steps = [&](int n) {
      for (; n > 0; --n) live.step();
    };
    steps(3);
    live.apply(command::SetParameters{{"run.acceleration=0.05", "run.time_step=0.05"}});
    steps(40);
    EXPECT_NE(live.simulation().commands().describe_changes(), "") << "the ramp is under way";
    live.apply(command::SetParameters{{"run.acceleration=3"}});
    steps(20);
    live.apply(command::SetParameters{{"run.time_step=1.7"}, 4});
    steps(9);
    hash = live.simulation().state().hash();
    time = live.simulation().time();
    paced = live.simulation().state().paced_time();
  }
  const Journal journal = read_journal(path);
  ASSERT_EQ(journal.entries.size(), 3u);
  Session again(test::scenario_of(changing), no_raster_loader, GetParam(), 1);
  std::size_t next = 0;
  while (again.ticks() < journal.ticks) {
    for (; next < journal.entries.size() && journal.entries[next].tick == again.ticks(); ++next)
      again.apply(journal.entries[next].command);
    again.step();
  }
  EXPECT_EQ(again.simulation().state().hash(), hash);
  EXPECT_EQ(again.simulation().time(), time);
  EXPECT_EQ(again.simulation().state().paced_time(), paced);
}

TEST_P(DesertClock, WhatCannotBeIsRefusedAndChangesNothing) {
  const auto s = simulation(dunes);
  test::run(*s, 1);
  const std::string before = dump_scenario(s->state().present_scenario());
  const std::pair<std::vector<std::string>, const char*> refusals[] = {
      {{"run.acceleration=100", "run.time_step=0.001"},
       "run.acceleration: 100 needs 100000 steps of 0.001 s per second (allowed: 0, or 1e-06 to 10, which "
       "is "
       "10000 steps per second)"},
      {{"run.acceleration=1e-9"},
       "run.acceleration: 1e-09 needs 1e-09 steps of 1 s per second (allowed: 0, or 1e-06"},
      {{"run.acceleration=-1"}, "run.acceleration: -1 is not in [0, 1e+06]"},
      {{"run.time_step=0"}, "run.time_step: 0 is not in [0.0001, 100000] s"},
      {{"run.time_step=.nan"}, "run.time_step"},
      {{"saltation.hop_time=0.01", "run.time_step=100"},
       "run.time_step: 100 s is 10000 times saltation.hop_time"},
  };
  for (const auto& refused : refusals) {
    const std::string reason = test::refusal([&] { set(*s, refused.first); });
    EXPECT_NE(reason.find(refused.second), std::string::npos) << refused.first[0] << ": " << reason;
  }
  EXPECT_EQ(dump_scenario(s->state().present_scenario()), before);
  EXPECT_TRUE(s->state().clock_origin == ClockOrigin());
}

DESERT_ON_EACH_BACKEND(DesertClock);

}  // namespace
}  // namespace desert_sim

// A scenario saved as it is, and begun again from its folder: all of its state, with the same bits.

#include <gmock/gmock.h>

#include <filesystem>

#include "kernels/sand/saltation.hpp"
#include "src/core/files.hpp"
#include "src/io/raster_loader.hpp"
#include "src/io/terrain_files.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/refusal.hpp"
#include "test/support/small_scenarios.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using ::testing::HasSubstr;

class SavedScenario : public ::testing::Test {
 protected:
  std::unique_ptr<Session> session(const Scenario& scenario, const std::string& journal = "") {
    return std::make_unique<Session>(scenario, gdal_raster_loader(), "cpu", 1, journal);
  }
  std::unique_ptr<Session> session(const std::string& yaml) { return session(test::parsed(yaml)); }
  std::unique_ptr<Session> saved_session(const Settings& settings = {}) {
    return session(load_scenario(file_, settings));
  }
  void save(const Session& s) {
    const Simulation& simulation = const_cast<Session&>(s).simulation();
    save_scenario(file_, simulation.state().present_scenario(), simulation.steps(),
                  checkpoint_bytes(simulation));
  }
  static void steps(Session& s, int n) {
    for (; n > 0; --n) s.step();
  }
  static std::uint64_t hash(Session& s) { return s.simulation().state().hash(); }
  std::string text() const { return read_file(file_); }

  /// Both go on alike, also through what comes later by timeline, ramp and schedule.
  void expect_same_continuation(Session& live) {
    const auto again = saved_session();
    ASSERT_EQ(hash(*again), hash(live));
    EXPECT_EQ(again->simulation().steps(), live.simulation().steps());
    EXPECT_EQ(again->simulation().time(), live.simulation().time());
    const std::uint64_t saved = hash(live);
    steps(live, 25);
    steps(*again, 25);
    EXPECT_EQ(hash(*again), hash(live));
    EXPECT_EQ(dump_scenario(again->simulation().state().present_scenario()).find("start_from: \"\""),
              std::string::npos);
    again->apply(command::Reset{});
    EXPECT_EQ(hash(*again), saved) << "a reset goes back to what was saved";
    again->step();
  }

  const test::TemporaryFolder folder_;
  const std::string file_ = folder_.path("scenario.yaml");
};

TEST_F(SavedScenario, KeepsWindClockFeaturesAndParameters) {
  const auto live = session(std::string(test::small_desert) +
                            "run: {timeline: [{time: 5, set: {wind.speed: 4}}, {time: 30, set: "
                            "{saltation.lift: 0.4}}]}\n");
  steps(*live, 7);
  command::SetWindSchedule schedule;
  schedule.regime.regime = WindRegimeKind::rose;
  schedule.regime.hold_time = 3;
  schedule.regime.segments = {{0, 8, 1, 0, 1}, {90, 5, 2, 0, 2}};
  live->apply(schedule);
  command::EditWind whirl;
  whirl.feature.id = 9;
  whirl.feature.x = 6;
  live->apply(whirl);
  live->apply(command::SetParameters{{"saltation.bounce_on_sand=0.7", "run.time_step=0.5"}});
  live->apply(command::SetParameters{{"saltation.lift=0.2"}, 40});  // a ramp that has not ended
  steps(*live, 6);
  save(*live);
  expect_same_continuation(*live);
}

TEST_F(SavedScenario, KeepsAWindThatIsStillChanging) {
  const auto live = session(test::small_desert);
  live->apply(command::SetWind{90, 12, 20});
  steps(*live, 5);
  save(*live);
  expect_same_continuation(*live);
}

TEST_F(SavedScenario, KeepsLivePlants) {
  const auto live = session(test::small_oasis);
  steps(*live, 30);
  ASSERT_GT(live->simulation().state().plants.count, 0);
  save(*live);
  expect_same_continuation(*live);
}

TEST_F(SavedScenario, HasTheNameOfItsFolder) {
  const auto live = session(test::small_desert);
  save(*live);
  const std::filesystem::path mine = folder_.path("mine");
  std::filesystem::create_directory(mine);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path(".")))
    if (entry.is_regular_file()) std::filesystem::copy(entry, mine / entry.path().filename());
  EXPECT_EQ(load_scenario((mine / "scenario.yaml").string()).name, "mine");
  std::filesystem::rename(mine / "scenario.yaml", mine / "evening.yaml");
  EXPECT_EQ(load_scenario((mine / "evening.yaml").string()).name, "evening");
}

TEST_F(SavedScenario, GoesOnWithATimelineOfALiveRun) {
  const std::string timeline =
      "run.timeline=[{time: 9, set: {wind.speed: 4}}, {time: 12, ramp: 5, set: {saltation.lift: 0.2}},"
      " {time: 20, command: edit_terrain, layer: sand, x: 6, y: 6, radius: 3, value: 1}]";
  const auto live = session(test::parsed(test::small_desert), folder_.path("journal.yaml"));
  const auto from_the_start = session(test::parsed(test::small_desert));
  from_the_start->apply(command::SetParameters{{timeline}});
  steps(*live, 7);
  steps(*from_the_start, 7);
  live->apply(command::SetParameters{{timeline}});
  steps(*live, 8);
  steps(*from_the_start, 8);
  save(*live);
  expect_same_continuation(*live);
  steps(*from_the_start, 25);
  EXPECT_EQ(hash(*from_the_start), hash(*live)) << "it does not matter when it was told";
}

TEST_F(SavedScenario, TakesWhatIsChangedInItsFile) {
  const auto live = session(test::small_desert);
  steps(*live, 4);
  save(*live);
  const auto again = saved_session({"saltation.lift=0.9", "wind.speed=11", "wind.features=[]", "run.steps=77",
                                    "run.timeline=[{time: 6, set: {wind.speed: 2}}]"});
  const SimulationState& state = again->simulation().state();
  EXPECT_EQ(state.hash(), hash(*live)) << "the state itself is that of the checkpoint";
  EXPECT_EQ(state.scenario.get<SaltationParameters>().lift, 0.9f);
  EXPECT_EQ(state.wind_above().x, 11);
  EXPECT_TRUE(state.scenario.wind_features.empty());
  EXPECT_EQ(state.scenario.run.steps, 77);
  steps(*again, 4);
  EXPECT_EQ(state.wind_above().x, 2) << "its own timeline";
}

/// Plants carry the traits of their species with them: what the file changes reaches them as a command would.
TEST_F(SavedScenario, LivesOnByTheSpeciesOfItsFile) {
  const auto live = session(test::small_oasis);
  steps(*live, 30);
  ASSERT_GT(live->simulation().state().plants.count, 0);
  save(*live);
  const Settings faster{"species.0.growth=0.9"};
  const auto changed = saved_session(faster), unchanged = saved_session();
  live->apply(command::SetParameters{faster});
  for (Session* s : {live.get(), changed.get(), unchanged.get()}) steps(*s, 20);
  EXPECT_EQ(hash(*changed), hash(*live));
  EXPECT_NE(hash(*unchanged), hash(*live));
}

TEST_F(SavedScenario, RefusesWhatCannotChange) {
  const auto live = session(test::small_desert);
  save(*live);
  const std::string message = test::refusal([&] {
    saved_session({"grid.width=20", "seed=5", "vegetation.max_plants=7"});
  });
  EXPECT_THAT(message, HasSubstr("grid.width: 20 is not what the checkpoint has"));
  EXPECT_THAT(message, HasSubstr("seed: 5 is not"));
  EXPECT_THAT(message, HasSubstr("vegetation.max_plants: 7 is not"));
  EXPECT_THAT(test::refusal([&] { saved_session({"terrain=[uniform: {layer: sand, value: 1}]"}); }),
              HasSubstr("terrain: is given, but run.start_from has the start"));
  EXPECT_THAT(test::refusal([&] { saved_session({"run.start_from=missing.ckpt"}); }),
              HasSubstr("missing.ckpt"));
  const auto other = session(test::small_oasis);
  EXPECT_THAT(test::refusal([&] {
                other->apply(command::LoadScenario{file_, true});
              }),
              HasSubstr("run.start_from: has a state"));
}

TEST_F(SavedScenario, ReplacesItsFormerStateAndKeepsOtherFiles) {
  const auto live = session(test::small_desert);
  save(*live);
  write_file(folder_.path("terrain-elevation-1.tif"), "of a terrain in the same folder");
  write_file(folder_.path("state-of-mind.txt"), "a note");
  steps(*live, 3);
  save(*live);
  int states = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path(".")))
    states += entry.path().extension() == ".ckpt";
  EXPECT_EQ(states, 1);
  EXPECT_TRUE(std::filesystem::exists(folder_.path("terrain-elevation-1.tif")));
  EXPECT_TRUE(std::filesystem::exists(folder_.path("state-of-mind.txt")));
  expect_same_continuation(*live);
}

TEST_F(SavedScenario, IsKeptForTheJournalThatBeganWithIt) {
  const auto live = session(test::small_desert);
  steps(*live, 2);
  save(*live);
  const auto again = session(load_scenario(file_), folder_.path("journal.yaml"));
  EXPECT_THAT(test::refusal([&] { again->require_no_start_of_journal(folder_.path(".")); }),
              HasSubstr("needs"));
  EXPECT_NO_THROW(again->require_no_start_of_journal("/tmp"));
  std::string checkpoint;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path(".")))
    if (entry.path().extension() == ".ckpt") checkpoint = entry.path();
  EXPECT_THAT(test::refusal([&] { again->save_checkpoint(checkpoint); }), HasSubstr("the journal"));
}

TEST_F(SavedScenario, OfACheckpointThatWasSavedLater) {
  const auto live = session(test::small_oasis);
  steps(*live, 10);
  save(*live);
  const auto again = saved_session();
  steps(*again, 3);
  again->apply(command::SetParameters{{"wind.speed=3"}});
  again->save_checkpoint(folder_.path("later"));
  const auto later = Session::from_checkpoint(folder_.path("later"), gdal_raster_loader(), "cpu", 1);
  EXPECT_EQ(hash(*later), hash(*again));
  later->apply(command::Reset{});
  EXPECT_EQ(hash(*later), hash(*live));
}

// ---- LoadScenario with settings, or with a text.

class LoadedScenario : public SavedScenario {
 protected:
  /// What the journal of `play` replays to; its own end is in `reached`.
  std::uint64_t replayed(const std::string& journal_path) {
    const Journal journal = read_journal(journal_path);
    const auto s = session(test::small_desert);
    std::size_t next = 0;
    for (std::uint64_t tick = 0;; ++tick) {
      for (; next < journal.entries.size() && journal.entries[next].tick == tick; ++next)
        s->replay(journal.entries[next].command);
      if (tick == journal.ticks) return hash(*s);
      s->step();
    }
  }
};

TEST_F(LoadedScenario, TakesSettingsAndTextsWhichTheJournalHas) {
  write_file(file_, test::small_oasis);
  const std::string journal = folder_.path("journal.yaml");
  std::uint64_t reached = 0;
  {
    const auto s = session(test::parsed(test::small_desert), journal);
    steps(*s, 2);
    command::LoadScenario load{file_};
    load.settings = {"grid.width=20", "seed=9", "terrain.1.noise.high=2"};
    s->apply(load);
    EXPECT_EQ(s->simulation().scenario().grid.width, 20);
    EXPECT_EQ(s->simulation().scenario().seed, 9u);
    EXPECT_EQ(s->simulation().scenario().name, "scenario");
    steps(*s, 2);
    command::LoadScenario text{folder_.path("made up.yaml")};
    text.yaml =
        "# a \"comment\"\ngrid: {width: 12, height: 9}\nterrain:\n  - noise: {layer: sand, high: 3}\n";
    text.settings = {"wind.speed=7"};
    s->apply(text);
    EXPECT_EQ(s->simulation().scenario().name, "made up");
    EXPECT_EQ(s->simulation().scenario().grid.height, 9);
    steps(*s, 3);
    const std::uint64_t before = hash(*s);
    text.settings = {"grid.width=-1"};
    EXPECT_THAT(test::refusal([&] { s->apply(text); }), HasSubstr("grid.width"));
    text.settings = {"width"};
    EXPECT_THAT(test::refusal([&] { s->apply(text); }), HasSubstr("setting 'width': must be path=value"));
    text.yaml = "grid: [";
    EXPECT_THAT(test::refusal([&] { s->apply(text); }), HasSubstr("made up"));
    EXPECT_EQ(hash(*s), before) << "what is refused changes nothing";
    reached = before;
  }
  EXPECT_EQ(replayed(journal), reached);
}

}  // namespace
}  // namespace desert_sim

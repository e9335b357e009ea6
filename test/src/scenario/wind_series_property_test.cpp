// A wind series in a simulation: it is read once, and checkpoints and journals know it.

#include <filesystem>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class SeriesOfWind : public test::OnBackend {
 protected:
  Scenario scenario(const std::string& run = "") {
    folder_.write("wind.csv", "time,speed,direction\n0,4,0\n3,6,90\n7,5,200\n");
    return load_scenario(
        folder_.write("a.yaml",
                      "grid: {width: 24, height: 20}\nterrain: [noise: {layer: sand, low: 0, high: 3}]\n"
                      "wind: {regime: series, series_file: wind.csv, warping: false, projection: false}\n" +
                          run));
  }
  std::unique_ptr<Session> session(const Scenario& s, const std::string& journal = "") {
    return std::make_unique<Session>(s, no_raster_loader, GetParam(), 1, journal);
  }
  static void run(Session& s, int steps) {
    for (; steps > 0; --steps) s.step();
  }
  test::TemporaryFolder folder_;
};

TEST_P(SeriesOfWind, BlowsRowByRow) {
  const auto s = session(scenario());
  EXPECT_EQ(s->simulation().state().wind_above().x, 4);
  run(*s, 3);
  EXPECT_EQ(s->simulation().state().wind_above().y, 6);
  run(*s, 8);  // 11 s: the last row has held for 4 s, and the series starts again
  EXPECT_EQ(s->simulation().state().wind_above().x, 4);
}

TEST_P(SeriesOfWind, ACheckpointContinuesToTheBitWithoutTheFile) {
  const Scenario start = scenario();
  const auto whole = session(start), first = session(start);
  std::filesystem::remove(folder_.path("wind.csv"));
  run(*whole, 12);
  run(*first, 5);
  first->apply(command::SetParameters{{"saltation.lift=1"}});
  save_checkpoint(folder_.path("a.ck"), first->simulation());
  const auto second = Session::from_checkpoint(folder_.path("a.ck"), no_raster_loader, GetParam(), 1);
  run(*second, 7);
  EXPECT_EQ(second->simulation().state().hash(), whole->simulation().state().hash());
  second->apply(command::Reset{});
  run(*second, 12);
  EXPECT_EQ(second->simulation().state().hash(), whole->simulation().state().hash());
}

TEST_P(SeriesOfWind, AJournalIsOfItsSeries) {
  const Scenario start = scenario();
  {
    const auto s = session(start, folder_.path("j.yaml"));
    run(*s, 4);
    s->apply(command::SetWind{30, 5, 0});
    run(*s, 2);
  }
  const Journal journal = read_journal(folder_.path("j.yaml"));
  session(start)->require_journal_of_this_scenario(journal, "j.yaml");
  folder_.write("wind.csv", "time,speed,direction\n0,4,0\n3,6,91\n7,5,200\n");
  const auto other = session(load_scenario(folder_.path("a.yaml")));
  EXPECT_FALSE(test::refusal([&] { other->require_journal_of_this_scenario(journal, "j.yaml"); }).empty());
}

/// A step that spans rows is divided, so that the wind of each moves sand.
TEST_P(SeriesOfWind, LongStepsPassOverNoRow) {
  const auto s = session(scenario("saltation: {enabled: false}\nrun: {time_step: 7}\n"));
  EXPECT_EQ(s->simulation().pipeline().parts(), 3);
  const std::string said = test::refusal([&] {
    folder_.write("wind.csv", "time,speed,direction\n0,4,0\n0.01,6,91\n");
    session(load_scenario(folder_.path("a.yaml")));
  });
  EXPECT_NE(said.find("run.time_step"), std::string::npos) << said;
}

TEST_P(SeriesOfWind, CannotBeReplacedWhileTheSimulationRuns) {
  const auto s = session(scenario());
  for (const char* key : {"series_file", "series_direction", "series_angle", "series_start"})
    EXPECT_FALSE(test::refusal([&] {
                   s->apply(command::SetParameters{{"wind." + std::string(key) + "=to"}});
                 }).empty());
  s->apply(command::SetParameters{{"wind.regime=constant", "wind.speed=9"}});
  run(*s, 1);
  EXPECT_EQ(s->simulation().state().wind_above().x, 9);
  s->apply(command::SetParameters{{"wind.regime=series"}});
  run(*s, 3);
  EXPECT_EQ(s->simulation().state().wind_above().y, 6);
}

/// What a service loads reads no series from outside of the data folder.
TEST_P(SeriesOfWind, AConfinedSessionReadsItsFolderOnly) {
  const auto s = session(scenario());
  std::filesystem::create_directory(folder_.path("data"));
  const std::string inside = folder_.write("data/b.yaml", "wind: {regime: series, series_file: wind.csv}\n"),
                    outside = folder_.write("data/c.yaml", "wind: {regime: series, series_file: " +
                                                               folder_.path("wind.csv") + "}\n");
  folder_.write("data/wind.csv", "time,speed,direction\n0,3,90\n");
  s->confine_commands(folder_.path("data"));
  const std::string said = test::refusal([&] { s->apply(command::LoadScenario{outside, false, 0, false}); });
  EXPECT_NE(said.find("wind.csv"), std::string::npos) << said;
  EXPECT_EQ(s->simulation().state().wind_above().x, 4) << "nothing has changed";
  s->apply(command::LoadScenario{inside, false, 0, false});
  EXPECT_EQ(s->simulation().state().wind_above().y, 3);
}

TEST_P(SeriesOfWind, RefusesAFileThatIsNotThereAndARegimeWithoutOne) {
  const Scenario start = scenario();
  std::filesystem::remove(folder_.path("wind.csv"));
  EXPECT_NE(test::refusal([&] { session(start); }).find("wind.csv"), std::string::npos);
  EXPECT_NE(test::refusal([&] { test::parsed("wind: {regime: series}"); }).find("wind.series_file"),
            std::string::npos);
}

DESERT_ON_EACH_BACKEND(SeriesOfWind);

}  // namespace
}  // namespace desert_sim

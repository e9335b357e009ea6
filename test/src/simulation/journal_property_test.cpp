// The journal: what was written and replayed gives the same hash; what was cut in its last line still reads.

#include <filesystem>

#include "src/simulation/session.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const journalled_world =
    "grid: {width: 40, height: 30}\n"
    "terrain: [noise: {layer: bedrock, low: 0, high: 5, scale: 15}, noise: {layer: sand, low: 0, high: 3}]\n"
    "wind: {speed: 6, direction_deg: 20}\nreptation: {method: steepest}\nrun: {time_step: 0.3}\n";

class JournalOf : public test::OnBackend {
 protected:
  std::unique_ptr<Session> session(const std::string& journal) {
    return std::make_unique<Session>(test::scenario_of(journalled_world), no_raster_loader, GetParam(), 1,
                                     journal);
  }

  static constexpr int commands = 11;
  /// Steps and commands of every kind.
  std::uint64_t live(const std::string& path) {
    auto s = session(path);
    const auto steps = [&](int n) {
      for (; n > 0; --n) s->step();
    };
    steps(3);
    s->apply(command::SetWind{33.3f, 7.7f, 1.1f});
    steps(2);
    command::EditTerrain edit;
    edit.shape = BrushShape::ellipse;
    edit.x = 1.0 / 3;
    edit.y = 29.9;
    edit.radius = 7.123456789012345;
    edit.radius_y = 2.1;
    edit.angle_deg = 12.3;
    edit.inner = 0.1;
    edit.value = 4.000000001;
    s->apply(edit);
    edit.layer = "bedrock";
    edit.merge = BrushMerge::replace;
    edit.value = 30;
    edit.stroke = "a 'stroke': {1}";
    s->apply(edit);
    s->apply(command::Undo{edit.stroke});
    s->apply(command::Redo{});
    steps(1);
    command::EditWind whirl;
    whirl.feature.id = 3;
    whirl.feature.x = 10.1f;
    whirl.feature.y = 1.0f / 3;
    whirl.feature.radius = 7.7f;
    whirl.feature.kind = WindFeatureKind::turbulence;
    s->apply(whirl);
    steps(1);
    s->apply(
        command::SetParameters{{"saltation.lift=0.3", "wind.radii=[50.5, 120]", "echo_dunes.enabled=true"}});
    steps(2);
    s->save_checkpoint(folder_.path("here.ck"));
    s->apply(command::Reset{});
    steps(2);
    command::SetWindSchedule schedule;
    schedule.regime.regime = WindRegimeKind::timeline;
    for (int n = 0; n < 12; ++n) schedule.regime.segments.push_back({30.1f * n, 5.5f + n, 0.7f, 0.3f, 1.0f});
    s->apply(schedule);
    steps(5);
    s->apply(command::LoadCheckpoint{folder_.path("here.ck"), 0});
    schedule.regime.regime = WindRegimeKind::rose;
    schedule.regime.hold_time = 0.31f;
    schedule.regime.rose_seed = 17;
    s->apply(schedule);
    steps(4);
    return s->simulation().state().hash();
  }

  std::uint64_t replayed(const Journal& journal) {
    auto s = session("");
    s->require_journal_of_this_scenario(journal, "journal");
    std::size_t next = 0;
    for (std::uint64_t tick = 0;; ++tick) {
      for (; next < journal.entries.size() && journal.entries[next].tick == tick; ++next)
        s->apply(journal.entries[next].command);
      if (tick == journal.ticks) break;
      s->step();
    }
    EXPECT_EQ(next, journal.entries.size());
    return s->simulation().state().hash();
  }

  test::TemporaryFolder folder_;
};

TEST_P(JournalOf, EveryKindOfCommandReplaysToTheSameHash) {
  const std::uint64_t hash = live(folder_.path("j"));
  const Journal journal = read_journal(folder_.path("j"));
  EXPECT_TRUE(journal.ended);
  EXPECT_EQ(journal.ticks, 20u);
  EXPECT_EQ(static_cast<int>(journal.entries.size()), commands);
  EXPECT_EQ(replayed(journal), hash);
}

TEST_P(JournalOf, IsOneDocumentALine) {
  live(folder_.path("j"));
  const std::string text = test::file_bytes(folder_.path("j"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), commands + 2) << "a header, the commands, the end";
}

TEST_P(JournalOf, CutAnywhereInItsLastLineStillReads) {
  live(folder_.path("j"));
  const std::string text = test::file_bytes(folder_.path("j"));
  const std::size_t last = text.rfind('\n', text.size() - 2) + 1, before = text.rfind('\n', last - 2) + 1;
  for (std::size_t length = before; length <= text.size(); ++length) {
    const Journal journal = read_journal(folder_.write("cut", text.substr(0, length)));
    EXPECT_EQ(static_cast<int>(journal.entries.size()), length < last ? commands - 1 : commands) << length;
    EXPECT_EQ(journal.ended, length == text.size());
  }
}

TEST_P(JournalOf, CutInItsHeaderIsRefused) {
  const std::string text = (live(folder_.path("j")), test::file_bytes(folder_.path("j")));
  for (std::size_t length = 0; length <= text.find('\n'); ++length)
    EXPECT_THROW(read_journal(folder_.write("cut", text.substr(0, length))), ConfigError) << length;
  EXPECT_THROW(read_journal(folder_.path("missing")), ConfigError);
}

TEST_P(JournalOf, WithABrokenLineNamesTheLine) {
  live(folder_.path("j"));
  const std::string text = test::file_bytes(folder_.path("j"));
  const std::string header = text.substr(0, text.find('\n') + 1);
  for (const char* line :
       {"{tick: 3, command: dance}\n", "{tick: 3}\n", "{command: reset}\n", "[1\n", "\n", "3\n",
        "{tick: 5, command: reset}\n{tick: 4, command: reset}\n",
        "{tick: 1, command: set_wind, direction_deg: 1, speed: .nan, ramp: 0}\n",
        "{tick: 1, command: load_checkpoint}\n", "{tick: 1, command: set_wind_schedule}\n"}) {
    SCOPED_TRACE(line);
    try {
      read_journal(folder_.write("bad", header + line));
      ADD_FAILURE() << "was read";
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("line "), std::string::npos) << e.what();
    }
  }
}

TEST_P(JournalOf, WithAPatchThatIsNotAsciiIsRefused) {
  EXPECT_THROW(read_journal(DESERT_SOURCE_DIR "/test/fuzz/corpus/journal/patch_that_is_not_ascii"),
               ConfigError);
}

TEST_P(JournalOf, KeepsTheCheckpointsThatItLoads) {
  const std::string first = folder_.path("first.ck"), second = folder_.path("second.ck");
  std::uint64_t hash = 0;
  {
    auto s = session(folder_.path("j"));
    s->step();
    s->save_checkpoint(first);
    s->save_checkpoint(first);  // nothing refers to it yet
    s->step();
    s->apply(command::LoadCheckpoint{first, 0});
    s->step();
    s->save_checkpoint(second);
    const std::string bytes = test::file_bytes(first);
    std::filesystem::create_directory_symlink(folder_.path("."), folder_.path("link"));
    for (const std::string& path :
         {first, folder_.path("./first.ck"), folder_.path("link/first.ck"), folder_.path("j")}) {
      try {
        s->save_checkpoint(path);
        ADD_FAILURE() << path << " was replaced";
      } catch (const ConfigError& e) {
        EXPECT_NE(std::string(e.what()).find("journal " + folder_.path("j")), std::string::npos) << e.what();
      }
    }
    EXPECT_EQ(test::file_bytes(first), bytes);
    s->step();
    s->save_checkpoint(second);
    hash = s->simulation().state().hash();
  }
  const Journal journal = read_journal(folder_.path("j"));
  EXPECT_EQ(checkpoints_of(journal), std::vector<std::string>{first});
  EXPECT_EQ(replayed(journal), hash);
  auto without = session("");
  without->apply(command::LoadCheckpoint{first, 0});
  without->save_checkpoint(first);
}

TEST_P(JournalOf, KeepsTheTerrainsThatItLoads) {
  const std::string terrain = folder_.write("terrain.yaml", "grid: {width: 9, height: 8}\n");
  auto s = session(folder_.path("j"));
  EXPECT_NO_THROW(s->require_not_of_journal(terrain));
  s->apply(command::LoadScenario{terrain, true, 0, false});
  EXPECT_THROW(s->require_not_of_journal(terrain), ConfigError);
  EXPECT_THROW(s->save_checkpoint(terrain), ConfigError);
  EXPECT_EQ(s->journal_files(), (std::vector<std::string>{folder_.path("j"), terrain}));
}

/// As a node does that is started again and again: the journal before the present one stays replayable.
TEST_P(JournalOf, BeginsWithACheckpointThatThePreviousOneDoesNotNeed) {
  const std::string path = folder_.path("j");
  std::vector<std::string> checkpoints;
  for (int start = 0; start < 4; ++start) {
    if (std::filesystem::exists(path)) std::filesystem::rename(path, path + ".previous");
    checkpoints.push_back(checkpoint_beside(path));
    auto s = session(path);
    s->step();
    session("")->save_checkpoint(checkpoints.back());
    s->apply(command::LoadCheckpoint{checkpoints.back(), 0});
  }
  EXPECT_EQ(checkpoints, (std::vector<std::string>{path + ".checkpoint", path + ".checkpoint.2",
                                                   path + ".checkpoint", path + ".checkpoint.2"}));
  folder_.write("j.previous", "[1\n");
  EXPECT_EQ(checkpoint_beside(path), path + ".checkpoint") << "a journal that cannot be read needs nothing";
}

TEST_P(JournalOf, IsWrittenToARegularFileOnly) {
  folder_.write("victim", "precious");
  std::filesystem::create_symlink(folder_.path("victim"), folder_.path("link"));
  for (const std::string& path :
       {folder_.path("link"), folder_.path("no/such/folder"), std::string("/dev/null")})
    EXPECT_THROW(session(path), ConfigError) << path;
  EXPECT_EQ(test::file_bytes(folder_.path("victim")), "precious");
}

TEST_P(JournalOf, HasWayMadeForIt) {
  make_way_for_journal("");
  const std::string path = folder_.path("new/folder/j");
  make_way_for_journal(path);
  session(path);
  const std::string first = test::file_bytes(path);
  EXPECT_FALSE(first.empty());
  make_way_for_journal(path);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(test::file_bytes(path + ".previous"), first);
  folder_.write("file", "precious");
  EXPECT_THROW(make_way_for_journal(folder_.path("file/j")), ConfigError);
  EXPECT_EQ(test::file_bytes(folder_.path("file")), "precious");
}

TEST_P(JournalOf, AnotherScenarioIsRefused) {
  live(folder_.path("j"));
  Session other(test::scenario_of(std::string(journalled_world) + "seed: 2\n"), no_raster_loader, GetParam(),
                1);
  EXPECT_THROW(other.require_journal_of_this_scenario(read_journal(folder_.path("j")), "j"), ConfigError);
}

TEST_P(JournalOf, RefusedCommandsAreNotWritten) {
  {
    auto s = session(folder_.path("j"));
    EXPECT_THROW(s->apply(command::SetWind{0, -1, 0}), ConfigError);
    EXPECT_THROW(s->apply(command::LoadCheckpoint{"/no/such/file", 0}), ConfigError);
    command::EditTerrain edit;
    edit.value = 90000;
    EXPECT_THROW(s->apply(edit), ConfigError);
  }
  EXPECT_TRUE(read_journal(folder_.path("j")).entries.empty());
}

DESERT_ON_EACH_BACKEND(JournalOf);

}  // namespace
}  // namespace desert_sim

// What a command was accepted with can be saved, loaded and replayed.

#include <limits>

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const char* const repeated_world =
    "grid: {width: 20, height: 16}\n"
    "terrain: [noise: {layer: sand, low: 0, high: 3}]\n"
    "wind: {speed: 5, features: [{x: 10, y: 8, radius: 4, id: 2}]}\n";

class RepeatableCommands : public ::testing::Test {
 protected:
  std::unique_ptr<Session> session(const std::string& journal = "") {
    return std::make_unique<Session>(test::scenario_of(repeated_world), no_raster_loader, "cpu", 1, journal);
  }

  /// Applies the command after two steps, goes on for three, and expects the same from a replay of the
  /// journal and from a checkpoint saved just after the command.
  void expect_repeatable(const Command& command) {
    std::uint64_t hash = 0;
    {
      auto live = session(folder_.path("journal"));
      for (int n = 0; n < 2; ++n) live->step();
      live->apply(command);
      live->save_checkpoint(folder_.path("a.ck"));
      for (int n = 0; n < 3; ++n) live->step();
      hash = live->simulation().state().hash();
    }
    auto loaded = Session::from_checkpoint(folder_.path("a.ck"), no_raster_loader, "cpu", 1);
    loaded->save_checkpoint(folder_.path("b.ck"));
    EXPECT_TRUE(test::file_bytes(folder_.path("a.ck")) == test::file_bytes(folder_.path("b.ck")));
    for (int n = 0; n < 3; ++n) loaded->step();
    EXPECT_EQ(loaded->simulation().state().hash(), hash) << "through a checkpoint";

    const Journal journal = read_journal(folder_.path("journal"));
    ASSERT_EQ(journal.entries.size(), 1u);
    auto replay = session();
    for (int n = 0; n < 2; ++n) replay->step();
    replay->apply(journal.entries[0].command);
    for (int n = 0; n < 3; ++n) replay->step();
    EXPECT_EQ(replay->simulation().state().hash(), hash) << "from the journal";
  }

  const test::TemporaryFolder folder_;
};

TEST_F(RepeatableCommands, AWindRoseWithTheLargestSeed) {
  constexpr std::uint64_t largest = std::numeric_limits<std::uint64_t>::max();
  for (const std::uint64_t seed : {largest, largest - 1, std::uint64_t{1} << 63}) {
    command::SetWindSchedule schedule;
    schedule.regime.regime = WindRegimeKind::rose;
    schedule.regime.hold_time = 1;
    schedule.regime.rose_seed = seed;
    schedule.regime.segments = {{0, 6, 100, 0, 1}, {90, 4, 100, 0, 1}, {200, 7, 100, 0, 1}};
    expect_repeatable(schedule);
  }
}

TEST_F(RepeatableCommands, AWindThatIsClearedWithAnIdThatNobodyUses) {
  command::EditWind clear;
  clear.operation = WindEdit::clear;
  clear.feature.id = -1;
  clear.feature.speed = std::numeric_limits<float>::quiet_NaN();
  expect_repeatable(clear);
  command::EditWind removed;
  removed.operation = WindEdit::remove;
  removed.feature.id = 2;
  removed.feature.radius = -1;
  expect_repeatable(removed);
}

TEST_F(RepeatableCommands, AScheduleWithFieldsThatItsKindDoesNotUseIsCheckedWhole) {
  auto s = session();
  command::SetWindSchedule schedule;
  schedule.regime.regime = WindRegimeKind::timeline;
  schedule.regime.segments = {{0, 6, 100, 0, 1}};
  schedule.regime.direction_deg = 1000;
  EXPECT_THROW(s->apply(schedule), ConfigError);
  schedule.regime.direction_deg = 0;
  schedule.regime.segments.resize(max_wind_segments + 1, schedule.regime.segments[0]);
  EXPECT_THROW(s->apply(schedule), ConfigError);
  schedule.regime.segments.resize(max_wind_segments);
  EXPECT_NO_THROW(s->apply(schedule));
}

TEST_F(RepeatableCommands, SeedsAreAnyIntegersOf64Bits) {
  EXPECT_EQ(test::scenario_of("seed: 18446744073709551615\n").seed,
            std::numeric_limits<std::uint64_t>::max());
  for (const char* seed : {"18446744073709551616", "1.8446744073709551616e19", "-1", "2e19"}) try {
      test::scenario_of(std::string("seed: ") + seed + "\n");
      ADD_FAILURE() << seed << " was read";
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find("[0, 18446744073709551615]"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace desert_sim

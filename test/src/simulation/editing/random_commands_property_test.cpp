// Random commands of every kind: whatever is accepted can be saved, loaded, saved again and replayed.
// DESERT_FUZZ_ROUNDS says how many sessions.

#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/fuzz_rounds.hpp"
#include "test/support/random_commands.hpp"
#include "test/support/small_scenarios.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

TEST(RandomCommands, ThatAreAcceptedCanBeSavedLoadedAndReplayed) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> scenarios{folder.write("desert.yaml", test::small_desert),
                                           folder.write("oasis.yaml", test::small_oasis)};
  int accepted = 0, refused = 0;
  const int rounds = test::fuzz_rounds(40);
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    test::RandomCommands random(static_cast<unsigned>(round));
    const Scenario scenario = test::scenario_of(round % 2 ? test::small_desert : test::small_oasis);
    std::vector<std::string> checkpoints;
    std::uint64_t hash = 0;
    {
      Session live(scenario, no_raster_loader, "cpu", 1, folder.path("journal"));
      for (int n = 0; n < 12; ++n) {
        try {
          live.apply(random.next(live.simulation(), checkpoints, scenarios));
          ++accepted;
        } catch (const ConfigError&) {
          ++refused;
        }
        const std::string path = folder.path(std::to_string(n) + ".ck");
        live.save_checkpoint(path);
        std::unique_ptr<Simulation> loaded;
        ASSERT_NO_THROW(loaded = load_checkpoint(path, live.simulation().exec()));
        ASSERT_EQ(loaded->state().hash(), live.simulation().state().hash());
        ASSERT_TRUE(checkpoint_bytes(*loaded) == test::file_bytes(path));
        checkpoints.push_back(path);
        if (random.one_in(3)) live.step();
      }
      hash = live.simulation().state().hash();
    }
    const Journal journal = read_journal(folder.path("journal"));
    Session replay(scenario, no_raster_loader, "cpu", 1);
    std::size_t next = 0;
    for (std::uint64_t tick = 0;; ++tick) {
      for (; next < journal.entries.size() && journal.entries[next].tick == tick; ++next)
        ASSERT_NO_THROW(replay.apply(journal.entries[next].command));
      if (tick == journal.ticks) break;
      replay.step();
    }
    ASSERT_EQ(replay.simulation().state().hash(), hash);
  }
  EXPECT_GT(accepted, 3 * rounds);
  EXPECT_GT(refused, rounds);
}

}  // namespace
}  // namespace desert_sim

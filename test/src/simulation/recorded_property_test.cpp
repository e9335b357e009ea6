// Files that version 0.1.0 wrote (recorded/ beside this file) can still be read: a checkpoint, and a journal
// with commands of every kind that changes a simulation. scripts/state_hashes compares what follows from them
// bit by bit.

#include <xxhash.h>

#include "kernels/sand/reptation.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string folder = std::string(DESERT_SOURCE_DIR) + "/test/src/simulation/recorded/";

TEST(Recorded, CheckpointIsLoadedToTheBit) {
  const auto exec = make_exec("cpu", 1);
  const auto s = load_checkpoint(folder + "checkpoint", *exec);
  EXPECT_EQ(s->steps(), 30u);
  EXPECT_EQ(s->scenario().get<ReptationParameters>().method,
            ReptationMethod::smoothing);  // which a command had changed
  EXPECT_EQ(s->state().start.get<ReptationParameters>().method, ReptationMethod::adaptive_repose);
  if (XXH_VERSION_NUMBER >= 800) {  // XXH3 was not final before
    EXPECT_EQ(s->state().hash(), 0xfad38a43c28e5276u);
  }
  test::expect_sound(*s, "as loaded");
  test::run(*s, 10);
  test::expect_sound(*s, "ten steps later");
}

TEST(Recorded, JournalIsReplayed) {
  const Journal journal = read_journal(folder + "journal.yaml");
  EXPECT_TRUE(journal.ended);
  EXPECT_EQ(journal.ticks, 50u);
  ASSERT_EQ(journal.entries.size(), 15u);
  Session session(load_scenario(folder + "scenario.yaml"), no_raster_loader, "cpu", 1);
  ASSERT_NO_THROW(session.require_journal_of_this_scenario(journal, "the journal"));
  std::size_t next = 0;
  while (session.ticks() < journal.ticks) {
    for (; next < journal.entries.size() && journal.entries[next].tick == session.ticks(); ++next)
      session.replay(journal.entries[next].command);
    session.step();
  }
  EXPECT_EQ(next, journal.entries.size());
  EXPECT_EQ(session.simulation().steps(), 20u);  // since the reset
  test::expect_sound(session.simulation(), "at the end");
}

}  // namespace
}  // namespace desert_sim

// Undo and redo of resets and loads, where no stroke is left.

#include <gmock/gmock.h>

#include "test/support/edits.hpp"
#include "test/support/session_fixture.hpp"

namespace desert_sim {
namespace {

using ::testing::HasSubstr;

class FormerScenesOf : public test::OnSession {
 protected:
  std::unique_ptr<Session> garden(const std::string& journal = "", std::size_t memory = default_undo_memory) {
    return session("garden", journal, memory);
  }
  static command::LoadScenario text(const std::string& yaml) {
    command::LoadScenario load;
    load.path = "new.yaml";
    load.yaml = yaml;
    return load;
  }
  static command::EditTerrain dab(const std::string& stroke) {
    command::EditTerrain edit;
    edit.x = edit.y = 8;
    edit.radius = 3;
    edit.value = 1;
    edit.stroke = stroke;
    return edit;
  }
};

TEST_P(FormerScenesOf, EveryResetAndLoadComesBackWithAllOfItsState) {
  const std::string journal = folder_.path("journal");
  std::string end;
  std::vector<std::string> states;
  {
    auto s = garden(journal);
    const auto next = [&](const Command& command) {
      steps(*s, 3);
      s->apply(command::SetWind{40, 8, 2});
      s->apply(dab("here"));
      states.push_back(bytes(*s));
      const CommandResult r = s->apply(command);
      EXPECT_TRUE(r.replaces_terrain);
      EXPECT_EQ(s->undoable(), static_cast<int>(states.size())) << "strokes end with their simulation";
    };
    next(command::Reset{});
    s->save_checkpoint(folder_.path("checkpoint"));
    next(text("grid: {width: 20, height: 10}\nterrain: [uniform: {layer: sand, value: 1}]\n"));
    next(command::LoadCheckpoint{folder_.path("checkpoint"), 0});
    next(text("grid: {width: 8, height: 30}\nterrain: [uniform: {layer: sand, value: 2}]\n"));
    states.push_back(bytes(*s));
    for (std::size_t n = states.size() - 1; n-- > 0;) {
      const CommandResult r = s->apply(command::Undo{});
      EXPECT_TRUE(r.replaces_terrain);
      EXPECT_EQ(r.undoable, static_cast<int>(n));
      EXPECT_EQ(r.redoable, static_cast<int>(states.size() - 1 - n));
      ASSERT_TRUE(bytes(*s) == states[n]) << n;
    }
    EXPECT_THAT(refusal(*s, command::Undo{}), HasSubstr("no stroke that can be undone"));
    EXPECT_THAT(refusal(*s, command::Undo{"here"}), HasSubstr("no stroke that can be undone"))
        << "strokes do not come back with their terrain";
    for (std::size_t n = 1; n < 4; ++n) {
      s->apply(command::Redo{});
      ASSERT_TRUE(bytes(*s) == states[n]) << n;
    }
    steps(*s, 5);
    s->apply(command::Reset{});
    EXPECT_EQ(s->redoable(), 0) << "another scene was begun";
    steps(*s, 2);
    s->apply(command::Undo{});
    steps(*s, 2);
    end = bytes(*s);
  }
  auto replay = garden();
  const Journal read = read_journal(journal);
  for (const Journal::Entry& entry : read.entries) {
    while (replay->ticks() < entry.tick) replay->step();
    ASSERT_NO_THROW(replay->apply(entry.command));
  }
  while (replay->ticks() < read.ticks) replay->step();
  EXPECT_TRUE(bytes(*replay) == end);
}

TEST_P(FormerScenesOf, StrokesAreUndoneBeforeTheLoadThatTheyCameAfter) {
  auto s = garden();
  s->apply(dab("before"));
  const std::string before = bytes(*s);
  s->apply(command::Reset{});
  const std::string reset = bytes(*s);
  s->apply(dab("after"));
  EXPECT_EQ(s->undoable(), 2);
  EXPECT_FALSE(s->apply(command::Undo{}).replaces_terrain);
  EXPECT_TRUE(bytes(*s) == reset);
  EXPECT_TRUE(s->apply(command::Undo{}).replaces_terrain);
  EXPECT_TRUE(bytes(*s) == before);
  // What is painted now is kept when the reset is redone.
  s->apply(dab("more"));
  const std::string more = bytes(*s);
  s->apply(command::Redo{});
  EXPECT_TRUE(bytes(*s) == reset);
  s->apply(command::Undo{});
  EXPECT_TRUE(bytes(*s) == more);
}

TEST_P(FormerScenesOf, AResetThatChangesNothingIsNothingToUndo) {
  auto s = garden();
  s->apply(command::Reset{});
  EXPECT_EQ(s->undoable(), 0);
  s->apply(command::SetWind{9, 9, 0});
  s->apply(command::Reset{});
  EXPECT_EQ(s->undoable(), 1) << "the wind was set";
}

TEST_P(FormerScenesOf, MemoryIsBoundedAndTheOldestGoFirst) {
  const std::size_t scene = bytes(*garden()).size();
  auto s = garden("", 3 * scene - 1);
  for (int n = 0; n < 5; ++n) {
    s->apply(dab(std::to_string(n)));
    s->apply(command::Reset{});
  }
  EXPECT_EQ(s->undoable(), 2);
  auto small = garden("", 5000);
  small->apply(command::Reset{});
  EXPECT_EQ(small->undoable(), 0) << "the terrain is too large";
  auto none = garden("", 0);
  none->apply(command::Reset{});
  EXPECT_EQ(none->undoable(), 0);
}

DESERT_ON_EACH_BACKEND(FormerScenesOf);

}  // namespace
}  // namespace desert_sim

// Undo and redo: exact where nothing has moved since, and told to the quantum where something has.

#include <algorithm>
#include <numeric>

#include "test/support/edits.hpp"
#include "test/support/session_fixture.hpp"

namespace desert_sim {
namespace {

bool is_complete(const CommandResult& result) {
  const auto& materials = result.returned.materials;
  return result.returned.missing_plants == 0 &&
         std::all_of(materials.begin(), materials.end(),
                     [](const auto& m) { return !m || m->missing_m3 == 0; });
}

using UndoIn = test::OnSession;

TEST_P(UndoIn, TheOrderOfEditsBringsEveryStateBack) {
  for (const char* world : test::undo_worlds) {
    auto s = session(world);
    test::RandomStrokes random(s->simulation(), 1);
    for (int round = 0; round < 3; ++round) {
      SCOPED_TRACE(std::string(world) + ", round " + std::to_string(round));
      steps(*s, 3);
      std::vector<std::string> states{bytes(*s)};
      while (states.size() < 40)
        if (accepted(*s, random.next(""))) states.push_back(bytes(*s));
      for (std::size_t n = states.size() - 1; n > 0; --n) {
        const CommandResult r = s->apply(command::Undo{});
        EXPECT_TRUE(is_complete(r));
        EXPECT_EQ(r.undoable, static_cast<int>(n - 1 + round * 39));
        ASSERT_TRUE(bytes(*s) == states[n - 1]) << n;
      }
      for (std::size_t n = 1; n < states.size(); ++n) {
        EXPECT_TRUE(is_complete(s->apply(command::Redo{})));
        ASSERT_TRUE(bytes(*s) == states[n]) << n;
      }
      test::expect_sound(s->simulation(), world);
    }
  }
}

/// Named strokes of several operators, undone and redone in any order. Where no answer says that something
/// was missing, the end is the beginning.
TEST_P(UndoIn, AnyOrderBringsTheStartBackIfNothingWasMissing) {
  int exact = 0, inexact = 0;
  for (const char* world : test::undo_worlds)
    for (unsigned seed = 0; seed < 32; ++seed) {
      SCOPED_TRACE(std::string(world) + ", seed " + std::to_string(seed));
      auto s = session(world);
      test::RandomStrokes random(s->simulation(), seed);
      steps(*s, 2);
      const std::string before = bytes(*s);
      bool complete = true;
      CommandResult last;
      const auto turn = [&](const Command& command) {
        try {
          last = s->apply(command);
          complete = complete && is_complete(last);
        } catch (const ConfigError&) {
        }
      };
      for (int n = 0; n < 30; ++n) {
        const std::string name(1, static_cast<char>('a' + random.below(6)));
        if (random.below(4) == 0)
          turn(command::Undo{name});
        else if (random.below(3) == 0)
          turn(command::Redo{name});
        else
          accepted(*s, random.next(random.below(3) ? name : ""));
        test::expect_sound(s->simulation(), world);
      }
      for (int n = 0; n < 60; ++n)
        turn(command::Undo{std::string(1, static_cast<char>('a' + random.below(6)))});
      while (accepted(*s, command::Undo{})) {
      }
      test::expect_sound(s->simulation(), world);
      ++(complete ? exact : inexact);
      EXPECT_TRUE(!complete || bytes(*s) == before);
    }
  EXPECT_GT(exact, 3);
  EXPECT_GT(inexact, 3);
}

/// The materials as they are, in quanta.
std::array<long long, 4> sums(const Simulation& s) {
  std::array<long long, 4> all{};
  const std::vector<Layer> layers[] = {
      {Layer::bedrock}, {Layer::soil}, {Layer::sand, Layer::airborne_sand}, {Layer::water}};
  for (std::size_t n = 0; n < all.size(); ++n)
    for (const Layer layer : layers[n]) {
      const auto values = test::quanta(s, layer);
      all[n] += std::accumulate(values.begin(), values.end(), 0LL);
    }
  return all;
}

TEST_P(UndoIn, AWorldThatMovesTakesWhatIsThereAndTellsIt) {
  const Material materials[] = {Material::bedrock, Material::soil, Material::sand, Material::water};
  for (const char* world : test::undo_worlds) {
    auto s = session(world);
    Simulation& simulation = s->simulation();
    test::RandomStrokes random(simulation, 5);
    const double cell = simulation.scenario().grid.cell_size,
                 quantum = simulation.terrain().scale().quantum();
    int missing = 0;
    for (int n = 0; n < 400; ++n) {
      SCOPED_TRACE(std::string(world) + ", " + std::to_string(n));
      accepted(*s, random.next(random.below(2) ? "a" : ""));
      steps(*s, 1);
      if (n % 3 != 2) continue;
      const std::string before_bytes = bytes(*s);
      const auto before = sums(simulation);
      const long long plants = simulation.state().plants.count;
      const CommandResult r = s->apply(command::Undo{}, true);
      const auto after = sums(simulation);
      for (std::size_t m = 0; m < 4; ++m) {
        const auto& told = r.returned.materials[static_cast<std::size_t>(materials[m])];
        const double change = static_cast<double>(after[m] - before[m]) * quantum * cell * cell;
        EXPECT_NEAR(told ? told->added_m3 - told->removed_m3 : 0.0, change, 1e-9);
        EXPECT_GE(told ? told->missing_m3 : 0.0, 0);
      }
      EXPECT_EQ(simulation.state().plants.count - plants, r.plants);
      missing += !is_complete(r);
      test::expect_sound(simulation, world);
      EXPECT_TRUE(is_complete(s->apply(command::Redo{})));
      ASSERT_TRUE(bytes(*s) == before_bytes) << "redo gives back what undo took";
      if (random.below(2)) s->apply(command::Undo{});
    }
    EXPECT_GT(missing, 5) << world;
  }
}

TEST_P(UndoIn, AStrokeThatConservedConserves) {
  auto s = session("dunes");
  command::EditTerrain pile = test::edit_at(20, 15, BrushShape::circle);
  pile.radius = 2;
  pile.conserve = true;
  pile.ring_width = 2;
  pile.value = 0.5;
  pile.stroke = "pile";
  s->apply(pile);
  steps(*s, 10);
  command::EditTerrain away = test::edit_at(20, 15, BrushShape::circle);
  away.radius = 1;
  away.inner = 1;
  away.merge = BrushMerge::replace;
  away.value = 0;
  s->apply(away);
  const auto before = sums(s->simulation());
  const CommandResult r = s->apply(command::Undo{"pile"});
  EXPECT_EQ(sums(s->simulation()), before);
  const auto& sand = r.returned.materials[static_cast<std::size_t>(Material::sand)];
  ASSERT_TRUE(sand.has_value());
  EXPECT_EQ(sand->added_m3, sand->removed_m3);
  EXPECT_GT(sand->missing_m3, 0);
}

TEST_P(UndoIn, CallsOfOneNameAreOneStrokeUntilItIsUndone) {
  auto s = session("dunes");
  const std::uint64_t start = s->simulation().state().hash();
  command::EditTerrain edit = test::edit_at(5, 5, BrushShape::circle);
  const auto paint = [&](const std::string& name) {
    edit.stroke = name;
    s->apply(edit);
  };
  paint("left");
  paint("right");
  paint("left");
  paint("");
  EXPECT_EQ(s->apply(command::Undo{}).returned.name, "");
  const CommandResult left = s->apply(command::Undo{"left"});
  EXPECT_EQ(left.undoable, 1);
  EXPECT_EQ(left.redoable, 2);
  paint("left");
  EXPECT_EQ(s->apply(command::Undo{}).undoable, 1);
  EXPECT_EQ(s->apply(command::Redo{"left"}).returned.name, "left");
  EXPECT_EQ(s->apply(command::Redo{"left"}).redoable, 1);
  EXPECT_EQ(s->apply(command::Undo{"right"}).undoable, 2);
  while (accepted(*s, command::Undo{})) {
  }
  EXPECT_EQ(s->simulation().state().hash(), start);
}

TEST_P(UndoIn, WhatIsNotThereIsRefused) {
  auto s = session("dunes");
  const auto expect = [&](const Command& command, const std::string& text) {
    const std::string why = refusal(*s, command);
    EXPECT_NE(why.find(text), std::string::npos) << "no '" << text << "' in: " << why;
  };
  expect(command::Undo{}, "no stroke that can be undone");
  expect(command::Redo{}, "no stroke that can be redone");
  command::EditTerrain edit = test::edit_at(5, 5, BrushShape::circle);
  edit.stroke = "a";
  s->apply(edit);
  expect(command::Undo{"b"}, "'b' is not the name");
  expect(command::Undo{"b"}, "the newest is 'a'");
  expect(command::Redo{"a"}, "no stroke that can be redone");
  expect(command::Undo{std::string(256, 'x')}, "256 bytes (allowed: at most 255)");
  expect(command::Undo{"a\n"}, "printable");
  edit.stroke = "\xc3\xa4";
  expect(edit, "printable");
  edit.stroke = std::string(255, '~');
  s->apply(edit);
  s->apply(command::Undo{edit.stroke});
  for (const Command& command :
       {Command(command::Reset{}), Command(command::LoadCheckpoint{folder_.path("c"), 0})}) {
    s->apply(edit);
    s->save_checkpoint(folder_.path("c"));
    s->apply(command);
    expect(command::Undo{edit.stroke},
           "no stroke that can be undone (a load and a reset forget all strokes)");
    expect(command::Redo{}, "no stroke that can be redone (a load and a reset forget all strokes)");
  }
  auto none = session("dunes", "", 0);
  none->apply(edit);
  EXPECT_NE(refusal(*none, command::Undo{}).find("undo_memory is 0"), std::string::npos);
}

TEST_P(UndoIn, MemoryIsBoundedAndTheOldestGoFirst) {
  constexpr std::size_t memory = 20000;
  for (const char* world : test::undo_worlds) {
    auto s = session(world, "", memory), free = session(world, "", 0);
    test::RandomStrokes random(s->simulation(), 3);
    for (int n = 0; n < 60; ++n) {
      Command edit = random.next("");
      EXPECT_EQ(accepted(*s, edit), accepted(*free, edit));
      EXPECT_LE(s->simulation().commands().history().bytes(), memory);
      ASSERT_EQ(s->simulation().state().hash(), free->simulation().state().hash())
          << "memory changes no edit";
    }
    EXPECT_EQ(free->simulation().commands().history().bytes(), 0u);
  }
  auto s = session("dunes", "", memory);
  command::EditTerrain edit = test::edit_at(5, 5, BrushShape::rectangle);
  edit.radius = edit.radius_y = 5;
  for (const char* name : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"})
    edit.stroke = name, s->apply(edit);
  EXPECT_NE(refusal(*s, command::Undo{"a"}).find("'a'"), std::string::npos);
  EXPECT_EQ(s->apply(command::Undo{}).returned.name, "j");
}

TEST_P(UndoIn, AThousandStrokesAreCheap) {
  auto s = session("dunes");
  const std::string before = bytes(*s);
  command::EditTerrain edit = test::edit_at(20, 15, BrushShape::rectangle);
  edit.radius = edit.radius_y = 5;  // 20 x 20 cells
  edit.inner = 1;
  edit.value = 0.001;
  for (int n = 0; n < 1000; ++n) edit.stroke = "s" + std::to_string(n), s->apply(edit);
  EXPECT_LT(s->simulation().commands().history().bytes(), 5u << 20);
  for (int n = 0; n < 1000; ++n) s->apply(command::Undo{});
  EXPECT_TRUE(bytes(*s) == before);
}

TEST_P(UndoIn, AReplayUndoesTheSameWithTheMemoryOfItsJournal) {
  for (const char* world : test::undo_worlds) {
    const std::string path = folder_.path(world);
    std::uint64_t hash = 0;
    int undone = 0;
    {
      auto s = session(world, path, 30000);
      test::RandomStrokes random(s->simulation(), 11);
      for (int n = 0; n < 150; ++n) {
        const std::string name(1, static_cast<char>('a' + random.below(3)));
        const std::size_t which = random.below(6);
        if (which == 0)
          undone += accepted(*s, command::Undo{random.below(2) ? name : ""});
        else if (which == 1)
          accepted(*s, command::Redo{random.below(2) ? name : ""});
        else if (which == 2)
          steps(*s, 1);
        else
          accepted(*s, random.next(name));
      }
      hash = s->simulation().state().hash();
    }
    EXPECT_GT(undone, 5);
    const Journal journal = read_journal(path);
    EXPECT_EQ(journal.undo_memory, 30000u);
    auto replay = session(world, "", journal.undo_memory);
    for (const Journal::Entry& entry : journal.entries) {
      while (replay->ticks() < entry.tick) replay->step();
      ASSERT_NO_THROW(replay->apply(entry.command));
    }
    while (replay->ticks() < journal.ticks) replay->step();
    EXPECT_EQ(replay->simulation().state().hash(), hash);
  }
}

DESERT_ON_EACH_BACKEND(UndoIn);

}  // namespace
}  // namespace desert_sim

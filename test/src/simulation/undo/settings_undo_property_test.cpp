// Undo and redo of what commands set: parameters, ramps, the timeline, the wind. Resets and loads are in
// former_scenes_property_test.cpp.

#include <gmock/gmock.h>

#include "test/support/edits.hpp"
#include "test/support/random_commands.hpp"
#include "test/support/session_fixture.hpp"
#include "test/support/settings.hpp"

namespace desert_sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Where the headers of two checkpoints differ, for the reader of a failure.
std::string difference(const std::string& a, const std::string& b) {
  constexpr std::ptrdiff_t header = 40;  // before it is its length
  const auto length = static_cast<std::ptrdiff_t>(std::min(a.size(), b.size()));
  const auto at = std::mismatch(a.begin() + header, a.begin() + length, b.begin() + header);
  const auto from = static_cast<std::size_t>(at.first - a.begin());
  const std::size_t begin = from > 200 ? from - 200 : 0;
  return "byte " + std::to_string(from) + ":\n" + a.substr(begin, 400) + "\n---\n" + b.substr(begin, 400);
}

class UndoOfSettingsIn : public test::OnSession {
 protected:
  static float lift(Session& s) { return s.simulation().scenario().get<SaltationParameters>().lift; }
  static command::SetParameters set(std::vector<std::string> settings, double ramp = 0,
                                    const std::string& stroke = "") {
    return {std::move(settings), ramp, stroke};
  }
};

TEST_P(UndoOfSettingsIn, TheOrderOfCommandsBringsEveryStateBack) {
  for (const char* world : test::undo_worlds) {
    auto s = session(world);
    test::RandomStrokes strokes(s->simulation(), 1);
    test::RandomSettings settings(2);
    for (int round = 0; round < 3; ++round) {
      SCOPED_TRACE(std::string(world) + ", round " + std::to_string(round));
      steps(*s, 3);
      std::vector<std::string> states{bytes(*s)};
      const int before = s->undoable();
      while (states.size() < 40) {
        const int known = s->undoable();
        if (accepted(*s, settings.below(3) ? settings.next("") : strokes.next("")) && s->undoable() > known)
          states.push_back(bytes(*s));
      }
      ASSERT_EQ(s->undoable(), before + 39);
      for (std::size_t n = states.size() - 1; n > 0; --n) {
        s->apply(command::Undo{});
        ASSERT_TRUE(bytes(*s) == states[n - 1]) << n << ", " << difference(bytes(*s), states[n - 1]);
      }
      for (std::size_t n = 1; n < states.size(); ++n) {
        s->apply(command::Redo{});
        ASSERT_TRUE(bytes(*s) == states[n]) << n;
      }
      test::expect_sound(s->simulation(), world);
    }
  }
}

/// Whether the command sets something, and not what holds layers: they are found anew then.
bool only_sets(const Command& command) {
  if (const auto* set = std::get_if<command::SetParameters>(&command))
    return std::none_of(set->settings.begin(), set->settings.end(), [](const std::string& setting) {
      const auto is_of = [&](const char* path) { return setting.rfind(path, 0) == 0; };
      return is_of("run.hold_time") || is_of("run.time_step") || is_of("wind_shadow.enabled");
    });
  return std::holds_alternative<command::SetWind>(command) ||
         std::holds_alternative<command::SetWindSchedule>(command) ||
         std::holds_alternative<command::EditWind>(command);
}

TEST_P(UndoOfSettingsIn, AnyParameterComesBack) {
  for (const char* world : test::undo_worlds) {
    auto s = session(world);
    test::RandomCommands random(3);
    steps(*s, 2);
    std::vector<std::string> states{bytes(*s)};
    while (states.size() < 60) {
      Command command = random.next(s->simulation(), {}, {});
      if (!only_sets(command)) continue;
      std::visit(
          [](auto& one) {
            if constexpr (test::has_stroke<std::decay_t<decltype(one)>>) one.stroke.clear();
          },
          command);
      const int known = s->undoable();
      if (accepted(*s, command) && s->undoable() > known) states.push_back(bytes(*s));
    }
    for (std::size_t n = states.size() - 1; n > 0; --n) {
      s->apply(command::Undo{});
      ASSERT_TRUE(bytes(*s) == states[n - 1])
          << world << ", " << n << ", " << difference(bytes(*s), states[n - 1]);
    }
  }
}

TEST_P(UndoOfSettingsIn, AnyOrderAmongStepsIsSoundAndReplays) {
  for (const char* world : test::undo_worlds)
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(std::string(world) + ", seed " + std::to_string(seed));
      const std::string path = folder_.path(world + std::to_string(seed));
      std::string end;
      int undone = 0;
      {
        auto s = session(world, path, 60000);
        test::RandomStrokes strokes(s->simulation(), seed);
        test::RandomSettings settings(seed + 100);
        for (int n = 0; n < 80; ++n) {
          const std::string name(1, static_cast<char>('a' + settings.below(4)));
          switch (settings.below(6)) {
            case 0:
              undone += accepted(*s, command::Undo{settings.below(2) ? name : ""});
              break;
            case 1:
              accepted(*s, command::Redo{settings.below(2) ? name : ""});
              break;
            case 2:
              steps(*s, 1);
              break;
            case 3:
              accepted(*s, strokes.next(name));
              break;
            default:
              accepted(*s, settings.next(settings.below(2) ? name : ""));
          }
          EXPECT_LE(s->simulation().commands().history().bytes(), 60000u);
        }
        test::expect_sound(s->simulation(), world);
        end = bytes(*s);
      }
      EXPECT_GT(undone, 3);
      const Journal journal = read_journal(path);
      auto replay = session(world, "", journal.undo_memory);
      for (const Journal::Entry& entry : journal.entries) {
        while (replay->ticks() < entry.tick) replay->step();
        ASSERT_NO_THROW(replay->apply(entry.command));
      }
      while (replay->ticks() < journal.ticks) replay->step();
      EXPECT_TRUE(bytes(*replay) == end);
    }
}

TEST_P(UndoOfSettingsIn, TheWindGoesOnAsIfItHadNotBeenSet) {
  auto s = session("dunes"), twin = session("dunes");
  command::SetWindSchedule gusts;
  gusts.regime.regime = WindRegimeKind::timeline;
  for (int n = 0; n < 5; ++n) gusts.regime.segments.push_back({40.0f * n, 4.0f + n, 3, 1, 1});
  for (Session* each : {s.get(), twin.get()}) {
    each->apply(gusts);
    steps(*each, 2);
  }
  s->apply(command::SetWind{90, 12, 0});
  steps(*s, 4);
  const CommandResult r = s->apply(command::Undo{});
  ASSERT_EQ(r.returned.settings.size(), 1u);
  EXPECT_THAT(r.returned.settings[0], HasSubstr("wind={regime: timeline"));
  steps(*twin, 4);
  for (int n = 0; n < 20; ++n) {
    EXPECT_EQ(s->simulation().state().wind_above().x, twin->simulation().state().wind_above().x) << n;
    EXPECT_EQ(s->simulation().state().wind_above().y, twin->simulation().state().wind_above().y) << n;
    steps(*s, 1);
    steps(*twin, 1);
  }
  s->apply(command::Undo{});
  EXPECT_EQ(s->simulation().state().wind_regime.regime, WindRegimeKind::constant);
  EXPECT_EQ(s->simulation().state().wind_regime.speed, 7) << "of the scenario";
}

TEST_P(UndoOfSettingsIn, TheNewestStrokeThatIsNotUndoneSaysWhatAParameterIs) {
  auto s = session("dunes");
  const float start = lift(*s);
  s->apply(set({"saltation.lift=0.2"}, 0, "a"));
  s->apply(set({"saltation.lift=0.3", "abrasion.rate=0.25"}, 0, "b"));
  EXPECT_TRUE(s->apply(command::Undo{"a"}).returned.settings.empty()) << "b has set it since";
  EXPECT_EQ(lift(*s), 0.3f);
  EXPECT_THAT(s->apply(command::Undo{"b"}).returned.settings,
              ElementsAre(HasSubstr("abrasion.rate=0.0099999"), HasSubstr("saltation.lift=")));
  EXPECT_EQ(lift(*s), start);
  s->apply(command::Redo{"b"});
  s->apply(command::Redo{"a"});
  EXPECT_EQ(lift(*s), 0.3f);
  s->apply(command::Undo{"b"});
  EXPECT_EQ(lift(*s), 0.2f);
  s->apply(set({"saltation.lift=0.6"}, 0, "a"));
  s->apply(set({"saltation.lift=0.7"}, 0, "a"));
  EXPECT_EQ(s->undoable(), 2) << "the former stroke a ended when it was undone";
  s->apply(command::Undo{"a"});
  EXPECT_EQ(lift(*s), 0.2f);
  s->apply(command::Undo{"a"});
  EXPECT_EQ(lift(*s), start);
}

TEST_P(UndoOfSettingsIn, ARampEndsWithItsStroke) {
  auto s = session("dunes");
  const float start = lift(*s);
  s->apply(set({"saltation.lift=0.9"}, 40));
  steps(*s, 10);
  const float halfway = lift(*s);
  EXPECT_NE(halfway, start);
  s->apply(command::Undo{});
  EXPECT_EQ(lift(*s), start);
  EXPECT_TRUE(s->simulation().state().ramps.empty());
  steps(*s, 3);
  EXPECT_EQ(lift(*s), start);
  s->apply(command::Redo{});
  EXPECT_EQ(lift(*s), halfway);
  steps(*s, 60);
  EXPECT_EQ(lift(*s), 0.9f) << "it goes on by its own time";
  // A value at once ends a ramp; its undo lets the ramp go on.
  s->apply(set({"saltation.lift=0.1"}, 1000));
  s->apply(set({"saltation.lift=0.5"}));
  EXPECT_TRUE(s->simulation().state().ramps.empty());
  s->apply(command::Undo{});
  EXPECT_EQ(s->simulation().state().ramps.size(), 1u);
}

TEST_P(UndoOfSettingsIn, ATimelineComesBackWithWhatLiesAhead) {
  auto s = session("dunes");
  s->apply(set(
      {"run.timeline=[{time: 5, set: {saltation.lift: 0.25}}, {time: 20, set: {saltation.lift: 0.75}}]"}));
  s->apply(set({"run.timeline=[]"}));
  steps(*s, 8);
  EXPECT_NE(lift(*s), 0.25f);
  s->apply(command::Undo{});
  steps(*s, 8);
  EXPECT_NE(lift(*s), 0.25f) << "its time has passed";
  steps(*s, 8);
  EXPECT_EQ(lift(*s), 0.75f);
}

TEST_P(UndoOfSettingsIn, FeaturesComeBackOneByOneInTheirOrder) {
  auto s = session("dunes");
  const auto feature = [](WindEdit operation, int id, float speed) {
    command::EditWind edit;
    edit.operation = operation;
    edit.feature.id = id;
    edit.feature.x = 105;
    edit.feature.y = -45;
    edit.feature.speed = speed;
    return edit;
  };
  const auto ids = [&] {
    std::vector<int> all;
    for (const WindFeature& f : s->simulation().scenario().wind_features) all.push_back(f.id);
    return all;
  };
  for (int id : {7, 3, 5}) s->apply(feature(WindEdit::add, id, 1));
  s->apply(feature(WindEdit::change, 3, 2));
  s->apply(feature(WindEdit::remove, 3, 0));
  EXPECT_THAT(ids(), ElementsAre(7, 5));
  EXPECT_THAT(s->apply(command::Undo{}).returned.settings, ElementsAre(HasSubstr("wind.features.3={")));
  EXPECT_THAT(ids(), ElementsAre(7, 3, 5));
  EXPECT_EQ(s->simulation().scenario().wind_features[1].speed, 2);
  s->apply(command::Undo{});
  EXPECT_EQ(s->simulation().scenario().wind_features[1].speed, 1);
  command::EditWind clear;
  clear.operation = WindEdit::clear;
  s->apply(clear);
  s->apply(feature(WindEdit::add, 9, 4));
  s->apply(command::Undo{});
  s->apply(command::Undo{});
  EXPECT_THAT(ids(), ElementsAre(7, 3, 5));
  EXPECT_THAT(s->apply(command::Undo{}).returned.settings, ElementsAre("wind.features.5 removed"));
  EXPECT_THAT(ids(), ElementsAre(7, 3));
}

TEST_P(UndoOfSettingsIn, PlantsThatLiveKeepTheirSpecies) {
  auto s = session("garden");
  const std::string start = bytes(*s);
  s->apply(set({"species.2={preset: palm}"}, 0, "palms"));
  command::EditPlants plant;
  plant.species = "palm";
  plant.x = plant.y = 20;
  plant.radius = 5;
  plant.density = 0.5;
  plant.stroke = "grove";
  s->apply(plant);
  ASSERT_GT(s->simulation().state().plants.count, 0);
  EXPECT_THAT(refusal(*s, command::Undo{"palms"}), HasSubstr("species.2: "));
  s->apply(command::Undo{"grove"});
  s->apply(command::Undo{"palms"});
  EXPECT_TRUE(bytes(*s) == start);
  EXPECT_THAT(refusal(*s, command::Redo{"grove"}), HasSubstr("redo: species.2: is not 'palm' any more"));
  s->apply(set({"species.2={preset: seaweed}"}));
  EXPECT_THAT(refusal(*s, command::Redo{"grove"}), HasSubstr("redo: species.2: is not 'palm' any more"));
  s->apply(command::Undo{});
  s->apply(command::Redo{"palms"});
  s->apply(command::Redo{"grove"});
  EXPECT_GT(s->simulation().state().plant_counts().at(2).plants, 0);
}

/// A stroke knows the species that came while it was painted.
TEST_P(UndoOfSettingsIn, AStrokeMayPlantSpeciesThatItDidNotBeginWith) {
  auto s = session("garden");
  command::EditPlants plant;
  plant.species = "bush";
  plant.x = plant.y = 20;
  plant.radius = 5;
  plant.density = 0.5;
  plant.stroke = "grove";
  const std::string start = bytes(*s);
  s->apply(plant);
  s->apply(set({"species.2={preset: palm}"}, 0, "palms"));
  plant.species = "palm";
  plant.seed = 7;
  s->apply(plant);
  ASSERT_GT(s->simulation().state().plant_counts().at(2).plants, 0);
  const std::string grown = bytes(*s);
  s->apply(command::Undo{"grove"});
  s->apply(command::Redo{"grove"});
  EXPECT_TRUE(bytes(*s) == grown);
  s->apply(command::Undo{"grove"});
  s->apply(command::Undo{"palms"});
  EXPECT_TRUE(bytes(*s) == start);
  EXPECT_THAT(refusal(*s, command::Redo{"grove"}), HasSubstr("redo: species.2: is not 'palm' any more"));
}

/// One stroke that lets plants live, paints soil and plants: it comes and goes whole.
TEST_P(UndoOfSettingsIn, AStrokeOfSettingsAndEditsIsOne) {
  const char* const bare =
      "grid: {width: 32, height: 24}\nterrain: [uniform: {layer: sand, value: 1}]\nwind: {speed: 6}\n";
  Session s(test::scenario_of(bare), no_raster_loader, GetParam(), 1);
  steps(s, 3);
  const std::string start = bytes(s);
  s.apply(set({"soil.enabled=true", "moisture.enabled=true"}, 0, "oasis"));
  command::EditTerrain ground;
  ground.x = ground.y = 12;
  ground.radius = 6;
  ground.stroke = "oasis";
  for (const char* layer : {"soil", "moisture"}) {
    ground.layer = layer;
    s.apply(ground);
  }
  s.apply(set({"species=[{preset: palm}]", "vegetation.enabled=true"}, 0, "oasis"));
  command::EditPlants plant;
  plant.species = "palm";
  plant.x = plant.y = 12;
  plant.radius = 5;
  plant.density = 1;
  plant.stroke = "oasis";
  s.apply(plant);
  ASSERT_GT(s.simulation().state().plants.count, 0);
  ASSERT_EQ(s.undoable(), 1);
  const std::string oasis = bytes(s);
  s.apply(command::Undo{});
  EXPECT_TRUE(bytes(s) == start);
  EXPECT_FALSE(s.simulation().terrain().has(Layer::soil));
  s.apply(command::Redo{});
  EXPECT_TRUE(bytes(s) == oasis);
  steps(s, 4);
  s.apply(command::Undo{});
  EXPECT_EQ(s.simulation().state().plants.count, 0);
  test::expect_sound(s.simulation(), "undone after steps");
  s.apply(command::Redo{});
  test::expect_sound(s.simulation(), "redone");
  steps(s, 2);
  test::expect_sound(s.simulation(), "goes on");
}

/// Plants that died, and then the life of plants taken back: nothing is left to be turned.
TEST_P(UndoOfSettingsIn, PlantsAreNotTurnedWhereNoneLive) {
  const char* const bare =
      "grid: {width: 32, height: 24}\nterrain: [uniform: {layer: sand, value: 1}]\nspecies: [{preset: "
      "palm}]\n";
  Session s(test::scenario_of(bare), no_raster_loader, GetParam(), 1);
  s.apply(set({"vegetation.enabled=true"}, 0, "life"));
  command::EditPlants plant;
  plant.species = "palm";
  plant.x = plant.y = 12;
  plant.radius = 5;
  plant.density = 1;
  plant.stroke = "grove";
  s.apply(plant);
  EXPECT_THAT(refusal(s, command::Undo{"life"}), HasSubstr("vegetation.enabled: "));
  plant.operation = PlantEdit::clear;
  plant.radius = 40;
  plant.stroke = "fire";
  s.apply(plant);
  ASSERT_EQ(s.simulation().state().plants.count, 0);
  s.apply(command::Undo{"life"});
  EXPECT_THAT(refusal(s, command::Undo{"grove"}), HasSubstr("undo: plants: none live here any more"));
  EXPECT_THAT(refusal(s, command::Undo{"fire"}), HasSubstr("undo: plants: none live here any more"));
  s.apply(command::Redo{"life"});
  s.apply(command::Undo{"fire"});
  EXPECT_GT(s.simulation().state().plants.count, 0);
  s.apply(command::Undo{"grove"});
  EXPECT_EQ(s.simulation().state().plants.count, 0);
}

TEST_P(UndoOfSettingsIn, WhatSettingsBroughtStaysWhereMaterialLies) {
  const char* const bare = "grid: {width: 16, height: 16}\nterrain: [uniform: {layer: sand, value: 1}]\n";
  Session s(test::scenario_of(bare), no_raster_loader, GetParam(), 1);
  s.apply(set({"water.enabled=true", "rain.rate=0.001", "rain.share_low=1", "rain.share_high=1"}, 0, "rain"));
  ASSERT_TRUE(s.simulation().terrain().has(Layer::water));
  steps(s, 3);
  s.apply(command::Undo{"rain"});
  EXPECT_TRUE(s.simulation().terrain().has(Layer::water)) << "no material goes with a setting";
  test::expect_sound(s.simulation(), "after rain");
  command::EditTerrain pond;
  pond.layer = "soil";
  pond.x = pond.y = 8;
  pond.radius = 3;
  pond.stroke = "soil";
  s.apply(set({"soil.enabled=true"}, 0, "on"));
  s.apply(pond);
  s.apply(command::Undo{"soil"});
  s.apply(command::Undo{"on"});
  EXPECT_FALSE(s.simulation().terrain().has(Layer::soil));
  EXPECT_THAT(refusal(s, command::Redo{"soil"}), HasSubstr("redo: soil: is not in use here any more"));
}

TEST_P(UndoOfSettingsIn, TheClockIsThatOfBeforeWhileNoStepIsMade) {
  auto s = session("dunes");
  steps(*s, 3);
  const std::string start = bytes(*s);
  s->apply(set({"run.time_step=0.3", "run.acceleration=7"}));
  s->apply(command::Undo{});
  EXPECT_TRUE(bytes(*s) == start);
  s->apply(command::Redo{});
  steps(*s, 2);
  const double time = s->simulation().time();
  s->apply(command::Undo{});
  EXPECT_EQ(s->simulation().time(), time) << "clocks never go back";
  steps(*s, 1);
  EXPECT_EQ(s->simulation().time(), time + 1);
}

TEST_P(UndoOfSettingsIn, WhatChangesNothingIsNoStroke) {
  auto s = session("dunes");
  s->apply(set({"abrasion.rate=0.01"}));
  EXPECT_EQ(s->undoable(), 0);
  for (int n = 0; n < 50; ++n) s->apply(command::SetWind{static_cast<float>(n), 5, 0, "cmd_wind"});
  EXPECT_EQ(s->undoable(), 1);
  s->apply(command::Undo{});
  EXPECT_EQ(s->simulation().state().wind_regime.speed, 7);
}

TEST_P(UndoOfSettingsIn, JournalsBeforeVersion3KnowStrokesOfEditsAlone) {
  auto s = session("dunes");
  s->undo_edits_alone();
  s->apply(test::edit_at(5, 5, BrushShape::circle));
  s->apply(set({"saltation.lift=0.9"}));
  s->apply(command::SetWind{10, 3, 0});
  EXPECT_EQ(s->undoable(), 1);
  s->apply(command::Undo{});
  EXPECT_EQ(lift(*s), 0.9f);
  s->apply(test::edit_at(5, 5, BrushShape::circle));
  s->apply(command::Reset{});
  EXPECT_EQ(s->undoable(), 0);
  EXPECT_THAT(refusal(*s, command::Undo{}), HasSubstr("no stroke that can be undone"));
}

DESERT_ON_EACH_BACKEND(UndoOfSettingsIn);

}  // namespace
}  // namespace desert_sim

// Commands of run.timeline: they do what the same commands from outside do, when they should, again and
// again, to the bit through checkpoints; what could never be applied is refused at the start.

#include <random>

#include "src/scenario/live_parameters.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/checkpoint_parts.hpp"
#include "test/support/log_lines.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string world =
    "grid: {width: 40, height: 32, cell_size: 1}\n"
    "terrain:\n  - noise: {layer: soil, low: 0.5, high: 1, scale: 9, seed: 2}\n"
    "  - noise: {layer: sand, low: 0, high: 2, scale: 9}\n"
    "vegetation: {enabled: true}\nspecies: [{preset: bush, moisture_lowest: 0, light_highest: 2, slope: 9}]\n"
    "wind: {speed: 6, warping: false, projection: false}\n";

/// One entry of each kind, and parameters between them.
const std::string events =
    "- {time: 3, command: edit_terrain, x: 12, y: 10, radius: 5, value: 1.5}\n"
    "- {time: 5, command: edit_wind, operation: add, id: 7, kind: vortex, x: 20, y: 16, radius: 8, speed: "
    "4}\n"
    "- {time: 8, set: {saltation.lift: 0.3}}\n"
    "- {time: 8, every: 4, until: 20, command: edit_plants, species: bush, x: 30, y: 20, radius: 6,"
    " density: 0.05, size: 0.5}\n"
    "- {time: 10, command: edit_terrain, merge: sub, shape: polygon, points: [[2, 2], [20, 4], [9, 25]],"
    " value: 0.3, stroke: ditch}\n"
    "- {time: 15, command: set_wind, direction_deg: 60, speed: 7, ramp: 4}\n"
    "- {time: 24, command: set_wind_schedule, regime: rose, hold_time: 3, segments: [{direction_deg: 0},"
    " {direction_deg: 90, probability: 2}]}\n";

std::string as_timeline(const std::string& list) {
  std::string text = "run:\n  timeline:\n";
  for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end + 1) {
    end = list.find('\n', begin);
    text += "    " + list.substr(begin, end - begin) + "\n";
  }
  return text;
}

class TimedCommands : public test::OnBackend {
 protected:
  /// The commands of `events`, as somebody gives them from outside before the step that begins at `time` [s].
  void give(Simulation& s, double time) const {
    const auto at = [time](double when) { return time == when; };
    command::EditTerrain edit;
    if (at(3)) {
      edit.x = 12, edit.y = 10, edit.radius = 5, edit.value = 1.5;
      s.apply(edit);
    }
    if (at(5)) {
      command::EditWind wind;
      wind.feature.id = 7;
      wind.feature.kind = WindFeatureKind::vortex;
      wind.feature.x = 20, wind.feature.y = 16, wind.feature.radius = 8, wind.feature.speed = 4;
      s.apply(wind);
    }
    if (at(8)) s.apply(command::SetParameters{{"saltation.lift=0.3"}});
    if (at(8) || at(12) || at(16) || at(20)) {
      command::EditPlants plants;
      plants.species = "bush";
      plants.x = 30, plants.y = 20, plants.radius = 6, plants.density = 0.05, plants.size = 0.5;
      s.apply(plants);
    }
    if (at(10)) {
      edit.merge = BrushMerge::sub;
      edit.shape = BrushShape::polygon;
      edit.points = {{2, 2}, {20, 4}, {9, 25}};
      edit.value = 0.3;
      s.apply(edit);
    }
    if (at(15)) s.apply(command::SetWind{60, 7, 4});
    if (at(24)) {
      command::SetWindSchedule schedule;
      schedule.regime.regime = WindRegimeKind::rose;
      schedule.regime.hold_time = 3;
      WindSegment east, north;
      north.direction_deg = 90, north.probability = 2;
      schedule.regime.segments = {east, north};
      s.apply(schedule);
    }
  }
};

TEST_P(TimedCommands, DoWhatTheSameCommandsFromOutsideDo) {
  const auto timed = simulation(world + as_timeline(events)), given = simulation(world);
  for (int step = 0; step < 36; ++step) {
    give(*given, given->time());
    given->step();
    timed->step();
    ASSERT_EQ(timed->state().hash(), given->state().hash()) << "after " << step + 1 << " s";
  }
  EXPECT_GT(given->state().plants.count, 4);
  EXPECT_EQ(given->scenario().wind_features.size(), 1u);
  test::expect_sound(*timed, "at the end");
  EXPECT_EQ(timed->commands().history().undoable(), given->commands().history().undoable());
}

TEST_P(TimedCommands, ContinueToTheBitFromACheckpoint) {
  const auto whole = simulation(world + as_timeline(events));
  const test::TemporaryFolder folder;
  for (const int half : {1, 8, 9, 12, 13, 27}) {
    const auto first = simulation(world + as_timeline(events));
    test::run(*first, half);
    save_checkpoint(folder.path("half"), *first);
    const auto second = load_checkpoint(folder.path("half"), exec());
    EXPECT_EQ(second->commands().describe_changes(), first->commands().describe_changes());
    test::run(*second, 36 - half);
    if (whole->steps() == 0) test::run(*whole, 36);
    EXPECT_EQ(second->state().hash(), whole->state().hash()) << half;
  }
}

/// However long steps have become: what is due several times before one step happens once.
TEST_P(TimedCommands, ContinueFromACheckpointOfLongerSteps) {
  const auto s = simulation(
      world + as_timeline("- {time: 1, every: 2, command: edit_terrain, x: 12, y: 10, value: 0.25}\n"
                          "- {time: 4, set: {run.time_step: 5}}\n"));
  test::run(*s, 8);
  const test::TemporaryFolder folder;
  save_checkpoint(folder.path("long"), *s);
  const auto again = load_checkpoint(folder.path("long"), exec());
  test::run(*s, 3);
  test::run(*again, 3);
  EXPECT_EQ(again->state().hash(), s->state().hash());
  test::expect_sound(*s, "at the end");
}

TEST_P(TimedCommands, SayWhatComesNext) {
  const auto s = simulation(world + as_timeline(events));
  EXPECT_EQ(s->commands().describe_changes(), "at 3 s: edit_terrain");
  test::run(*s, 9);
  EXPECT_EQ(s->commands().describe_changes(), "at 10 s: edit_terrain");
  test::run(*s, 2);
  EXPECT_EQ(s->commands().describe_changes(), "at 12 s: edit_plants");
  test::run(*s, 25);
  EXPECT_EQ(s->commands().describe_changes(), "");
}

/// Whether there is water to paint is known when it is due.
TEST_P(TimedCommands, ThatAreRefusedAreToldAndTheRunGoesOn) {
  const test::LogLines log;
  const auto s =
      simulation(world + as_timeline("- {time: 2, command: edit_terrain, layer: water, value: 1}\n"
                                     "- {time: 4, set: {rain.rate: 1.0e-6}}\n"
                                     "- {time: 4, command: edit_terrain, layer: water, value: 1}\n"));
  test::run(*s, 4);
  ASSERT_EQ(log.lines.size(), 1u);
  EXPECT_NE(log.lines[0].find("run.timeline: at 2 s edit_terrain is refused: edit_terrain: layer: water"),
            std::string::npos)
      << log.lines[0];
  test::run(*s, 2);
  EXPECT_EQ(log.lines.size(), 1u) << "the rain of 4 s had brought the layer water when the edit was due";
  EXPECT_GT(s->state().balance()[static_cast<std::size_t>(Material::water)].in, 0);
}

TEST_P(TimedCommands, AreReadBackFromADumpedScenario) {
  const Scenario scenario = test::parsed(world + as_timeline(events));
  EXPECT_TRUE(changed_parameters(scenario, test::parsed(dump_scenario(scenario))).empty());
  const auto s = simulation(dump_scenario(scenario)), of_text = simulation(world + as_timeline(events));
  test::run(*s, 26);
  test::run(*of_text, 26);
  EXPECT_EQ(s->state().hash(), of_text->state().hash());
}

DESERT_ON_EACH_BACKEND(TimedCommands);

/// Checkpoints of former versions count entries.
TEST(TimelineOfFormerCheckpoints, GoesOnWhereItWas) {
  const auto exec = make_exec("cpu", 1);
  const std::string text = world +
                           "run: {timeline: [{time: 0, set: {wind.speed: 7}}, {time: 5, ramp: 8, set: "
                           "{saltation.lift: 0.2}}, {time: 9, set: {wind.speed: 5}}]}\n";
  for (const auto& [steps, done] : {std::pair(0, "0"), {3, "1"}, {6, "2"}, {12, "3"}}) {
    const auto s = test::simulate(*exec, text);
    test::run(*s, steps);
    test::CheckpointParts parts(checkpoint_bytes(*s));
    YAML::Node header = parts.parsed_header();
    header.remove("timeline_time");
    header["next_timeline_entry"] = done;
    parts.set_header(header);
    const test::TemporaryFolder folder;
    const auto former = load_checkpoint(folder.write("former.ck", parts.bytes()), *exec);
    EXPECT_EQ(former->commands().describe_changes(), s->commands().describe_changes());
    test::run(*former, 15);
    test::run(*s, 15);
    EXPECT_EQ(former->state().hash(), s->state().hash()) << steps;
  }
}

/// Against all repetitions, one by one.
TEST(TimelineEntries, HappenAtEachRepetitionOnce) {
  std::mt19937 dice(7);
  const auto number = [&](double most) { return std::uniform_real_distribution<double>(0, most)(dice); };
  for (int trial = 0; trial < 3000; ++trial) {
    TimelineEntry entry;
    entry.time = trial % 3 ? number(20) : std::round(number(20));
    if (trial % 5) entry.every = trial % 2 ? 0.1 * (1 + std::round(number(40))) : number(5) + 1e-3;
    if (trial % 7 > 3) entry.until = entry.time + number(60);
    const auto repetition = [&] { return entry.time + std::round(number(30)) * entry.every; };
    const double after = trial % 6 == 1 ? repetition() : number(100) - 1,
                 now = trial % 6 == 2 ? std::max(repetition(), after) : after + number(trial % 4 ? 3 : 40);
    std::optional<double> next, last;
    for (int n = 0; n < 200000; ++n) {
      const double time = entry.time + n * entry.every;
      if (time > entry.until || time > 200 || (n > 0 && entry.every == 0)) break;
      if (time > after && !next) next = time;
      if (time > after && time <= now) last = time;
    }
    EXPECT_EQ(entry.next_after(after), next) << trial;
    EXPECT_EQ(entry.last_between(after, now), last) << trial;
  }
}

/// Where numbers lie farther apart than repetitions, each search ends.
TEST(TimelineEntries, MayLieCloserThanNumbers) {
  TimelineEntry entry;
  entry.every = entry.most_frequent;
  for (const double after : {1e9, 9.0e11, 9.99e11}) {
    const double number = std::nextafter(after, 1e30), step = std::max(2 * entry.every, number - after);
    ASSERT_TRUE(entry.next_after(after).has_value());
    EXPECT_GT(*entry.next_after(after), after);
    EXPECT_LE(*entry.next_after(after), after + step);
    ASSERT_TRUE(entry.last_between(after, after + 10).has_value());
    EXPECT_GT(*entry.last_between(after, after + 10), after);
    EXPECT_LE(*entry.last_between(after, after + 10), after + 10);
  }
}

TEST(TimedCommandFaults, AreRefusedAtTheStart) {
  const auto exec = make_exec("cpu", 1);
  const auto fault_of = [&](const std::string& entry) -> std::string {
    try {
      test::simulate(*exec, world + "run: {timeline: [" + entry + "]}\n");
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(fault_of("{time: 1, command: edit_terrain, x: 5}"), "");
  for (const auto& [entry, part] : std::vector<std::pair<std::string, std::string>>{
           {"{time: 1, command: edit_terain}",
            "'edit_terain' is not one of: set_wind, set_wind_schedule, "
            "edit_wind, edit_terrain, edit_plants; did you mean 'edit_terrain'?"},
           {"{time: 1, command: undo}", "'undo' is not one of"},
           {"{time: 1, command: set_parameters}", "write set: {path: value}"},
           {"{time: 1, command: [edit_terrain]}", "is not one of: set_wind"},
           {"{time: 2.5, command: edit_terrain, radius: -1}",
            "run.timeline.0 (at 2.5 s): edit_terrain: radius: -1"},
           {"{time: 1, command: edit_terrain, radios: 1}", "radios: unknown key"},
           {"{time: 1, command: edit_terrain, ramp: 1}", "ramp: unknown key"},
           {"{time: 1, command: edit_terrain, layer: gold}", "layer: 'gold' is not one of: sand"},
           {"{time: 1, command: edit_terrain, shape: polygon}", "points: 0 are given"},
           {"{time: 1, command: edit_terrain, shape: polygon, points: [[1, 2], [3, 4, 5], [6, 7]]}",
            "points[1]: a list is not a pair [x, y]"},
           {"{time: 1, command: edit_plants, species: oak}", "oak"},
           {"{time: 1, command: edit_wind, operation: remove, id: 3, radius: 4}", "radius: unknown key"},
           {"{time: 1, command: set_wind, speed: fast}", "speed: fast is not a number"},
           {"{time: 1, command: set_wind_schedule, regime: rose, segments: []}", "segments"},
           {"{time: 1, command: set_wind_schedule, regime: rose, segments: [{sped: 4}]}",
            "segments.0.sped: unknown key"},
           {"{time: 1, command: set_wind_schedule, regime: constant, segments: [{}]}",
            "must be timeline or rose"},
           {"{time: 1, command: set_wind_schedule, regime: rose, start_time: 4, segments: [{}]}",
            "start_time: is not a key"},
           {"{command: edit_terrain}", "run.timeline.0.time: is missing"},
           {"{time: 1, every: -1, command: edit_terrain}", "run.timeline.0.every: -1 is not a time"},
           {"{time: 1, command: edit_terrain, radius: 3, radius: 5}",
            "run.timeline.0.radius: is given twice"},
           {"{time: 1, every: 1.0e-300, command: edit_terrain}",
            "run.timeline.0.every: 1.0e-300 is too often"},
           {"{time: 1, until: 5, command: edit_terrain}", "run.timeline.0.until: is given without 'every'"},
           {"{time: 9, every: 2, until: 5, command: edit_terrain}", "run.timeline.0.until: is earlier"}})
    EXPECT_NE(fault_of(entry).find(part), std::string::npos) << entry << ":\n" << fault_of(entry);
}

TEST(Scripts, AddToTheTimelineInOrderOfTime) {
  const test::TemporaryFolder folder;
  Scenario scenario = test::parsed(world + "run: {timeline: [{time: 4, set: {saltation.lift: 0.5}}]}\n");
  add_script(scenario, folder.write("script.yaml", events));
  ASSERT_EQ(scenario.timeline.size(), 8u);
  EXPECT_TRUE(std::is_sorted(scenario.timeline.begin(), scenario.timeline.end(),
                             [](const auto& a, const auto& b) { return a.time < b.time; }));
  const auto exec = make_exec("cpu", 1);
  const auto scripted = test::simulate(*exec, dump_scenario(scenario)),
             timed = test::simulate(*exec, world + as_timeline(events));
  test::run(*timed, 3);
  test::run(*scripted, 3);
  EXPECT_EQ(scripted->state().hash(), timed->state().hash());
}

TEST(Scripts, ThatAreNoneAreRefusedByFileAndEntry) {
  const test::TemporaryFolder folder;
  const auto fault_of = [&](const std::string& text) -> std::string {
    Scenario scenario = test::parsed(world);
    try {
      add_script(scenario, folder.write("script.yaml", text));
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  };
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"{time: 1}", "script.yaml: is not a list"},
           {"- {time: 1, set: {rain.rat: 0}}", "script.yaml: timeline.0.set"},
           {"- {time: 3, set: {rain.rate: 0}}\n- {time: 1, set: {rain.rate: 0}}",
            "timeline.1.time: is earlier"},
           {"- {time: [}", "script.yaml: line 1"}})
    EXPECT_NE(fault_of(text).find(part), std::string::npos) << text << ":\n" << fault_of(text);
  Scenario scenario;
  EXPECT_THROW(add_script(scenario, folder.path("missing.yaml")), ConfigError);
}

}  // namespace
}  // namespace desert_sim

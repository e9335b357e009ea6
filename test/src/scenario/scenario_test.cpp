// The scenario loader: each kind of fault is named with key, value and range, all of them at once.

#include <yaml-cpp/yaml.h>

#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// The message with which the text is refused; empty if it is not.
std::string refusal(const std::string& yaml) {
  try {
    test::scenario_of(yaml);
  } catch (const ConfigError& e) {
    return e.what();
  }
  ADD_FAILURE() << "was accepted: " << yaml;
  return "";
}

void expect_refused(const std::string& yaml, const std::vector<std::string>& naming) {
  const std::string reason = refusal(yaml);
  for (const std::string& text : naming)
    EXPECT_NE(reason.find(text), std::string::npos) << yaml << "\n-> " << reason << "\nlacks " << text;
}

TEST(Loader, AcceptsTheEmptyScenarioWithDefaults) {
  const Scenario s = test::scenario_of("{}");
  EXPECT_EQ(s.grid.width, 256);
  EXPECT_EQ(s.grid.height, 256);
  EXPECT_EQ(s.grid.cell_size, 1);
  EXPECT_EQ(s.wind.radii.count, 2);
  EXPECT_EQ(s.run.steps, 1000);
}

TEST(Loader, NamesUnknownKeysAndWhatIsKnown) {
  expect_refused("wind_speed: 3", {"wind_speed: unknown key", "did you mean 'wind.speed'?"});
  expect_refused("time_step: 3", {"time_step: unknown key", "did you mean run.time_step?"});
  expect_refused("lift: 3", {"lift: unknown key", "did you mean saltation.lift?"});
  expect_refused("gird: {width: 3}", {"test", "gird", "unknown", "grid", "saltation"});
  expect_refused("grid: {widht: 3}", {"grid.widht", "unknown", "width"});
  expect_refused("wind: {sped: 3}", {"wind.sped", "speed"});
  expect_refused("terrain: [uniform: {layr: sand}]", {"terrain.0.uniform.layr", "layer"});
  expect_refused("terrain: [unifrom: {layer: sand}]", {"terrain.0", "unifrom", "uniform"});
  expect_refused("wind: {features: [{kind: vortex, strength: 2}]}", {"wind.features.0.strength"});
  expect_refused("wind: {features: [{begin: 5, end: 5}]}", {"wind.features.0.end", "above `begin`, or 0"});
  const auto refuse_path = [](const std::string& feature, const std::vector<std::string>& parts) {
    expect_refused("wind: {features: [{}, {" + feature + "}]}", parts);
  };
  refuse_path("path: 3", {"wind.features.1.path", "a list is expected"});
  refuse_path("path: [{time: 1, x: 2}]", {"wind.features.1.path: 1 points", "2 to 256"});
  refuse_path("path: [{time: 1}, {time: 2, z: 3}]", {"wind.features.1.path.1.z", "unknown key"});
  refuse_path("path: [{time: 1}, {time: 1}]", {"path.1.time: 1 s is not after the 1 s of the point before"});
  refuse_path("path: [{time: 1}, {time: 2, x: 2e9}]", {"path.1.x", "[-1e+09, 1e+09] m"});
  const std::string both = "beside `path`, which says where the feature is (allowed: one of both)";
  for (const std::string key : {"x", "y", "velocity_x", "velocity_y"})
    refuse_path(key + ": 1, path: [{time: 1}, {time: 2}]", {"wind.features.1." + key + ": is given " + both});
}

TEST(Loader, NamesTextWhereANumberIsExpected) {
  expect_refused("grid: {width: wide}", {"grid.width", "wide", "[1, 65536]"});
  expect_refused("grid: {width: \"64\"}", {"grid.width", "64", "number"});
  expect_refused("wind: {speed: 5 m/s}", {"wind.speed", "5 m/s"});
  expect_refused("wind: {speed: '5'}", {"wind.speed"});
  expect_refused("wind: {speed: }", {"wind.speed"});
  expect_refused("wind: {speed: [5]}", {"wind.speed", "list"});
  expect_refused("wind: {speed: {v: 5}}", {"wind.speed", "map"});
}

TEST(Loader, ReadsTimesWithUnits) {
  const auto step = [](const std::string& time) {
    return static_cast<double>(test::scenario_of("run: {time_step: " + time + "}").run.time_step);
  };
  EXPECT_FLOAT_EQ(step("500 ms"), 0.5);
  EXPECT_FLOAT_EQ(step("2s"), 2);
  EXPECT_FLOAT_EQ(step("0.25 min"), 15);
  EXPECT_FLOAT_EQ(step("'1e-2 h'"), 36);
  EXPECT_FLOAT_EQ(step("7"), 7);
  EXPECT_EQ(test::scenario_of("run: {duration: 24 a}").run.duration, 24 * 365.25 * 86400);
  EXPECT_EQ(test::scenario_of("run: {duration: 2 d}").run.duration, 172800);
  const std::string timeline = "run: {timeline: [{time: 1 h, ramp: 1 min, set: {wind.hold_time: 2 h}}]}";
  EXPECT_EQ(test::scenario_of(timeline).timeline.at(0).time, 3600);
  EXPECT_EQ(test::scenario_of(timeline).timeline.at(0).ramp, 60);
}

TEST(Loader, NamesTimesThatAreNone) {
  for (const char* time : {"5 weeks", "1 h 5", "h", "1 H", "5 m"})
    expect_refused("run: {time_step: " + std::string(time) + "}",
                   {"run.time_step", time, "not a time", "[0.0001, ", "ms, s, min, h, d, a"});
  expect_refused("run: {time_step: 1 a}", {"run.time_step", ": 1 a is not in [0.0001, "});
  expect_refused("wind: {speed: 5 s}", {"wind.speed", "5 s", "not a number"});
  expect_refused("run: {timeline: [{time: 1 week, set: {wind.speed: 5}}]}", {"run.timeline.0.time", "min"});
}

TEST(Loader, NamesNumbersThatAreNoneOrInfinite) {
  for (const char* number : {".nan", ".NaN", "nan", ".inf", "-.inf", "inf", "1e999"})
    expect_refused("saltation: {lift: " + std::string(number) + "}", {"saltation.lift", number, "[0, 10]"});
  expect_refused("terrain: [uniform: {value: .nan}]", {"terrain.0.uniform.value"});
  expect_refused("wind: {radii: [.nan, 50]}", {"wind.radii[0]"});
}

TEST(Loader, NamesNumbersOutOfTheirRange) {
  expect_refused("grid: {width: -64}", {"grid.width", "-64", "[1, 65536]"});
  expect_refused("grid: {width: 0}", {"grid.width", ": 0"});
  expect_refused("grid: {height: 100000}", {"grid.height", "100000"});
  expect_refused("grid: {cell_size: 0}", {"grid.cell_size", ": 0", "[0.001, 10000] m"});
  expect_refused("grid: {cell_size: -1}", {"grid.cell_size", "-1"});
  expect_refused("run: {steps: -1}", {"run.steps", "-1"});
  expect_refused("run: {time_step: 0}", {"run.time_step"});
  expect_refused("wind: {speed: 101}", {"wind.speed", "101", "[0, 100]"});
  expect_refused("seed: -1", {"seed", "-1"});
  expect_refused("seed: 1e30", {"seed"});
  expect_refused("avalanching: {transfer: 2}", {"avalanching.transfer"});
}

TEST(Loader, NamesNumbersThatAreNotWhole) {
  expect_refused("grid: {width: 64.5}", {"grid.width", "64.5", "whole"});
  expect_refused("run: {steps: 1.5}", {"run.steps"});
  EXPECT_EQ(test::scenario_of("grid: {width: 64.0, height: 1e2}").grid.width, 64);
  EXPECT_EQ(test::scenario_of("grid: {width: 64.0, height: 1e2}").grid.height, 100);
}

TEST(Loader, NamesListsWhereMapsBelongAndTheOtherWayRound) {
  expect_refused("grid: [64, 64]", {"grid", "list"});
  expect_refused("grid: 64", {"grid", "64"});
  expect_refused("terrain: {uniform: {layer: sand}}", {"terrain", "map", "list"});
  expect_refused("terrain: sand", {"terrain", "sand"});
  expect_refused("terrain: [sand]", {"terrain.0"});
  expect_refused("terrain: [{uniform: {value: 1}, ramp: {value: 2}}]", {"terrain.0"});
  expect_refused("terrain: [uniform: [1]]", {"terrain.0.uniform"});
  expect_refused("wind: {radii: 50}", {"wind.radii", "list"});
  expect_refused("wind: {radii: []}", {"wind.radii"});
  expect_refused("wind: {radii: [1, 2, 3, 4, 5]}", {"wind.radii"});
  expect_refused("wind: {segments: {direction_deg: 1}}", {"wind.segments", "list"});
  expect_refused("wind: {segments: [5]}", {"wind.segments.0"});
  expect_refused("- 1\n- 2\n", {"top level"});
  expect_refused("5", {"top level"});
}

TEST(Loader, NamesChoicesAndSwitches) {
  expect_refused("grid: {boundary: closed}", {"grid.boundary", "closed", "periodic, open"});
  expect_refused("reptation: {method: sliding}", {"reptation.method", "adaptive_repose", "steepest"});
  expect_refused("wind: {warping: maybe}", {"wind.warping", "maybe", "true or false"});
  expect_refused("wind: {warping: 1}", {"wind.warping"});
  expect_refused("wind: {warping: \"true\"}", {"wind.warping"});
  expect_refused("terrain: [uniform: {layer: sands}]", {"terrain.0.uniform.layer", "sands", "sand, water"});
  expect_refused("terrain: [uniform: {layer: elevation}]", {"terrain.0.uniform.layer", "elevation"});
}

TEST(Loader, NamesKeysThatAreGivenTwice) {
  expect_refused("grid: {width: 3, width: 4}", {"grid.width", "twice"});
  expect_refused("grid: {width: 3}\ngrid: {height: 4}\n", {"grid", "twice"});
}

TEST(Loader, NamesWhatDoesNotFitTogether) {
  expect_refused("wind: {radii: [50, 20, 10]}", {"wind.radii", "same length"});
  expect_refused("wind: {weights: [0, 0]}", {"wind.weights"});
  expect_refused("wind: {regime: rose}", {"wind.segments", "rose"});
  expect_refused("wind: {regime: timeline, segments: []}", {"wind.segments"});
  expect_refused("wind: {regime: timeline, segments: [{duration: 5, ramp: 6}]}", {"wind.segments.0.ramp"});
  expect_refused("wind: {regime: rose, segments: [{probability: 0}]}", {"wind.segments"});
  expect_refused("wind_shadow: {start_deg: 20, full_deg: 10}", {"wind_shadow.full_deg"});
  expect_refused("echo_dunes: {erosion_reach: 3, sticky_reach: 2}", {"echo_dunes.sticky_reach"});
  expect_refused("terrain: [discs: {radius_low: 5, radius_high: 4}]", {"terrain.0.discs.radius_high"});
  expect_refused("saltation: {influx: 1}\nrun: {time_step: 900}", {"saltation.influx", "900 m of sand"});
}

TEST(Loader, ListsAllFaultsAtOnceOneALine) {
  const std::string reason = refusal(
      "gird: {}\ngrid: {width: -3, cell_size: x, boundary: shut}\nterrain: [uniform: {layer: mud}, what: "
      "{}]\n"
      "wind: {speed: .nan, radii: [0]}\nsaltation: {lift: 99, blow: true}\n");
  const std::vector<std::string> keys{
      "gird",      "grid.width", "grid.cell_size", "grid.boundary",  "terrain.0.uniform.layer",
      "terrain.1", "wind.speed", "wind.radii[0]",  "saltation.lift", "saltation.blow"};
  for (const std::string& key : keys)
    EXPECT_NE(reason.find("test: " + key + ": "), std::string::npos) << key << " in\n" << reason;
  EXPECT_GE(std::count(reason.begin(), reason.end(), '\n') + 1, static_cast<long>(keys.size()));
}

TEST(Loader, ARasterThatIsMissingIsNamed) {
  Scenario s = test::scenario_of("grid: {width: 4, height: 4}\nterrain: [raster: {file: no/such.tif}]\n");
  CpuExec exec(1);
  try {
    Simulation simulation(exec, s, no_raster_loader);
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("no/such.tif"), std::string::npos);
  }
  expect_refused("grid: {from_raster: no/such.tif}", {"no/such.tif"});
  Scenario unnamed = test::scenario_of("grid: {width: 4, height: 4}\nterrain: [raster: {layer: sand}]\n");
  EXPECT_THROW(Simulation(exec, unnamed, no_raster_loader), ConfigError);
}

TEST(Loader, AStepThatLeavesALayersRangeIsNamedWithItsCell) {
  CpuExec exec(1);
  const auto built = [&](const std::string& steps) {
    try {
      test::simulate(exec, "grid: {width: 4, height: 4}\nterrain: " + steps);
    } catch (const ConfigError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string reason = built("[uniform: {layer: vegetation, value: 2}]");
  for (const char* text : {"terrain.0.uniform", "vegetation", "2.0", "(0, 0)"})
    EXPECT_NE(reason.find(text), std::string::npos) << reason;
  EXPECT_NE(built("[uniform: {layer: bedrock, value: 900000, merge: add}, uniform: {layer: bedrock, value: "
                  "900000, merge: add}]"),
            "");
  EXPECT_EQ(built("[uniform: {layer: sand, value: -5}]"), "") << "a negative depth is cut to 0";
}

TEST(LoadScenario, RefusesASecondDocument) {
  try {
    parse_scenario_text("grid: {width: 8}\n---\nwind: {speed: 9}\n", "two");
    ADD_FAILURE() << "the second one was left out";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("two: line 2: here begins a second"), std::string::npos) << e.what();
  }
  EXPECT_EQ(parse_scenario_text("---\ngrid: {width: 8}\n", "one").grid.width, 8) << "it may be marked";
}

TEST(LoadScenario, NamesFileAndLineOfBrokenYaml) {
  const test::TemporaryFolder folder;
  try {
    load_scenario(folder.write("broken.yaml", "grid: {width: 3}\nwind: {speed: 3\nrun: {}\n"));
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("broken.yaml: line "), std::string::npos) << e.what();
  }
  EXPECT_THROW(load_scenario(folder.path("missing.yaml")), ConfigError);
  EXPECT_THROW(load_scenario(folder.path(".")), ConfigError);
  EXPECT_EQ(load_scenario(folder.write("empty.yaml", "")).grid.boundary, Boundary::periodic);
  EXPECT_EQ(load_scenario(folder.write("my.name.yaml", "{}")).name, "my.name");
}

TEST(LoadScenario, AppliesSettingsToKeysThatExistAndThatDoNot) {
  const test::TemporaryFolder folder;
  const std::string path = folder.write(
      "a.yaml", "grid: {width: 8}\nterrain:\n  - uniform: {layer: sand, value: 1}\n  - cone: {height: 3}\n");
  const auto with = [&](const Settings& settings) { return load_scenario(path, settings); };
  EXPECT_EQ(with({"grid.width=12"}).grid.width, 12);
  EXPECT_EQ(with({"grid.width=12", "grid.width=13"}).grid.width, 13);
  EXPECT_EQ(with({"grid.height=9"}).grid.height, 9);
  EXPECT_EQ(with({"seed=77"}).seed, 77u);
  EXPECT_EQ(with({"wind.speed=3.5"}).wind_regime.speed, 3.5f);
  EXPECT_EQ(with({"wind.radii=[80, 20]"}).wind.radii.values[0], 80);
  EXPECT_EQ(std::get<UniformStep>(with({"terrain.0.uniform.value=2.5"}).terrain[0]).value, 2.5);
  EXPECT_EQ(std::get<ConeStep>(with({"terrain.1.cone.radius=4"}).terrain[1]).radius, 4);
  EXPECT_EQ(with({"terrain.2={ramp: {slope_x: 1}}"}).terrain.size(), 3u);
  EXPECT_EQ(with({"grid={width: 5, height: 6}"}).grid.height, 6);
  EXPECT_EQ(with({"terrain=[]"}).terrain.size(), 0u);
}

TEST(LoadScenario, RefusesSettingsByTheirText) {
  const test::TemporaryFolder folder;
  const std::string path =
      folder.write("a.yaml", "grid: {width: 8}\nterrain:\n  - uniform: {layer: sand, value: 1}\n");
  for (const char* setting :
       {"grid.width", "=3", "", "grid.width=wide", "grid.widht=3", "grid.width.x=3",
        "terrain.7.uniform.value=1", "terrain.first.uniform.value=1", "grid.width=", "grid.width={",
        "grid..width=3", ".=1", "grid.=1", "terrain.0.uniform.value=.nan", "terrain.99999999999999999999=1",
        "terrain.-1=3", "wind.radii.1=21"}) {
    try {
      load_scenario(path, {setting});
      ADD_FAILURE() << "was accepted: " << setting;
    } catch (const ConfigError& e) {
      EXPECT_FALSE(std::string(e.what()).empty());
    } catch (const std::exception& e) {
      ADD_FAILURE() << setting << ": not a ConfigError: " << e.what();
    }
  }
}

}  // namespace
}  // namespace desert_sim

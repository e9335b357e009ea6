// desert_run: outputs, resuming, replaying, interrupting.

#include <csignal>
#include <sstream>

#include "src/scenario/scenario.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/outputs.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

class Run : public test::DesertRun {};

TEST_F(Run, WritesASummaryWithAllKeys) {
  run_cpu({scenario_, "--out", path("out"), "--threads", "2"});
  const std::string text = summary("out");
  for (const char* key : {"steps",
                          "sim_time_s",
                          "width",
                          "height",
                          "cell_size_m",
                          "backend",
                          "device",
                          "threads",
                          "seed",
                          "ms_per_step",
                          "total",
                          "volume_m3",
                          "mass_residual",
                          "area_m2",
                          "plants",
                          "max_sand_slope_deg",
                          "avalanche_iterations_mean",
                          "state_hash",
                          "scenario_hash",
                          "peak_memory_bytes",
                          "bedrock",
                          "soil",
                          "sand",
                          "initial",
                          "final",
                          "in",
                          "out"})
    EXPECT_NE(text.find("\"" + std::string(key) + "\": "), std::string::npos) << key << " is not in\n"
                                                                              << text;
  EXPECT_EQ(json(text, "steps"), "12");
  EXPECT_EQ(json(text, "sim_time_s"), "12.0");
  EXPECT_EQ(json(text, "width"), "40");
  EXPECT_EQ(json(text, "height"), "24");
  EXPECT_EQ(json(text, "cell_size_m"), "2.0");
  EXPECT_EQ(json(text, "backend"), "\"cpu\"");
  EXPECT_EQ(json(text, "threads"), "2");
  EXPECT_EQ(json(text, "seed"), "1");
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  for (const char* bad : {"nan", "inf", "-nan"})
    EXPECT_EQ(text.find(": " + std::string(bad)), std::string::npos) << text;
}

TEST(Books, SayWhatIsMissing) {
  std::array<MaterialBalance, material_count> balance{};
  MaterialBalance& sand = balance[static_cast<std::size_t>(Material::sand)];
  sand.initial = 100;
  sand.in = 7;
  sand.out = 5;
  sand.final = 102;
  EXPECT_EQ(conservation_error(balance), "");
  sand.final = 99;
  balance[static_cast<std::size_t>(Material::water)].final = 2;
  EXPECT_EQ(conservation_error(balance), "-3 quanta of sand, 2 quanta of water");
}

TEST_F(Run, TimesEachProcess) {
  run_cpu({scenario_, "--out", path("out"), "--steps", "40"});
  for (const char* process : {"wind", "wind_shadow", "saltation", "avalanching"})
    EXPECT_NE(json(summary("out"), process), "") << process;
}

/// The first two runs differ in their number of threads only.
TEST_F(Run, TwiceGivesTheSameHashAndAnotherSeedAnother) {
  run_cpu({scenario_, "--out", path("a"), "--threads", "1"});
  run_cpu({scenario_, "--out", path("b"), "--threads", "2"});
  run_cpu({scenario_, "--out", path("c"), "--seed", "2"});
  run_cpu({scenario_, "--out", path("d"), "--set", "seed=2"});
  EXPECT_EQ(hash("a").size(), 18u);
  EXPECT_EQ(hash("a"), hash("b"));
  EXPECT_NE(hash("a"), hash("c"));
  EXPECT_EQ(hash("c"), hash("d"));
}

TEST_F(Run, ResumedGivesTheSameHashWithAndWithoutItsScenario) {
  run_cpu({scenario_, "--out", path("whole"), "--steps", "20"});
  run_cpu({scenario_, "--steps", "10", "--checkpoint", path("half.ck")});
  run_cpu({scenario_, "--out", path("a"), "--steps", "20", "--resume", path("half.ck")});
  run_cpu({"--out", path("b"), "--steps", "20", "--resume", path("half.ck")});
  EXPECT_EQ(json(summary("a"), "steps"), "20");
  EXPECT_EQ(hash("whole"), hash("a"));
  EXPECT_EQ(hash("whole"), hash("b"));
}

TEST_F(Run, TakesAsManyStepsAsItsDurationNeeds) {
  run_cpu({scenario_, "--out", path("a"), "--set", "run.time_step=0.7", "--duration", "7"});
  EXPECT_EQ(json(summary("a"), "steps"), "10");
  run_cpu({scenario_, "--out", path("b"), "--duration", "0.15 min", "--checkpoint", path("half.ck")});
  EXPECT_EQ(json(summary("b"), "steps"), "9");
  run_cpu({"--out", path("c"), "--duration", "11500 ms", "--resume", path("half.ck")});
  EXPECT_EQ(json(summary("c"), "steps"), "12");
  run_cpu({scenario_, "--out", path("d"), "--set", "run.duration=5 s"});
  EXPECT_EQ(json(summary("d"), "steps"), "5");
  run_cpu({scenario_, "--out", path("e"), "--set", "run.duration=5 s", "--steps", "3"});
  EXPECT_EQ(json(summary("e"), "steps"), "3");
}

TEST_F(Run, RefusesDurationsThatAreNone) {
  for (const char* duration : {"5 weeks", "-1", "nan", "1e30 a"}) {
    const auto r = run({scenario_, "--duration", duration});
    EXPECT_EQ(r.status, 2) << duration;
    EXPECT_NE(r.err.find("--duration"), std::string::npos) << r.err;
  }
  EXPECT_EQ(run({scenario_, "--duration", "5", "--steps", "5"}).status, 2);
  const auto r =
      run({scenario_, "--duration", "5", "--set", "run.timeline=[{time: 1, set: {run.time_step: 2}}]"});
  EXPECT_EQ(r.status, 2);
  EXPECT_NE(r.err.find("run.time_step"), std::string::npos) << r.err;
}

TEST_F(Run, ResumedAtItsEndWritesOutputsAndMakesNoStep) {
  run_cpu({scenario_, "--steps", "10", "--checkpoint", path("half.ck"), "--out", path("a")});
  run_cpu({"--out", path("b"), "--steps", "10", "--resume", path("half.ck")});
  EXPECT_EQ(json(summary("b"), "steps"), "10");
  EXPECT_EQ(hash("a"), hash("b"));
}

TEST_F(Run, EveryWritesAFolderEachTime) {
  run_cpu({scenario_, "--out", path("out"), "--steps", "10", "--every", "4"});
  for (const char* step : {"step_00000004", "step_00000008"}) {
    EXPECT_TRUE(std::filesystem::exists(path("out") + "/" + step + "/summary.json")) << step;
    EXPECT_EQ(json(test::file_bytes(path("out") + "/" + step + "/summary.json"), "steps"),
              std::to_string(std::stoi(step + 5)));
  }
  EXPECT_FALSE(std::filesystem::exists(path("out") + "/step_00000010"));
  EXPECT_EQ(json(summary("out"), "steps"), "10");
  run_cpu({scenario_, "--out", path("plain"), "--steps", "10"});
  EXPECT_EQ(hash("out"), hash("plain")) << "looking changes nothing";
}

TEST_F(Run, OutCreatesMissingParentFoldersAndAcceptsAnExistingFolder) {
  for (int n = 0; n < 2; ++n) {
    run_cpu({scenario_, "--steps", "1", "--out", path("a/b/c")});
    EXPECT_EQ(json(summary("a/b/c"), "steps"), "1");
  }
}

TEST_F(Run, CheckpointEveryLeavesTheLast) {
  run_cpu({scenario_, "--steps", "7", "--checkpoint", path("a.ck"), "--checkpoint-every", "3"});
  run_cpu({"--resume", path("a.ck"), "--steps", "7", "--out", path("out")});
  EXPECT_EQ(json(summary("out"), "steps"), "7");
}

TEST_F(Run, ReplaysAJournalToTheSameHash) {
  std::string live;
  {
    Scenario scenario = load_scenario(scenario_);
    Session session(scenario, no_raster_loader, "cpu", 1, path("j"));
    for (int n = 0; n < 9; ++n) {
      if (n == 3) session.apply(command::SetWind{90, 9, 2});
      if (n == 6) {
        command::EditTerrain edit;
        edit.x = 1030;
        edit.y = -280;
        edit.radius = 9;
        edit.value = 4;
        session.apply(edit);
      }
      session.step();
    }
    char text[32];
    std::snprintf(text, sizeof text, "\"%016llx\"",
                  static_cast<unsigned long long>(session.simulation().state().hash()));
    live = text;
  }
  run_cpu({scenario_, "--replay", path("j"), "--out", path("out")});
  EXPECT_EQ(hash("out"), live);
  const test::ProgramRun other = run({scenario_, "--seed", "5", "--replay", path("j"), "--backend", "cpu"});
  EXPECT_EQ(other.status, 2) << "a journal of another scenario";
}

TEST_F(Run, PrintsTheSummaryWhereThereIsNoFolder) {
  const test::ProgramRun r = run({scenario_, "--backend", "cpu", "--steps", "2"});
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(json(r.out, "steps"), "2");
  EXPECT_NE(r.err.find("backend: cpu"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("step 2 of 2"), std::string::npos) << r.err;
}

TEST_F(Run, QuietSaysNothing) {
  const test::ProgramRun r = run_cpu({scenario_, "--steps", "2"});
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(r.err, "");
}

TEST_F(Run, SaysOnceThatDeepWaterNeedsMoreSubsteps) {
  const test::ProgramRun r =
      run({scenario_, "--backend", "cpu", "--steps", "3", "--set", "water.sea=everywhere", "--set",
           "water.enabled=true", "--set", "water.sea_level=30", "--set", "water.most_substeps=1"});
  EXPECT_EQ(r.status, 0) << r.err;
  const std::string said = "warning: step 1: virtual_pipes: water ";
  EXPECT_NE(r.err.find(said), std::string::npos) << r.err;
  EXPECT_EQ(r.err.find("water.most_substeps allows 1"), r.err.rfind("water.most_substeps allows 1")) << r.err;
}

TEST_F(Run, AutoSaysWhichBackendAndWhy) {
  const test::ProgramRun r = run({scenario_, "--steps", "1"});
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_NE(r.err.find("because"), std::string::npos) << r.err;
}

TEST_F(Run, Describes) {
  const test::ProgramRun described = run({"--describe"});
  EXPECT_EQ(described.status, 0);
  EXPECT_EQ(described.out, describe_parameters());
}

TEST_F(Run, HelpFitsAScreenAndHasTheRestByTopic) {
  const auto expect_options = [](const test::ProgramRun& helped, const std::vector<const char*>& options) {
    EXPECT_EQ(helped.status, 0) << helped.err;
    for (const char* option : options)
      EXPECT_NE(helped.out.find(std::string(option) + " "), std::string::npos) << option << " in\n"
                                                                               << helped.out;
  };
  const test::ProgramRun helped = run({"--help"});
  expect_options(helped, {"--steps", "--set", "--out", "--film", "--resume", "--help output"});
  EXPECT_LE(std::count(helped.out.begin(), helped.out.end(), '\n'), 40);
  std::istringstream lines(helped.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
  expect_options(run({"--help", "run"}), {"--steps", "--threads", "--backend", "--seed", "--quiet"});
  expect_options(run({"--help", "output"}), {"--out", "--every", "--format", "--probe", "--export"});
  expect_options(run({"--help", "film"}), {"--film", "--film-every", "--view", "--plot"});
  expect_options(run({"--help", "resume"}), {"--checkpoint", "--checkpoint-every", "--resume", "--replay"});
  expect_options(run({"--help", "describe"}), {"--describe", "--describe-view", "--pipeline", "--migrate"});
  expect_options(run({"--help", "certify"}), {"--certify", "--only", "--jobs", "--table", "--record"});
  expect_options(run({"--help", "all"}), {"--steps", "--out", "--film", "--checkpoint", "--describe"});
  const test::ProgramRun unknown = run({"--help", "flim"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_EQ(unknown.err,
            "desert_run: --help flim: there is no such topic, only run, output, film, resume, describe, "
            "certify, all; did you mean 'film'?\n");
}

TEST_F(Run, PlotsARunOverTimeOrSaysWhyNot) {
  const auto has = [](const std::string& what) {
    return test::run_program("/usr/bin/env", {"python3", "-c", what}).status == 0;
  };
  const test::ProgramRun r = run({scenario_, "--backend", "cpu", "--steps", "6", "--out", path("o"),
                                  "--every", "2", "--plot", path("plot.png"), "--quiet"});
  if (has("import matplotlib")) {
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(test::file_bytes(path("plot.png")).substr(1, 3), "PNG");
  } else {
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find(has("") ? "matplotlib" : "python3"), std::string::npos) << r.err;
  }
  const test::ProgramRun alone = run({scenario_, "--plot", path("plot.png")});
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.err.find("--plot requires --out"), std::string::npos) << alone.err;
}

/// A run that does not end by itself, and saves a checkpoint after each step.
class EndlessRun : public Run {
 protected:
  void SetUp() override {
    Run::SetUp();
    if (HasFatalFailure()) return;
    arguments_ = {scenario_, "--backend", "cpu",          "--steps",    "100000000",
                  "--out",   path("out"), "--checkpoint", path("a.ck"), "--checkpoint-every",
                  "1"};
  }
  /// It has made a step.
  bool stepped() const { return std::filesystem::exists(path("a.ck")); }
  /// It has made so many steps since this was called for the first time.
  std::function<bool(const std::string&)> steps_on(int steps) const {
    return [this, left = steps](const std::string&) mutable {
      if (stepped() && left > 0) {
        std::filesystem::remove(path("a.ck"));
        --left;
      }
      return left == 0;
    };
  }

  std::vector<std::string> arguments_;
  const test::Signal hang_up_{SIGHUP, [this](const std::string&) { return stepped(); }};
};

TEST_F(EndlessRun, InterruptedFinishesItsStepWritesOutputsAndExits130) {
  const test::ProgramRun r = run(arguments_, {{SIGINT, [this](const std::string&) { return stepped(); }}});
  EXPECT_EQ(r.status, 130) << r.err;
  const std::string text = summary("out");
  EXPECT_NE(text, "");
  EXPECT_GT(std::stoll(json(text, "steps")), 0);
  EXPECT_LT(std::stoll(json(text, "steps")), 100000000);
  run_cpu({"--resume", path("a.ck"), "--steps", json(text, "steps"), "--out", path("again")});
  EXPECT_EQ(hash("again"), hash("out"));
}

TEST_F(EndlessRun, EndsAtTheLossOfItsTerminalAsAfterCtrlC) {
  const test::ProgramRun r = run(arguments_, {hang_up_});
  EXPECT_EQ(r.status, 130) << r.err;
  EXPECT_GT(std::stoll("0" + json(summary("out"), "steps")), 0);
}

/// nohup ignores the signal.
TEST_F(EndlessRun, GoesOnUnderNohupUntilItIsKilled) {
  std::vector<std::string> nohup = {"-c", "trap '' HUP; exec \"$@\"", "sh", program_};
  nohup.insert(nohup.end(), arguments_.begin(), arguments_.end());
  EXPECT_EQ(test::run_program("/bin/sh", nohup, {hang_up_, {SIGKILL, steps_on(10)}}).status, 128 + SIGKILL);
}

TEST_F(Run, WithAStandardOutputThatIsFullFails) {
  for (const char* option : {"--describe", "--help", "--pipeline", "--steps=1"}) {
    const test::ProgramRun r = test::run_program(
        "/bin/sh", {"-c", "exec \"$0\" \"$@\" > /dev/full", program_, scenario_, "--backend", "cpu", option});
    EXPECT_EQ(r.status, 3) << option << "\n" << r.err;
    EXPECT_NE(r.err.find("the standard output cannot be written"), std::string::npos) << r.err;
  }
}

TEST_F(Run, ResumedTakesSettingsWithAndWithoutItsScenario) {
  run_cpu({scenario_, "--steps", "4", "--checkpoint", path("a.ck")});
  run_cpu({"--resume", path("a.ck"), "--steps", "8", "--out", path("same")});
  run_cpu({"--resume", path("a.ck"), "--steps", "8", "--set", "saltation.lift=0.3", "--out", path("a")});
  run_cpu({scenario_, "--resume", path("a.ck"), "--steps", "8", "--set", "saltation.lift=0.3", "--out",
           path("b")});
  Session session(load_scenario(scenario_), no_raster_loader, "cpu", 1);
  session.apply(command::LoadCheckpoint{path("a.ck"), 0});
  session.apply(command::SetParameters{{"saltation.lift=0.3"}});
  for (int n = 0; n < 4; ++n) session.step();
  char text[32];
  std::snprintf(text, sizeof text, "\"%016llx\"",
                static_cast<unsigned long long>(session.simulation().state().hash()));
  EXPECT_EQ(hash("a"), text);
  EXPECT_EQ(hash("b"), text);
  EXPECT_NE(hash("same"), text);
}

/// GCC's OpenMP says how often a waiting thread looks before it sleeps; a program that executes itself anew
/// says it twice.
TEST_F(Run, LetsThreadsSpinShortlyUnlessTheUserHasChosen) {
  const auto spins = [&](const std::vector<std::string>& environment) {
    std::vector<std::string> arguments = {"-u", "OMP_WAIT_POLICY", "-u", "GOMP_SPINCOUNT",
                                          "OMP_DISPLAY_ENV=VERBOSE"};
    arguments.insert(arguments.end(), environment.begin(), environment.end());
    arguments.insert(arguments.end(), {program_, "--help"});
    const test::ProgramRun r = test::run_program("/usr/bin/env", arguments);
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_NE(r.out.find("desert_run [OPTIONS]"), std::string::npos) << "the arguments are the same";
    const std::string key = "GOMP_SPINCOUNT = '";
    const std::size_t at = r.err.rfind(key);
    return at == std::string::npos
               ? r.err
               : r.err.substr(at + key.size(), r.err.find('\'', at + key.size()) - at - key.size());
  };
  EXPECT_EQ(spins({}), "5000");
  EXPECT_EQ(spins({"OMP_WAIT_POLICY=passive"}), "0");
  EXPECT_GT(std::stod(spins({"OMP_WAIT_POLICY=active"})), 1e6);
  EXPECT_EQ(spins({"GOMP_SPINCOUNT=5"}), "5");
}

/// The test is a shell's, which waits for the first step: the program has executed itself anew by then.
TEST_F(EndlessRun, KeepsTheNameOfItsProcess) {
  std::vector<std::string> named = {"-c",
                                    "unset OMP_WAIT_POLICY GOMP_SPINCOUNT; file=$1; shift; \"$@\" & "
                                    "while kill -0 $! && ! test -e \"$file\"; do sleep 0.01; done; "
                                    "cat /proc/$!/comm; kill -KILL $!",
                                    "sh", path("a.ck"), program_};
  named.insert(named.end(), arguments_.begin(), arguments_.end());
  named.push_back("--quiet");
  const test::ProgramRun r = test::run_program("/bin/sh", named);
  EXPECT_EQ(r.out, std::filesystem::path(program_).filename().string() + "\n") << r.err;
}

TEST_F(Run, TakesInstalledScenariosByName) {
  const std::string in_path = "ROS_PACKAGE_PATH=" DESERT_SOURCE_DIR, nowhere = "ROS_PACKAGE_PATH=";
  const auto named = [this](const std::string& program, const std::string& packages,
                            const std::string& name) {
    return test::run_program(
        "/usr/bin/env",
        {"-C", path("."), packages, program, name, "--steps", "1", "--set", "grid.width=32", "--set",
         "grid.height=24", "--backend", "cpu", "--threads", "1", "--quiet", "--out", path("named")});
  };
  run_cpu({DESERT_SOURCE_DIR "/config/scenarios/barchan.yaml", "--steps", "1", "--set", "grid.width=32",
           "--set", "grid.height=24", "--out", path("whole")});
  EXPECT_EQ(named(program_, in_path, "barchan").status, 0);
  EXPECT_EQ(hash("named"), hash("whole"));

  const test::ProgramRun unknown = named(program_, in_path, "barchans");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_NE(unknown.err.find("no scenario 'barchans'"), std::string::npos) << unknown.err;
  EXPECT_NE(unknown.err.find("beach, "), std::string::npos) << unknown.err;
  const test::ProgramRun lost = named(program_, nowhere, "barchan");
  EXPECT_EQ(lost.status, 2);
  EXPECT_NE(lost.err.find("ROS_PACKAGE_PATH"), std::string::npos) << lost.err;

  // Where the program is installed, its scenarios are found beside it.
  std::filesystem::create_directories(path("lib/desert_sim"));
  std::filesystem::create_directories(path("share/desert_sim/config"));
  std::filesystem::create_directory_symlink(DESERT_SOURCE_DIR "/config/scenarios",
                                            path("share/desert_sim/config/scenarios"));
  std::filesystem::copy_file(program_, path("lib/desert_sim/desert_run"));
  EXPECT_EQ(named(path("lib/desert_sim/desert_run"), nowhere, "barchan").status, 0);
  EXPECT_EQ(hash("named"), hash("whole"));

  folder_.write("barchan", "grid: {width: 9}\nseed: 77\n");
  EXPECT_EQ(named(program_, in_path, "barchan").status, 0);
  EXPECT_EQ(json(summary("named"), "seed"), "77") << "a file of exactly this name comes first";
}

TEST_F(Run, TakesTheFolderOfASavedScenario) {
  for (const char* folder : {"kept", "barchan"}) {
    std::filesystem::create_directory(path(folder));
    folder_.write(std::string(folder) + "/scenario.yaml", "grid: {width: 9, height: 7}\nseed: 77\n");
  }
  run_cpu({path("kept"), "--steps", "1", "--out", path("out")});
  EXPECT_EQ(json(summary("out"), "seed"), "77");
  const auto named = [this](const std::string& name) {
    return test::run_program(
        "/usr/bin/env",
        {"-C", path("."), "ROS_PACKAGE_PATH=" DESERT_SOURCE_DIR, program_, name, "--steps", "0", "--backend",
         "cpu", "--quiet", "--out", path("out"), "--set", "grid.width=32", "--set", "grid.height=24"});
  };
  EXPECT_EQ(named("kept").status, 0);
  const test::ProgramRun two = named("barchan");
  EXPECT_EQ(two.status, 2);
  EXPECT_NE(two.err.find("'barchan/scenario.yaml' for the file"), std::string::npos) << two.err;
  EXPECT_EQ(named("barchan/scenario.yaml").status, 0);
  EXPECT_EQ(json(summary("out"), "seed"), "77");
  EXPECT_EQ(named("package://desert_sim/config/scenarios/barchan.yaml").status, 0);
  EXPECT_EQ(json(summary("out"), "seed"), "1");
  EXPECT_EQ(named("package://desert_sim/config/scenarios/barchans.yaml").status, 2);
}

TEST_F(Run, OfZeroStepsWritesTheStart) {
  run_cpu({scenario_, "--steps", "0", "--out", path("out")});
  EXPECT_EQ(json(summary("out"), "steps"), "0");
  EXPECT_EQ(std::stod(json(summary("out"), "sim_time_s")), 0);
}

}  // namespace
}  // namespace desert_sim

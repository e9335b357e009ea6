// desert_bench: scenes, results as JSON, checkpoints as starts; the comparison with a baseline and the
// picture.

#include <gtest/gtest.h>

#include <filesystem>

#include "kernels/avalanching/avalanching_parameters.hpp"
#include "src/tools/bench_scenes.hpp"
#include "src/tools/cost_model.hpp"
#include "src/tools/json.hpp"
#include "test/support/program.hpp"
#include "test/support/running.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

#ifndef DESERT_BENCH_BINARY
#define DESERT_BENCH_BINARY ""
#endif

class Bench : public ::testing::Test {
 protected:
  void SetUp() override {
    program_ = test::program_path("DESERT_BENCH_BINARY", DESERT_BENCH_BINARY);
    ASSERT_TRUE(std::filesystem::exists(program_)) << "no desert_bench at '" << program_ << "'";
    // Packed for another machine, the scripts lie beside the program.
    const std::string sources = DESERT_SOURCE_DIR "/test/bench";
    scripts_ = (std::filesystem::exists(sources) ? sources
                                                 : std::filesystem::path(program_).parent_path().string()) +
               "/";
  }
  test::ProgramRun run(const std::vector<std::string>& arguments) {
    return test::run_program(program_, arguments);
  }
  /// On the CPU, small and short; the result as it stands in the file.
  Json measure(std::vector<std::string> arguments, const std::string& name = "result.json") {
    arguments.insert(arguments.end(),
                     {"--backend", "cpu", "--threads", "1", "--steps", "10", "--json", path(name)});
    const test::ProgramRun r = run(arguments);
    EXPECT_EQ(r.status, 0) << r.err;
    return read_json(path(name));
  }
  test::ProgramRun refused(const std::vector<std::string>& arguments, const std::string& naming) {
    const test::ProgramRun r = run(arguments);
    EXPECT_EQ(r.status, 2) << r.err;
    EXPECT_NE(r.err.find(naming), std::string::npos) << r.err;
    return r;
  }
  static bool has_python() { return test::run_program("/bin/sh", {"-c", "command -v python3"}).status == 0; }
  test::ProgramRun compare(const std::vector<std::string>& arguments) {
    std::vector<std::string> all{"python3", scripts_ + "compare.py"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return test::run_program("/usr/bin/env", all);
  }
  std::string path(const std::string& name) const { return folder_.path(name); }
  /// `name` with every `from` replaced, as `to_name`.
  void rewrite(const std::string& name, const std::string& from, const std::string& to,
               const std::string& to_name) {
    std::string text = test::file_bytes(path(name));
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << "no '" << from << "' in\n" << text;
    folder_.write(to_name, text.replace(at, from.size(), to));
  }

  test::TemporaryFolder folder_;
  std::string program_, scripts_;
};

TEST_F(Bench, WritesEveryFigureOfARun) {
  const Json r = measure({"--scene", "B", "--size", "64", "--quality", "fast"});
  EXPECT_EQ(r["format"].get<std::string>(), "desert_bench 1");
  EXPECT_EQ(r["scene"].get<std::string>(), "B");
  EXPECT_EQ(r["width"].get<int>(), 64);
  EXPECT_EQ(r["height"].get<int>(), 64);
  EXPECT_EQ(r["cell_size_m"].get<double>(), 16);
  EXPECT_EQ(r["quality"].get<std::string>(), "fast");
  EXPECT_EQ(r["backend"].get<std::string>(), "cpu");
  EXPECT_EQ(r["threads"].get<int>(), 1);
  EXPECT_EQ(r["warm_up_steps"].get<int>(), 0);
  EXPECT_EQ(r["steps"].get<int>(), 10);
  EXPECT_GT(r["ms_per_step"].get<double>(), 0);
  EXPECT_EQ(r["ms_per_step_repeats"].size(), 9u);
  EXPECT_GT(r["copy_bytes_per_s"].get<double>(), 1e8);
  EXPECT_EQ(r["sand_lost_quanta"].get<long long>(), 0);
  for (const char* figure : {"share_over_1e-3", "share_over_1e-2", "mean_excess", "largest_excess"})
    EXPECT_GE(r["residual"][figure].get<double>(), 0) << figure;
  Scenario scenario;
  scenario.get<AvalanchingParameters>().quality = AvalancheQuality::fast;
  const auto model = cost_model(scenario, Grid{64, 64, 16.0f});
  double bytes = 0;
  for (const char* name : {"wind", "wind_shadow", "saltation", "avalanching"}) {
    ASSERT_TRUE(r["processes"].contains(name)) << name;
    const Json& p = r["processes"][name];
    const double ms = p["ms"].get<double>(), each = p["bytes_per_cell"].get<double>();
    EXPECT_EQ(each, min_bytes(model, name)) << name;
    EXPECT_NEAR(p["share_of_copy"].get<double>(),
                each * 64 * 64 / (ms * 1e-3) / r["copy_bytes_per_s"].get<double>(), 1e-9)
        << name;
    bytes += each;
  }
  EXPECT_NEAR(r["bytes_per_cell"].get<double>(), bytes, 1e-9);
  double held = 0;
  for (const auto& part : r["memory_bytes"]) held += part.get<double>();
  EXPECT_NEAR(r["memory_bytes_per_cell"].get<double>(), held / (64 * 64), 1e-9);
}

TEST_F(Bench, ScenesBeginWithTheirWarmUpOrACheckpoint) {
  EXPECT_EQ(default_warm_up_steps("mature"), 2000);
  EXPECT_EQ(default_warm_up_steps("edited"), 2000);
  EXPECT_EQ(default_warm_up_steps("A"), 0);
  const Json warm = measure(
      {"--scene", "mature", "--size", "128", "--warm-up", "15", "--save-start", path("a.ck")}, "warm.json");
  const Json again = measure({"--scene", "mature", "--start", path("a.ck")}, "again.json");
  for (const char* figure : {"share_over_1e-3", "share_over_1e-2", "mean_excess", "largest_excess"})
    EXPECT_EQ(warm["residual"][figure].get<double>(), again["residual"][figure].get<double>()) << figure;
  EXPECT_EQ(warm["warm_up_steps"].get<int>(), 15);
  EXPECT_EQ(again["warm_up_steps"].get<int>(), 15);
  EXPECT_EQ(again["scene"].get<std::string>(), "mature");
  const Json edited = measure({"--scene", "edited", "--start", path("a.ck"), "--quality", "fast", "--set",
                               "avalanching.enabled=false"},
                              "edited.json");
  EXPECT_EQ(edited["scene"].get<std::string>(), "edited");
  EXPECT_EQ(edited["quality"].get<std::string>(), "fast");
  EXPECT_EQ(edited["sand_lost_quanta"].get<long long>(), 0);
  EXPECT_LT(warm["residual"]["largest_excess"].get<double>(), 1);
  EXPECT_GT(edited["residual"]["largest_excess"].get<double>(), 3) << "50 m over cells of 8 m";

  refused({"--scene", "B", "--start", path("a.ck"), "--backend", "cpu"}, "mature");
  refused({"--scene", "mature", "--start", path("a.ck"), "--size", "64", "--backend", "cpu"}, "--size 64");
  refused({"--scene", "mature", "--start", path("a.ck"), "--warm-up", "3", "--backend", "cpu"}, "--warm-up");
}

TEST_F(Bench, TheEditOfASceneIsFiftyMetresOfSandInItsMiddle) {
  CpuExec exec(1);
  Simulation s(exec, bench_scenario("edited", 64, {}), no_raster_loader);
  const CommandResult result = s.apply(bench_edit(s.scenario().grid));
  EXPECT_NEAR(result.volume_m3, 50 * 3.14159 * 20 * 20, 0.4 * 50 * 3.14159 * 20 * 20)
      << "cells are 16 m wide";
  EXPECT_EQ(0.5 * (result.changed_cells.x0 + result.changed_cells.x1), 32);
  EXPECT_EQ(0.5 * (result.changed_cells.y0 + result.changed_cells.y1), 32);
}

TEST_F(Bench, RefusesWhatItDoesNotUnderstand) {
  refused({"--scene", "no_such.yaml"}, "no_such.yaml");
  refused({"--quality", "best", "--backend", "cpu"}, "best");
  refused({"result.json"}, "result.json");
  refused({"--steps", "5", "--backend", "cpu", "--size", "16"}, "--steps");
  refused({"--roofline", path("p.png")}, "--json");
  refused({"--scene", "A", "--size", "65536", "--backend", "cpu"}, "65536 x 65536");
}

/// A run of this size would take days.
TEST_F(Bench, RefusesOutputsThatCannotBeWrittenBeforeItMeasures) {
  std::filesystem::create_directories(path("folder"));
  for (const char* option : {"--json", "--save-start", "--roofline"})
    for (const std::string& file : {path("no/such/file"), path("folder")}) {
      SCOPED_TRACE(option);
      std::vector<std::string> arguments = {"--backend", "cpu",       "--size",  "2048", "--steps",
                                            "1000000",   "--warm-up", "1000000", option, file};
      if (option == std::string("--roofline")) arguments.insert(arguments.end(), {"--json", path("a.json")});
      refused(arguments, file);
    }
  EXPECT_FALSE(std::filesystem::exists(path("a.json")));
}

TEST_F(Bench, FailsIfItsStandardOutputIsFull) {
  const test::ProgramRun r =
      test::run_program("/bin/sh", {"-c", "exec \"$0\" --cost-model > /dev/full", program_});
  EXPECT_EQ(r.status, 3) << r.err;
  EXPECT_NE(r.err.find("the standard output cannot be written"), std::string::npos) << r.err;
}

TEST_F(Bench, CostModelIsTheOneOfThePage) {
  const test::ProgramRun r = run({"--cost-model"});
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_EQ(std::count(r.out.begin(), r.out.end(), '\n'), 6);
  if (!std::filesystem::exists(DESERT_SOURCE_DIR)) return;  // built elsewhere and carried here
  EXPECT_NE(test::file_bytes(DESERT_SOURCE_DIR "/doc/contributing/performance.md").find(r.out),
            std::string::npos)
      << "doc/contributing/performance.md should have these rows:\n"
      << r.out;
}

TEST_F(Bench, ComparisonFailsWhereAResultIsWorse) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  measure({"--size", "64"});
  const std::string base = path("base.json"), result = path("result.json");
  ASSERT_EQ(compare({"--write", "--commit", "1234abc", base, result}).status, 0);
  EXPECT_NE(test::file_bytes(base).find("1234abc"), std::string::npos);
  const test::ProgramRun same = compare({base, result});
  EXPECT_EQ(same.status, 0) << same.out << same.err;
  EXPECT_NE(same.out.find("1 compared, 0 failed, 0 without baseline"), std::string::npos) << same.out;

  const Json r = read_json(result);
  const auto field = [&](const std::string& name) {  // as it stands in the file
    const std::string text = test::file_bytes(result), key = "\"" + name + "\": ";
    const std::size_t at = text.find(key);
    return text.substr(at, text.find_first_of(",}\n", at) - at);
  };
  const auto fails = [&](const std::string& name, double value, const std::string& naming) {
    rewrite("result.json", field(name), "\"" + name + "\": " + std::to_string(value), "worse.json");
    const test::ProgramRun worse = compare({base, path("worse.json")});
    EXPECT_EQ(worse.status, 1) << worse.out << worse.err;
    EXPECT_NE(worse.out.find(naming), std::string::npos) << worse.out;
  };
  fails("ms_per_step", 1.2 * r["ms_per_step"].get<double>(), "a step takes 1.20 times");
  fails("largest_excess", r["residual"]["largest_excess"].get<double>() + 10, "largest_excess has grown");
  fails("sand_lost_quanta", -3, "3 quanta of sand were lost");
  fails("memory_bytes_per_cell", 1000, "memory has grown");

  // Half as fast on a machine that copies half as fast is no slower.
  rewrite("result.json", field("copy_bytes_per_s"),
          "\"copy_bytes_per_s\": " + std::to_string(0.5 * r["copy_bytes_per_s"].get<double>()), "half.json");
  rewrite("half.json", field("ms_per_step"),
          "\"ms_per_step\": " + std::to_string(2 * r["ms_per_step"].get<double>()), "other.json");
  EXPECT_NE(compare({base, path("other.json")}).out.find("1.00 of the baseline's time"), std::string::npos);
}

TEST_F(Bench, ComparisonListsWhatHasNoBaseline) {
  if (!has_python()) GTEST_SKIP() << "no python3";
  measure({"--size", "32"});
  const std::string base =
      folder_.write("base.json", "{\"format\": \"desert_bench baseline 1\", \"records\": []}");
  const test::ProgramRun r = compare({base, path("result.json")});
  EXPECT_EQ(r.status, 0) << r.err;
  EXPECT_NE(r.out.find("no baseline for A 32x32 good cpu"), std::string::npos) << r.out;
  EXPECT_EQ(compare({"--require-all", base, path("result.json")}).status, 1);
  EXPECT_EQ(compare({folder_.write("text.json", "nonsense"), path("result.json")}).status, 2);
  EXPECT_EQ(compare({base, base}).status, 2) << "a baseline is no result";
}

TEST_F(Bench, StoredBaselineHasRecordsOfScenesThatThereAre) {
  const Json baseline = read_json(scripts_ + "baseline.json");
  EXPECT_EQ(baseline["format"].get<std::string>(), "desert_bench baseline 1");
  ASSERT_TRUE(baseline["records"].is_array());
  for (const Json& r : baseline["records"]) {
    const std::string scene = r["scene"].get<std::string>();
    EXPECT_TRUE(is_bench_scene(scene) ||
                std::filesystem::exists(source_folder() + "/config/scenarios/" + scene + ".yaml"))
        << scene;
    EXPECT_EQ(r["sand_lost_quanta"].get<long long>(), 0);
    EXPECT_NE(r["commit"].get<std::string>(), "");
    EXPECT_NE(r["device"].get<std::string>(), "");
  }
}

TEST_F(Bench, DrawsAPictureOrSaysWhyNot) {
  measure({"--size", "32"});
  const test::ProgramRun r = run({"--roofline", path("picture.png"), path("result.json")});
  if (has_python() && test::run_program("/usr/bin/env", {"python3", "-c", "import matplotlib"}).status == 0) {
    EXPECT_EQ(r.status, 0) << r.err;
    EXPECT_EQ(test::file_bytes(path("picture.png")).substr(1, 3), "PNG");
  } else {
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find(has_python() ? "matplotlib" : "python3"), std::string::npos) << r.err;
  }
  EXPECT_EQ(run({"--roofline", path("picture.png"), path("none.json")}).status, 2);
}

}  // namespace
}  // namespace desert_sim

// Fits whose answer is known.

#include <cmath>

#include "kernels/sand/saltation.hpp"
#include "src/core/error.hpp"
#include "src/scenario/scenario.hpp"
#include "src/tools/calibration.hpp"
#include "test/support/refusal.hpp"
#include "test/support/run_fixture.hpp"

#ifndef DESERT_CALIBRATE_BINARY
#define DESERT_CALIBRATE_BINARY ""
#endif

namespace desert_sim {
namespace {

#if DESERT_WITH_NLOPT

TEST(Calibration, FindsTheLeastOfABowl) {
  const std::vector<FittedParameter> parameters{{"a", -3, 5}, {"b", 100, 300}};
  for (const char* global : {"direct_l", "crs2"})
    for (const char* local : {"sbplx", "bobyqa", "cobyla"}) {
      SearchPlan plan;
      plan.global = global;
      plan.local = local;
      plan.global_evaluations = 60;
      plan.local_evaluations = 200;
      int calls = 0;
      const Evaluation best = find_minimum(
          parameters, plan,
          [](const std::vector<double>& v) {
            return std::pow(v[0] - 1.25, 2) + std::pow((v[1] - 170) / 25, 2) + 0.5;
          },
          [&](const Evaluation&) { ++calls; });
      EXPECT_NEAR(best.values[0], 1.25, 0.1) << global << " " << local;
      EXPECT_NEAR(best.values[1], 170, 2.5) << global << " " << local;
      EXPECT_NEAR(best.error, 0.5, 0.02) << global << " " << local;
      EXPECT_LE(calls, 262);
    }
}

TEST(Calibration, PassesOnWhatTheErrorThrows) {
  SearchPlan plan;
  plan.global_evaluations = plan.local_evaluations = 5;
  const std::string said = test::refusal([&] {
    find_minimum(
        {{"a", 0, 1}}, plan, [](const std::vector<double>&) -> double { throw ConfigError("too hot"); },
        [](const Evaluation&) {});
  });
  EXPECT_EQ(said, "too hot");
  plan.global = "guess";
  EXPECT_NE(test::refusal([&] {
              find_minimum(
                  {{"a", 0, 1}}, plan, [](const std::vector<double>&) { return 0.0; },
                  [](const Evaluation&) {});
            }).find("direct_l, crs2"),
            std::string::npos);
}

#endif

TEST(Calibration, ReadsRanges) {
  const FittedParameter p = read_fitted_parameter("saltation.lift=0.2..2.5");
  EXPECT_EQ(p.path, "saltation.lift");
  EXPECT_EQ(p.lowest, 0.2);
  EXPECT_EQ(p.highest, 2.5);
  EXPECT_EQ(read_fitted_parameter("run.time_step=1 min..1 h").highest, 3600);
  for (const char* none : {"a", "a=1", "=1..2", "a=2..1", "a=1..1", "a=x..2", "a=1..2 m/s"})
    EXPECT_FALSE(test::refusal([&] { read_fitted_parameter(none); }).empty()) << none;
}

class Calibrating : public test::DesertRun {};

/// A heap that a wind series blows over, with a lift that the fit is not told.
TEST_F(Calibrating, FindsTheLiftOfASyntheticTerrain) {
  const std::string program = test::program_path("DESERT_CALIBRATE_BINARY", DESERT_CALIBRATE_BINARY);
  folder_.write("wind.csv", "time,speed,direction\n0,5,0\n8,6,40\n");
  const std::string heap = folder_.write(
      "heap.yaml",
      "grid: {width: 40, height: 32}\n"
      "terrain: [uniform: {layer: sand, value: 1}, cone: {layer: sand, shape: gaussian, x: 15, y: "
      "16, height: 4, radius: 5}]\n"
      "wind: {regime: series, series_file: wind.csv}\nrun: {duration: 15 s}\n");
  const std::string measured = path("measured") + "/elevation.tif";
  run_cpu({heap, "--out", path("measured"), "--set", "saltation.lift=0.43"});
  const auto r = test::run_program(
      program, {heap, "--after", measured, "--fit", "saltation.lift=0.1..1.5", "--global-evaluations", "9",
                "--local-evaluations", "16", "--out", path("fitted.yaml"), "--table", path("table.csv"),
                "--backend", "cpu", "--threads", "1", "--quiet"});
  if (!DESERT_WITH_NLOPT || !DESERT_WITH_IO) {
    EXPECT_EQ(r.status, 2);
    GTEST_SKIP() << "this build cannot calibrate";
  }
  ASSERT_EQ(r.status, 0) << r.err;
  const Scenario fitted = load_scenario(path("fitted.yaml"));
  EXPECT_NEAR(static_cast<double>(fitted.get<SaltationParameters>().lift), 0.43, 0.02);
  EXPECT_EQ(fitted.wind_regime.series_file, path("wind.csv"));
  const std::string table = test::file_bytes(path("table.csv"));
  EXPECT_EQ(table.substr(0, table.find('\n')), "evaluation,stage,saltation.lift,rms_m,best_rms_m");
  const auto lines = std::count(table.begin(), table.end(), '\n');
  EXPECT_GE(lines, 10);
  EXPECT_LE(lines, 26);
  EXPECT_NE(table.find(",local,"), std::string::npos);
}

TEST_F(Calibrating, RefusesWhatItCannotFit) {
  const std::string program = test::program_path("DESERT_CALIBRATE_BINARY", DESERT_CALIBRATE_BINARY);
  const auto refused = [&](std::vector<std::string> arguments, const std::string& part) {
    const auto r = test::run_program(program, arguments);
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find(part), std::string::npos) << r.err;
  };
  const std::string out = path("fitted.yaml");
  refused({scenario_}, "--after");
  refused({scenario_, "--after", "none.tif", "--fit", "saltation.lift=2..1", "--out", out}, "--fit");
  refused({scenario_, "--after", "none.tif", "--fit", "saltation.lift=1..2", "--out", out}, "none.tif");
  refused({scenario_, "--after", "none.tif", "--fit", "saltation.lit=1..2", "--out", out}, "saltation.lit");
  refused({scenario_, "--after", "none.tif", "--fit", "saltation.lift=1..20", "--out", out}, "");
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace desert_sim

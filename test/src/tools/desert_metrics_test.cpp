// desert_metrics on runs of desert_run, and the snapshots that it needs.

#include <cmath>

#include "src/tools/json.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

#ifndef DESERT_METRICS_BINARY
#define DESERT_METRICS_BINARY ""
#endif

class MetricsOf : public test::DesertRun {
 protected:
  void SetUp() override {
    if (!DESERT_WITH_IO) GTEST_SKIP() << "this build reads no rasters";
    test::DesertRun::SetUp();
    metrics_ = test::program_path("DESERT_METRICS_BINARY", DESERT_METRICS_BINARY);
    heap_ =
        folder_.write("heap.yaml",
                      "grid: {width: 80, height: 60, cell_size: 1, boundary: periodic}\n"
                      "terrain: [cone: {layer: sand, shape: gaussian, x: 25, y: 30, height: 4, radius: 12}]\n"
                      "wind: {speed: 5}\nsaltation: {lift: 0.05, flux: true}\nrun: {steps: 40}\n");
  }
  test::ProgramRun measure(std::vector<std::string> arguments) {
    return test::run_program(metrics_, arguments);
  }
  static std::vector<Json> snapshots(const std::string& text) {
    return Json::parse(text).at("snapshots").get<std::vector<Json>>();
  }
  static double number(const Json& snapshot, const char* key) { return snapshot.at(key).get<double>(); }

  std::string metrics_, heap_;
};

TEST_F(MetricsOf, AHeapThatTheWindMovesToTheEast) {
  run_cpu({heap_, "--out", path("a"), "--every", "10", "--format", "netcdf"});
  run_cpu({heap_, "--out", path("b"), "--every", "10"});
  const test::ProgramRun a = measure({path("a"), "--out", path("a.json")}), b = measure({path("b")});
  ASSERT_EQ(a.status, 0) << a.err;
  ASSERT_EQ(b.status, 0) << b.err;
  const auto from_netcdf = snapshots(test::file_bytes(path("a.json"))), from_rasters = snapshots(b.out);
  ASSERT_EQ(from_netcdf.size(), 5u);
  ASSERT_EQ(from_rasters.size(), 4u) << "rasters begin with the first snapshot";
  EXPECT_EQ(number(from_netcdf[0], "time_s"), 0);
  EXPECT_NEAR(number(from_netcdf[0], "deepest_sand_m"), 4, 0.05);
  EXPECT_GT(number(from_netcdf[0], "bare_share"), 0.1);
  EXPECT_TRUE(from_netcdf[0].at("flux_m2_s").is_null()) << from_netcdf[0];
  EXPECT_TRUE(from_netcdf[0].at("migration_speed_m_s").is_null()) << from_netcdf[0];
  for (std::size_t n = 1; n < 5; ++n) {
    EXPECT_EQ(number(from_netcdf[n], "time_s"), 10.0 * static_cast<double>(n));
    EXPECT_GT(number(from_netcdf[n], "migration_speed_m_s"), 0) << n;
    EXPECT_LT(std::abs(std::remainder(number(from_netcdf[n], "migration_direction_deg"), 360)), 10) << n;
    EXPECT_GT(number(from_netcdf[n], "flux_m2_s"), 0) << n;
    EXPECT_LT(number(from_netcdf[n], "bare_share"), 0.02) << n << ": the wind has strewn sand";
    EXPECT_TRUE(from_netcdf[n].at("highest_stack_slabs").is_null());
  }
  EXPECT_EQ(from_netcdf[4], from_rasters[3]);
}

TEST_F(MetricsOf, ASlabModelCountsStacksInSlabs) {
  const std::string slabs =
      folder_.write("slabs.yaml",
                    "grid: {width: 64, height: 64, cell_size: 1, boundary: periodic}\n"
                    "terrain: [uniform: {layer: sand, value: 1}]\nwind: {speed: 5}\nsand: {model: werner}\n"
                    "run: {time_step: 1 s, steps: 20}\n");
  run_cpu({slabs, "--out", path("s"), "--format", "netcdf"});
  const test::ProgramRun r = measure({path("s")});
  ASSERT_EQ(r.status, 0) << r.err;
  const auto s = snapshots(r.out);
  ASSERT_EQ(s.size(), 2u);
  EXPECT_NEAR(number(s[0], "highest_stack_slabs"), 3, 1e-3);
  const double highest = number(s[1], "highest_stack_slabs");
  EXPECT_GT(highest, 3.9);
  EXPECT_NEAR(highest, std::round(highest), 0.01);
  EXPECT_TRUE(s[1].at("flux_m2_s").is_null()) << "slab models count no flux";
}

TEST_F(MetricsOf, SnapshotsAreEvenAndEndWithTheRun) {
  run_cpu({heap_, "--out", path("a"), "--snapshots", "3", "--format", "netcdf"});
  const auto s = snapshots(measure({path("a")}).out);
  std::vector<double> times;
  for (const Json& snapshot : s) times.push_back(number(snapshot, "time_s"));
  EXPECT_EQ(times, (std::vector<double>{0, 14, 28, 40}));
  EXPECT_EQ(run({heap_, "--snapshots", "3"}).status, 2) << "without --out";
  EXPECT_EQ(run({heap_, "--snapshots", "3", "--every", "2", "--out", path("b")}).status, 2);
}

TEST_F(MetricsOf, WrongArgumentsAreRefused) {
  run_cpu({heap_, "--out", path("a"), "--steps", "1"});
  EXPECT_EQ(measure({path("a")}).status, 0);
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {path("none")},
                                                    {path("a"), "--layer", "water"},
                                                    {path("a"), "--slip-face", "0"},
                                                    {path("a"), "--sigma", "-1"},
                                                    {path("a"), "more"}}) {
    const test::ProgramRun r = measure(arguments);
    EXPECT_EQ(r.status, 2) << r.err;
    EXPECT_NE(r.err.find("desert_metrics: "), std::string::npos);
  }
}

}  // namespace
}  // namespace desert_sim

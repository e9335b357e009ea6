// Cross-sections and probes of desert_run.

#include "src/tools/measurements.hpp"

#include <cmath>
#include <sstream>

#include "test/support/refusal.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

GridParameters grid() {
  GridParameters g;
  g.width = 10;
  g.height = 6;
  g.cell_size = 2;
  g.origin_x = 100;
  g.origin_y = -4;
  return g;
}

Snapshot uniform_flux(float x, float y) {
  Snapshot s;
  s.width = 10;
  s.height = 6;
  s.cell_size = 2;
  s.origin_x = 100;
  s.origin_y = -4;
  s.layers[Layer::flux_x] = std::vector<float>(60, x);
  s.layers[Layer::flux_y] = std::vector<float>(60, y);
  return s;
}

TEST(CrossSections, AddUpWhatGoesToTheLeft) {
  CrossSection north("a=111,-3,111,5", grid()), slanted("b=101,-3,117,5", grid());
  for (int n = 0; n < 4; ++n) {
    north.add(uniform_flux(0.5f, 7), 10);
    slanted.add(uniform_flux(0.5f, 0.25f), 10);
  }
  EXPECT_NEAR(north.volume(), -0.5 * 8 * 40, 1e-9);
  EXPECT_NEAR(north.per_metre_and_year(), -0.5 * 365.25 * 86400, 1e-3);
  EXPECT_NEAR(slanted.volume(), 0, 1e-9) << "it goes along the line";
  EXPECT_NEAR(slanted.length(), std::hypot(16, 8), 1e-12);
}

/// Every cell counts by the length of the line in it.
TEST(CrossSections, WeighCellsByTheirLength) {
  Snapshot s = uniform_flux(0, 0);
  s.layers[Layer::flux_y][2 * 10 + 3] = 4;  // x 106 … 108, y 0 … 2
  CrossSection east("a=101,1.5,107.5,1.5", grid());
  east.add(s, 1);
  EXPECT_NEAR(east.volume(), 4 * 1.5, 1e-9);
}

TEST(CrossSections, AreRefusedWithAReason) {
  for (const char* text : {"a", "a=1,2,3", "=101,0,102,0", "a=101,0,102,0,5", "a=101,0,x,0", "a=101;0;102;0"})
    EXPECT_NE(test::refusal([&] { CrossSection(text, grid()); }).find("NAME=x1,y1,x2,y2"), std::string::npos);
  const std::string said = test::refusal([] { CrossSection("a=0,0,101,0", grid()); });
  EXPECT_NE(said.find("x in [100, 120] m, y in [-4, 8] m"), std::string::npos) << said;
  EXPECT_FALSE(test::refusal([] { CrossSection("a=101,0,101,0", grid()); }).empty());
}

class Measuring : public test::DesertRun {
 protected:
  void SetUp() override {
    DesertRun::SetUp();
    flat_ = folder_.write("flat.yaml",
                          "grid: {width: 12, height: 10, cell_size: 2, origin_x: 50}\n"
                          "terrain: [uniform: {layer: sand, value: 50}]\n"
                          "wind: {speed: 6, direction_deg: 0, warping: false, projection: false}\n");
  }
  /// A column of probes.csv.
  std::vector<double> column(const std::string& out, const std::string& name) const {
    std::istringstream in(test::file_bytes(path(out) + "/probes.csv"));
    std::string line, field;
    std::getline(in, line);
    std::istringstream names(line);
    int at = 0;
    while (std::getline(names, field, ',') && field != name) ++at;
    std::vector<double> values;
    while (std::getline(in, line)) {
      std::istringstream fields(line);
      for (int n = 0; n <= at; ++n) std::getline(fields, field, ',');
      values.push_back(std::stod(field));
    }
    return values;
  }
  std::string flat_;
};

TEST_F(Measuring, ACrossSectionHasWhatItsProbesHave) {
  run_cpu({flat_, "--steps", "20", "--out", path("out"), "--cross-section", "gate=60.5,2,60.5,16", "--probe",
           "60.5,9"});
  double through = 0;
  const std::vector<double> flux = column("out", "flux_x");
  ASSERT_EQ(flux.size(), 20u);
  for (double q : flux) through += q * 14;
  EXPECT_GT(through, 1000);
  EXPECT_NEAR(std::stod(json(summary("out"), "volume_to_the_left_m3")), -through, 1e-3 * through);
  EXPECT_NEAR(std::stod(json(summary("out"), "length_m")), 14, 1e-9);
  EXPECT_NEAR(std::stod(json(summary("out"), "m2_per_year")), -through / 14 / 20 * 365.25 * 86400,
              1e-3 * through / 14 / 20 * 365.25 * 86400);
  run_cpu({flat_, "--steps", "20", "--out", path("plain")});
  EXPECT_EQ(hash("out"), hash("plain")) << "measuring changes nothing";
}

TEST_F(Measuring, ProbesAreWrittenEverySoManySteps) {
  run_cpu({flat_, "--steps", "10", "--out", path("out"), "--probe", "60,9", "--probe", "50,0",
           "--probe-every", "4"});
  EXPECT_EQ(column("out", "step"), (std::vector<double>{4, 4, 8, 8}));
  EXPECT_EQ(column("out", "time"), (std::vector<double>{4, 4, 8, 8}));
  EXPECT_EQ(column("out", "x"), (std::vector<double>{60, 50, 60, 50}));
  EXPECT_EQ(column("out", "wind_above_speed"), (std::vector<double>{6, 6, 6, 6}));
  for (double elevation : column("out", "elevation")) EXPECT_NEAR(elevation, 50, 2);
}

TEST_F(Measuring, RefusesWhatItCannotMeasure) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& part) {
    arguments.insert(arguments.begin(), flat_);
    const auto r = run(arguments);
    EXPECT_EQ(r.status, 2);
    EXPECT_NE(r.err.find(part), std::string::npos) << r.err;
  };
  refused({"--probe", "60,9"}, "--out");
  refused({"--probe", "0,9", "--out", path("out")}, "x in [50, 74] m");
  refused({"--probe", "60", "--out", path("out")}, "x,y");
  refused({"--cross-section", "a=0,0,60,9"}, "--cross-section");
  refused({"--cross-section", "a=60,0,60,9", "--set", "saltation.enabled=false"}, "saltation.enabled");
  refused({"--probe-every", "3"}, "--probe");
}

}  // namespace
}  // namespace desert_sim

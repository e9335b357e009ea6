// Windows of the detailed surface that desert_run writes.

#include <cmath>

#include "src/io/raster.hpp"
#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

class MicroReliefWindows : public test::DesertRun {
 protected:
  void SetUp() override {
    DesertRun::SetUp();
    flat_ =
        folder_.write("flat.yaml",
                      "grid: {width: 20, height: 12, origin_x: 100, origin_y: -6, boundary: open}\n"
                      "terrain: [{uniform: {layer: bedrock, value: 1}}, {uniform: {layer: sand, value: 1}}]\n"
                      "wind: {speed: 10}\nsaltation: {enabled: false}\nrun: {steps: 2}\n");
  }
  void refused(const std::string& window, const std::string& reason) {
    const test::ProgramRun r =
        run({flat_, "--quiet", "--backend", "cpu", "--out", path("refused"), "--micro-relief", window});
    EXPECT_EQ(r.status, 2) << window;
    EXPECT_NE(r.err.find("--micro-relief " + window), std::string::npos) << r.err;
    EXPECT_NE(r.err.find(reason), std::string::npos) << r.err;
  }
  std::string flat_;
};

TEST_F(MicroReliefWindows, AreRastersOfThatPlaceAndResolution) {
  run_cpu({flat_, "--out", path("out"), "--micro-relief", "104,-3,112,3,resolution=0.05", "--micro-relief",
           "106,-2,107,1,resolution=0.15"});
  const Raster fine = read_raster(path("out") + "/micro_relief.tif"),
               other = read_raster(path("out") + "/micro_relief_2.tif");
  EXPECT_EQ(fine.width, 160);
  EXPECT_EQ(fine.height, 120);
  EXPECT_NEAR(fine.cell_size, 0.05, 1e-12);
  EXPECT_NEAR(fine.origin_x, 104, 1e-9);
  EXPECT_NEAR(fine.origin_y, -3, 1e-9);
  EXPECT_EQ(other.width, 7);
  EXPECT_EQ(other.height, 20);
  const auto [low, high] = std::minmax_element(fine.values.begin(), fine.values.end());
  const float height = 0.0467f * (0.013f + 0.02f * 9);
  EXPECT_NEAR((*high - *low) / height, 1, 0.1);
  EXPECT_NEAR(0.5 * (*high + *low), 2, 0.001);
  // Every third point of the fine one lies on a point of the other.
  for (std::size_t y = 0; y < 20; ++y)
    for (std::size_t x = 0; x < 6; ++x)
      EXPECT_EQ(other.values[y * 7 + x], fine.values[(20 + 3 * y + 1) * 160 + 40 + 3 * x + 1]);
}

TEST_F(MicroReliefWindows, DoNotChangeTheState) {
  run_cpu({flat_, "--out", path("with"), "--micro-relief", "104,-3,112,3"});
  run_cpu({flat_, "--out", path("without")});
  EXPECT_EQ(hash("with"), hash("without"));
  EXPECT_EQ(test::file_bytes(path("with") + "/elevation.tif"),
            test::file_bytes(path("without") + "/elevation.tif"));
}

TEST_F(MicroReliefWindows, AreRefusedWithAReason) {
  refused("104,-3,112", "x1,y1,x2,y2");
  refused("104,-3,112,3,step=2", "x1,y1,x2,y2");
  refused("104,-3,112,3,resolution=", "x1,y1,x2,y2");
  refused("104,-3,121,3", "x in [100, 120] m");
  refused("112,-3,104,3", "north-east");
  refused("104,-3,112,3,resolution=0", "[0.001, 1000] m");
  refused("104,-3,112,3,resolution=nan", "x1,y1,x2,y2");
  refused("101,-5,119,5,resolution=0.001", "at most");
  const test::ProgramRun r = run({flat_, "--micro-relief", "104,-3,112,3"});
  EXPECT_EQ(r.status, 2);
  EXPECT_NE(r.err.find("--out"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace desert_sim

// The steps of a scenario's terrain: shapes, merges, places, random ones.

#include "src/scenario/terrain_builder.hpp"

#include <cmath>

#include "test/support/world.hpp"

namespace desert_sim {
namespace {

struct Built {
  Scenario scenario;
  HostLayers layers;
  double at(Layer layer, int x, int y) const {
    const auto found = layers.find(layer);
    return found == layers.end() ? 0 : found->second[static_cast<std::size_t>(y) * scenario.grid.width + x];
  }
};

Built build(const std::string& steps,
            const std::string& grid = "width: 32, height: 20, cell_size: 0.5, origin_x: 10, origin_y: -4",
            const RasterLoader& loader = no_raster_loader) {
  Built b;
  b.scenario = test::scenario_of("grid: {" + grid + "}\nterrain: [" + steps + "]\n");
  b.layers = build_terrain(b.scenario, loader);
  return b;
}

TEST(TerrainSteps, UniformMerges) {
  const Built b = build(
      "uniform: {layer: sand, value: 2}, uniform: {layer: sand, value: 3, merge: add}, "
      "uniform: {layer: bedrock, value: -7}, uniform: {layer: bedrock, value: -9, merge: max}");
  EXPECT_EQ(b.at(Layer::sand, 5, 5), 5);
  EXPECT_EQ(b.at(Layer::bedrock, 31, 19), -7);
  EXPECT_EQ(b.layers.count(Layer::soil), 0u);
}

TEST(TerrainSteps, RampRisesPerMetreAboutTheGridsCentre) {
  const Built b = build("ramp: {value: 100, slope_x: 0.2, slope_y: -0.1}");
  EXPECT_NEAR(b.at(Layer::bedrock, 31, 10) - b.at(Layer::bedrock, 0, 10), 0.2 * 31 * 0.5, 1e-9);
  EXPECT_NEAR(b.at(Layer::bedrock, 3, 19) - b.at(Layer::bedrock, 3, 0), -0.1 * 19 * 0.5, 1e-9);
  EXPECT_NEAR(0.25 * (b.at(Layer::bedrock, 15, 9) + b.at(Layer::bedrock, 16, 9) +
                      b.at(Layer::bedrock, 15, 10) + b.at(Layer::bedrock, 16, 10)),
              100, 1e-9);
}

TEST(TerrainSteps, ConesStandWhereTheyAreSaidTo) {
  // Centre of cell (8, 6) in the terrain's frame.
  const std::string place = "x: 14.25, y: -0.75, radius: 3, height: 6";
  const Built cone = build("cone: {" + place + "}"), dome = build("cone: {shape: dome, " + place + "}"),
              hill = build("cone: {shape: gaussian, " + place + "}");
  for (int d = 0; d < 8; ++d) {
    const double r = 0.5 * d / 3;
    EXPECT_NEAR(cone.at(Layer::sand, 8 + d, 6), 6 * std::max(0.0, 1 - r), 1e-9);
    EXPECT_NEAR(dome.at(Layer::sand, 8, 6 + d), 6 * std::max(0.0, 1 - r * r), 1e-9);
    EXPECT_NEAR(hill.at(Layer::sand, 8 - d, 6), 6 * std::exp(-0.5 * r * r), 1e-9);
  }
}

TEST(TerrainSteps, RelativePlacesAreSharesOfTheGrid) {
  const Built b = build("cone: {relative: true, x: 0.25, y: 0.75, radius: 1, height: 1}");
  EXPECT_GT(b.at(Layer::sand, 8, 15), 0);
  EXPECT_GT(b.at(Layer::sand, 7, 14), 0);
  EXPECT_EQ(b.at(Layer::sand, 24, 5), 0);
}

TEST(TerrainSteps, ShapesWrapOnATorusAndNotOnASheet) {
  const std::string step = "column: {x: 10, y: -4, size_x: 4, size_y: 4, height: 3}";
  const Built torus = build(step),
              sheet = build(
                  step, "width: 32, height: 20, cell_size: 0.5, origin_x: 10, origin_y: -4, boundary: open");
  EXPECT_EQ(torus.at(Layer::sand, 31, 19), 3);
  EXPECT_EQ(sheet.at(Layer::sand, 31, 19), 0);
  EXPECT_EQ(sheet.at(Layer::sand, 0, 0), 3);
}

TEST(TerrainSteps, ColumnsHaveTheirSizeAndTurnCounterClockwise) {
  const Built box = build("column: {relative: true, x: 0.5, y: 0.5, size_x: 6, size_y: 2, height: 1}");
  double area = 0;
  for (double v : box.layers.at(Layer::sand)) area += v * 0.25;
  EXPECT_NEAR(area, 12, 1e-9);
  const Built cylinder =
      build("column: {shape: cylinder, relative: true, x: 0.5, y: 0.5, size_x: 8, size_y: 8, height: 1}");
  area = 0;
  for (double v : cylinder.layers.at(Layer::sand)) area += v * 0.25;
  EXPECT_NEAR(area, 3.14159265 * 16, 3);
  const Built turned =
      build("column: {relative: true, x: 0.5, y: 0.5, size_x: 8, size_y: 1, angle_deg: 45, height: 1}");
  EXPECT_EQ(turned.at(Layer::sand, 19, 13), 1) << "north-east";
  EXPECT_EQ(turned.at(Layer::sand, 19, 6), 0) << "south-east";
}

TEST(TerrainSteps, ObstaclesRaiseTheRockAndAreMarked) {
  const Built b = build(
      "uniform: {layer: bedrock, value: 5}, obstacle: {shape: box, relative: true, x: 0.5, y: 0.5, size_x: "
      "4, size_y: 4, height: 7}");
  EXPECT_EQ(b.at(Layer::bedrock, 16, 10), 12);
  EXPECT_EQ(b.at(Layer::obstacle, 16, 10), 1);
  EXPECT_EQ(b.at(Layer::bedrock, 2, 10), 5);
  EXPECT_EQ(b.at(Layer::obstacle, 2, 10), 0);
}

TEST(TerrainSteps, RipplesHaveTheirFlanks) {
  // Cells of 0.5 m: centres at 0.25, 0.75, ... of the wavelength 4 m, of which 3 m rise.
  const Built b = build("ripples: {wavelength: 4, height: 1.2, windward: 0.75, x: 10, y: -4}");
  for (int x = 0; x < 32; ++x) {
    const double at = std::fmod(0.5 * x + 0.25, 4.0);
    EXPECT_NEAR(b.at(Layer::sand, x, 7), 1.2 * (at < 3 ? at / 3 : 4 - at), 1e-9) << x;
  }
  const Built north = build("ripples: {wavelength: 4, height: 1, direction_deg: 90, x: 10, y: -2, count: 1}");
  for (int y = 0; y < 20; ++y) {
    const double at = 0.5 * y + 0.25 - 2;
    EXPECT_NEAR(north.at(Layer::sand, 3, y), at < 0 || at > 4 ? 0 : 1 - std::abs(at - 2) / 2, 1e-9) << y;
  }
}

TEST(TerrainSteps, DiscsCoverTheShareThatIsAskedFor) {
  for (double coverage : {0.1, 0.5, 0.9}) {
    const Built b =
        build("discs: {coverage: " + std::to_string(coverage) + ", radius_low: 2, radius_high: 4, height: 2}",
              "width: 200, height: 150");
    double covered = 0;
    for (double v : b.layers.at(Layer::sand)) {
      EXPECT_TRUE(v == 0 || v == 2);
      covered += v > 0;
    }
    EXPECT_GE(covered / 30000, coverage);
    EXPECT_LE(covered / 30000, coverage + 0.002);
  }
  EXPECT_EQ(build("discs: {coverage: 0}").at(Layer::sand, 3, 3), 0);
}

TEST(TerrainSteps, NoiseFillsItsRangeAndDependsOnItsSeeds) {
  const std::string grid = "width: 128, height: 96";
  for (const char* scale : {"0", "20"}) {
    const std::string step = "noise: {layer: sand, low: 1, high: 3, scale: " + std::string(scale);
    const Built a = build(step + "}", grid), b = build(step + "}", grid),
                c = build(step + ", seed: 1}", grid);
    double least = 9, greatest = 0, mean = 0;
    for (double v : a.layers.at(Layer::sand)) {
      least = std::min(least, v);
      greatest = std::max(greatest, v);
      mean += v / (128 * 96);
    }
    EXPECT_GE(least, 1);
    EXPECT_LE(greatest, 3);
    EXPECT_LT(least, 1.6);
    EXPECT_GT(greatest, 2.4);
    EXPECT_NEAR(mean, 2, 0.15);
    EXPECT_TRUE(a.layers == b.layers);
    EXPECT_FALSE(a.layers == c.layers);
  }
}

TEST(TerrainSteps, SmoothNoiseTilesOnATorus) {
  const Built b =
      build("noise: {layer: sand, low: 0, high: 10, scale: 25, octaves: 3}", "width: 90, height: 70");
  double inside = 0, across = 0;
  for (int y = 0; y < 70; ++y) {
    across = std::max(across, std::abs(b.at(Layer::sand, 89, y) - b.at(Layer::sand, 0, y)));
    for (int x = 0; x < 89; ++x)
      inside = std::max(inside, std::abs(b.at(Layer::sand, x + 1, y) - b.at(Layer::sand, x, y)));
  }
  EXPECT_LE(across, 1.5 * inside);
}

TEST(TerrainSteps, NoiseBelowItsThresholdIsLow) {
  const Built b = build("noise: {layer: sand, low: 0, high: 4, threshold: 0.7}", "width: 100, height: 100");
  int bare = 0;
  for (double v : b.layers.at(Layer::sand)) bare += v == 0;
  EXPECT_NEAR(bare, 7000, 200);
}

TEST(TerrainSteps, RastersAreAskedForOnTheGridAndFillTheirLayer) {
  RasterRequest asked;
  const RasterLoader loader = [&](const RasterRequest& request) {
    asked = request;
    RasterField field;
    field.width = request.width;
    field.height = request.height;
    for (int i = 0; i < request.width * request.height; ++i) field.values.push_back(static_cast<float>(i));
    return field;
  };
  const Built b = build(
      "raster: {layer: sand, file: dem.tif, band: 2, scale: 0.1, offset: 3, fill_nodata: true, merge: add}",
      "width: 4, height: 3, cell_size: 5, origin_x: 7", loader);
  EXPECT_EQ(asked.width, 4);
  EXPECT_EQ(asked.height, 3);
  EXPECT_EQ(asked.cell_size, 5);
  EXPECT_EQ(asked.origin_x, 7);
  EXPECT_EQ(asked.band, 2);
  EXPECT_EQ(asked.scale, 0.1);
  EXPECT_EQ(asked.offset, 3);
  EXPECT_TRUE(asked.fill_nodata);
  EXPECT_NE(asked.path.find("dem.tif"), std::string::npos);
  EXPECT_EQ(b.at(Layer::sand, 3, 2), 11);
}

TEST(TerrainSteps, AGridFromARasterTakesSizeCellAndOriginUnlessTheyAreGiven) {
  const RasterLoader loader = [](const RasterRequest&) {
    RasterField field;
    field.width = 40;
    field.height = 30;
    field.cell_size = 10;
    field.origin_x = 500;
    field.origin_y = -200;
    field.projection = "somewhere";
    return field;
  };
  const auto grid = [&](const std::string& more) {
    Scenario s = test::parsed("grid: {from_raster: dem.tif" + more + "}");
    resolve_grid(s, loader);
    EXPECT_EQ(s.projection, "somewhere");
    return s.grid;
  };
  EXPECT_EQ(grid("").width, 40);
  EXPECT_EQ(grid("").height, 30);
  EXPECT_EQ(grid("").cell_size, 10);
  EXPECT_EQ(grid("").origin_x, 500);
  EXPECT_EQ(grid("").origin_y, -200);
  EXPECT_EQ(grid(", cell_size: 5").width, 80);
  EXPECT_EQ(grid(", width: 20").width, 20);
  EXPECT_EQ(grid(", width: 20").origin_x, 600) << "the middle of the raster";
}

}  // namespace
}  // namespace desert_sim

// Coordinates that are not metres on the ground are refused with a command, and what that command makes
// loads.

#include "src/io/projection.hpp"

#include <gdal_utils.h>
#include <wordexp.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "src/io/raster_loader.hpp"
#include "src/scenario/raster_grid.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

class Projection : public RasterTest {
 protected:
  static RasterField load(const std::string& file, bool fill_nodata = false) {
    const RasterLoader loader = gdal_raster_loader();
    RasterRequest q;
    q.path = file;
    const RasterField header = loader(q);
    q.width = header.width;
    q.height = header.height;
    q.cell_size = header.cell_size;
    q.origin_x = header.origin_x;
    q.origin_y = header.origin_y;
    q.fill_nodata = fill_nodata;
    return loader(q);
  }
  static std::string load_refusal(const std::string& file) {
    try {
      load(file);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  }
  /// Runs the gdalwarp command that a refusal ends with, in this process; the file that it makes.
  static std::string warped(const std::string& refusal) {
    const std::size_t at = refusal.find("gdalwarp ");
    EXPECT_NE(at, std::string::npos) << refusal;
    if (at == std::string::npos) return "";
    wordexp_t words;
    EXPECT_EQ(wordexp(refusal.substr(at).c_str(), &words, WRDE_NOCMD), 0) << refusal;
    std::vector<char*> options(words.we_wordv + 1, words.we_wordv + words.we_wordc - 2);
    options.push_back(nullptr);
    const std::string source = words.we_wordv[words.we_wordc - 2],
                      target = words.we_wordv[words.we_wordc - 1];
    GDALWarpAppOptions* warp = GDALWarpAppOptionsNew(options.data(), nullptr);
    GDALDatasetUniquePtr from(GDALDataset::Open(source.c_str()));
    GDALDatasetH sources[] = {GDALDataset::ToHandle(from.get())};
    GDALDatasetH made = GDALWarp(target.c_str(), nullptr, 1, sources, warp, nullptr);
    EXPECT_NE(made, nullptr) << refusal;
    if (made) GDALClose(made);
    GDALWarpAppOptionsFree(warp);
    wordfree(&words);
    return target;
  }

  /// A cone of 30 degrees, 400 m high, in the middle of cells that are `ground` metres wide.
  static std::vector<float> cone(int side, double ground) {
    std::vector<float> values;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        values.push_back(static_cast<float>(
            std::max(0.0, 400 - std::tan(30 * std::acos(-1) / 180) * ground *
                                    std::hypot(x - 0.5 * (side - 1), y - 0.5 * (side - 1)))));
    return values;
  }
  /// Steepest slope between neighbours along x in the lower half of the cone's heights [deg].
  static double slope_deg(const RasterField& f) {
    double steepest = 0;
    for (int y = 0; y < f.height; ++y)
      for (int x = 0; x + 1 < f.width; ++x) {
        const float a = f.values[static_cast<std::size_t>(y * f.width + x)],
                    b = f.values[static_cast<std::size_t>(y * f.width + x + 1)];
        if (a > 50 && a < 300 && b > 50) steepest = std::max(steepest, std::abs(a - b) / f.cell_size);
      }
    return std::atan(steepest) * 180 / std::acos(-1);
  }
};

/// At 60 degrees north a metre of Web Mercator is half a metre of ground.
TEST_F(Projection, WebMercatorAwayFromTheEquatorIsRefusedAndProjectedKeepsSlopes) {
  const std::string file = make("cone.tif", "GTiff", 120, 120, GDT_Float32, cone(120, 20),
                                {1669792 - 60 * 40.0, 40, 0, 8399738 + 60 * 40.0, 0, -40}, "EPSG:3857");
  const std::string refusal = load_refusal(file);
  expect_says(refusal, {"cone.tif", "0.50", "m of ground", "gdalwarp -t_srs EPSG:32633 "});
  EXPECT_NEAR(slope_deg(load(warped(refusal))), 30, 1);
}

TEST_F(Projection, SystemsWhoseMetresAreMetresAreTaken) {
  const auto taken = [&](const char* srs, double x, double y) {
    return load_refusal(
        make("plane.tif", "GTiff", 4, 4, GDT_Float32, std::vector<float>(16, 1), {x, 10, 0, y, 0, -10}, srs));
  };
  EXPECT_EQ(taken("EPSG:32613", 350000, 4400000), "") << "UTM, 2 degrees from its meridian";
  EXPECT_EQ(taken("EPSG:2154", 700000, 6600000), "") << "Lambert-93";
  EXPECT_EQ(taken("EPSG:3035", 4321000, 3210000), "") << "ETRS89 / LAEA Europe";
  EXPECT_EQ(taken("EPSG:3857", 1000000, 20000), "") << "Web Mercator at the equator";
  expect_says(taken("EPSG:4087", 1669792, 5000000),
              {"m of ground", "gdalwarp"});  // equidistant cylindrical at 45 N
  EXPECT_EQ(taken("EPSG:32661", 1999980, 2000020), "") << "UPS at the pole";
  expect_says(taken("EPSG:3413", -20, 20), {"1.03", "m of ground"});  // true at 70 N, here at the pole
  expect_says(taken("EPSG:32613", 2500000, 4400000),
              {"m of ground", "EPSG:32617 "});  // UTM, far from its zone
}

/// NAD83 / UTM 11 N and NAD83, with heights above NAVD88 in US survey feet.
TEST_F(Projection, HeightsInFeetBecomeMetresOnce) {
  constexpr double hundred_feet = 30.48006;
  for (const char* driver : {"GTiff", "ENVI"}) {
    SCOPED_TRACE(driver);
    const std::string name = driver == std::string("GTiff") ? "feet.tif" : "feet.bin";
    const RasterField f = load(make(name, driver, 6, 5, GDT_Float32, std::vector<float>(30, 100),
                                    {500000, 10, 0, 4000000, 0, -10}, "EPSG:26911+6360"));
    EXPECT_NEAR(f.values[7], hundred_feet, 1e-4);
    EXPECT_EQ(unit_of_heights(f.projection), "") << "what is written in metres is not read as feet";
    const std::string refusal =
        load_refusal(make("degrees_" + name, driver, 40, 40, GDT_Float32, std::vector<float>(1600, 100),
                          {-117, 1e-4, 0, 36, 0, -1e-4}, "EPSG:4269+6360"));
    EXPECT_NEAR(load(warped(refusal)).values[500], hundred_feet, 1e-4) << refusal;
  }
}

TEST_F(Projection, DepthsStayDepths) {
  const std::string refusal =
      load_refusal(make("depths.tif", "GTiff", 40, 40, GDT_Float32, std::vector<float>(1600, 100),
                        {-117, 1e-4, 0, 36, 0, -1e-4}, "EPSG:4269+5715"));
  const std::string file = warped(refusal);
  expect_says(load_refusal(file), {"points down", "scale: -1"});
  EXPECT_NEAR(read_raster(file, {1, -1}).values[500], -100, 1e-3) << refusal;
}

/// 256 red + green + blue / 256 − 32768 of a height of 310.5 m, a pixel in degrees.
TEST_F(Projection, ColoursThatEncodeHeightsAreNotMixed) {
  const std::string name =
      make("terrarium.tif", "GTiff", 40, 40, GDT_Byte, std::vector<unsigned char>(4800, 0),
           {-117, 1e-4, 0, 36, 0, -1e-4}, "EPSG:4326", nullptr, 3);
  {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(name.c_str(), GDAL_OF_UPDATE));
    const GDALColorInterp colours[] = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand};
    const double bytes[] = {129, 54, 128};
    for (int n = 0; n < 3; ++n) {
      dataset->GetRasterBand(n + 1)->SetColorInterpretation(colours[n]);
      dataset->GetRasterBand(n + 1)->Fill(bytes[n]);
    }
  }
  const std::string file = warped(load_refusal(name));
  expect_says(load_refusal(file), {"is a picture of colours"});
  RasterOptions options;
  options.encoding = RasterEncoding::terrarium;
  const Raster r = read_raster(file, options);
  EXPECT_EQ(r.values[r.values.size() / 2], 310.5F);
}

TEST_F(Projection, OtherBodiesGetAProjectionOfTheirOwn) {
  const std::string mars = "+proj=longlat +a=3396190 +b=3376200 +no_defs",
                    moon = "+proj=longlat +R=1737400 +no_defs";
  for (const auto& [srs, latitude, radius] :
       {std::tuple{mars, -5.4, 3396190.0}, {moon, 26.1, 1737400.0}, {moon, -89.5, 1737400.0}}) {
    const double cell = 20 / radius * 180 / std::acos(-1);  // 20 m along a meridian
    const std::string file = make("body.tif", "GTiff", 60, 60, GDT_Float32, std::vector<float>(3600, 100),
                                  {137.4, cell, 0, latitude + 30 * cell, 0, -cell}, srs);
    const std::string refusal = load_refusal(file);
    expect_says(refusal, {"body.tif", "degrees", "+proj=", "body_metres.tif"});
    EXPECT_EQ(refusal.find("EPSG"), std::string::npos) << refusal;
    const RasterField field = load(warped(refusal), latitude < -80);
    // A raster of degrees beside the pole is a sliver, which lies askew.
    const double wide = field.width * field.cell_size, tall = field.height * field.cell_size;
    EXPECT_NEAR((latitude < -80 ? std::hypot(wide, tall) : tall) / 1200, 1, 0.1)
        << "60 cells of 20 m along the meridian, at " << latitude;
    for (float v : field.values) EXPECT_NEAR(v, 100, 1e-3);
  }
}

/// A raster of degrees lies askew in metres; the cells beside it are no ground at sea level.
TEST_F(Projection, NothingIsMadeUpBesideTheProjectedRaster) {
  const std::string file =
      make("plateau.tif", "GTiff", 64, 64, GDT_Int16, std::vector<std::int16_t>(4096, 850),
           {-13.2, 0.00028, 0, 25.1, 0, -0.00028}, "EPSG:4326");
  const std::string refusal = load_refusal(file);
  const RasterField inner = load(warped(refusal));
  EXPECT_GT(inner.width * inner.height, 0.9 * 64 * 64);
  for (float v : inner.values) EXPECT_EQ(v, 850);
  const std::string whole = warped(std::regex_replace(refusal, std::regex(" -tr .* -r "), " -r "));
  expect_says(load_refusal(whole), {"plateau_32628.tif", "cells without data", "fill_nodata"});
  for (float v : load(whole, true).values) EXPECT_EQ(v, 850);
}

TEST_F(Projection, GroundControlPointsAreRefusedWithTheCommandThatUsesThem) {
  const std::string file =
      make("gcps.tif", "GTiff", 40, 30, GDT_Float32, std::vector<float>(1200, 7), {}, "EPSG:32645");
  {
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(file.c_str(), GDAL_OF_UPDATE));
    OGRSpatialReference crs;
    crs.importFromEPSG(32645);
    std::vector<GDAL_GCP> points(5);
    GDALInitGCPs(5, points.data());
    const double at[5][2] = {{0, 0}, {40, 0}, {0, 30}, {40, 30}, {20, 15.2}};
    for (std::size_t n = 0; n < 5; ++n) {
      points[n].dfGCPPixel = at[n][0];
      points[n].dfGCPLine = at[n][1];
      points[n].dfGCPX = 500000 + 5 * at[n][0];
      points[n].dfGCPY = 3100000 - 5 * at[n][1];
    }
    ASSERT_EQ(dataset->SetGCPs(5, points.data(), &crs), CE_None);
    GDALDeinitGCPs(5, points.data());
  }
  const std::string refusal = load_refusal(file);
  expect_says(refusal, {"gcps.tif", "5 ground control points", "gdalwarp -t_srs EPSG:32645 "});
  const RasterField field = load(warped(refusal), true);
  EXPECT_NEAR(field.cell_size, 5, 0.1);
  EXPECT_NEAR(field.origin_x, 500000, 5);
  RasterRequest stretched;
  stretched.path = file;
  stretched.width = stretched.height = 10;
  stretched.cell_size = 1;
  stretched.stretch = true;
  EXPECT_EQ(gdal_raster_loader()(stretched).values.front(), 7) << "wherever it lies";
}

}  // namespace
}  // namespace desert_sim

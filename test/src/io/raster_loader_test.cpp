// DEMs of the real world: undeclared nodata, steps, coordinates in degrees.

#include "src/io/raster_loader.hpp"

#include <algorithm>
#include <cmath>

#include "test/support/log_lines.hpp"
#include "test/support/raster_test.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

class Dem : public RasterTest {
 protected:
  std::string grid(const std::vector<float>& values, int width, const std::string& name = "dem.tif",
                   const double* nodata = nullptr) const {
    const int height = static_cast<int>(values.size()) / width;
    return make(name, "GTiff", width, height, GDT_Float32, values, {0, 10, 0, 10.0 * height, 0, -10},
                "EPSG:32613", nodata);
  }
  static RasterRequest request(const std::string& file, int width, int height, double cell_size) {
    RasterRequest q;
    q.path = file;
    q.width = width;
    q.height = height;
    q.cell_size = cell_size;
    return q;
  }
  static std::string load_refusal(const RasterRequest& q) {
    try {
      gdal_raster_loader()(q);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  }
  static std::vector<std::string> warnings_of(const std::string& file, const RasterOptions& options = {}) {
    test::LogLines log;
    read_raster(file, options);
    return log.lines;
  }
};

TEST_F(Dem, ANodataValueOfTheStepIsMissingBesidesTheDeclaredOne) {
  const double declared = -1;
  const std::string file = grid({5, -9999, 7, -1, 9, 10}, 3, "dem.tif", &declared);
  const Raster r = read_raster(file, {1, 2, 1, -9999.0});
  EXPECT_EQ(r.nodata_count(), 2);
  EXPECT_TRUE(std::isnan(r.values[4]) && std::isnan(r.values[0]));
  EXPECT_EQ(r.values[3], 11) << "compared before scale and offset";
  RasterRequest q = request(file, 3, 2, 10);
  q.nodata = -9999;
  expect_says(load_refusal(q), {"has 2 cells without data", "fill_nodata"});
  q.fill_nodata = true;
  for (float v : gdal_raster_loader()(q).values) EXPECT_GT(v, 0);
}

TEST_F(Dem, ALargestFloatIsMissingHoweverItIsRounded) {
  const float lowest = -std::numeric_limits<float>::max();
  EXPECT_EQ(read_raster(grid({1, lowest}, 2), {1, 1, 0, -3.4028234663852886e38}).nodata_count(), 1);
  EXPECT_EQ(read_raster(grid({1, lowest}, 2), {1, 1, 0, -3.4028235e38}).nodata_count(), 1);
  EXPECT_EQ(read_raster(grid({1, -lowest}, 2), {1, 1, 0, -3.4028235e38}).nodata_count(), 0);
}

TEST_F(Dem, ANodataValueIsAParameterOfTheStep) {
  RasterRequest asked;
  const RasterLoader loader = [&](const RasterRequest& q) {
    asked = q;
    RasterField field;
    field.values.assign(static_cast<std::size_t>(q.width) * q.height, 1);
    return field;
  };
  const auto request_of = [&](const std::string& more) {
    CpuExec exec(1);
    const Scenario s =
        test::parsed("grid: {width: 4, height: 3}\nterrain: [raster: {file: a.tif" + more + "}]\n");
    Scenario resolved = s;
    resolve_grid(resolved, loader);
    const Scenario again = test::parsed(dump_scenario(resolved));
    EXPECT_EQ(std::get<RasterStep>(again.terrain[0]).nodata, std::get<RasterStep>(s.terrain[0]).nodata);
    Simulation(exec, resolved, loader);
    return asked;
  };
  EXPECT_EQ(request_of(", nodata: -9999").nodata, -9999);
  EXPECT_EQ(request_of(", nodata: -3.4028234663852886e+38").nodata, -3.4028234663852886e38);
  EXPECT_FALSE(request_of("").nodata);
  EXPECT_THROW(test::parsed("terrain: [raster: {file: a.tif, nodata: none}]\n"), ConfigError);
  EXPECT_THROW(test::parsed("terrain: [raster: {file: a.tif, nodata: .nan}]\n"), ConfigError);
}

TEST_F(Dem, UndeclaredNodataIsNamedWithItsShare) {
  const auto warned = [&](const std::vector<float>& values, const RasterOptions& options = {}) {
    return warnings_of(grid(values, 4), options);
  };
  const std::vector<float> plain{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
  EXPECT_TRUE(warned(plain).empty());
  const auto with = [&](float value, const std::vector<int>& cells) {
    std::vector<float> values = plain;
    for (int cell : cells) values[static_cast<std::size_t>(cell)] = value;
    return values;
  };
  for (float value : {-9999.0F, -32768.0F, 999.0F, 9999.0F, -99999.0F, -32767.0F, -999.0F, 32767.0F, 65535.0F,
                      -5000.0F, 12345.0F}) {
    const std::vector<std::string> lines = warned(with(value, {0, 5}));
    ASSERT_EQ(lines.size(), 1u) << value;
    const std::string number = std::to_string(static_cast<int>(value));
    expect_says(lines[0], {"dem.tif", "12.5 % of its cells (2 of 16) are ", number.c_str(), "nodata: "});
    EXPECT_TRUE(warned(with(value, {0, 5}), {1, 1, 0, static_cast<double>(value)}).empty())
        << "it is declared";
  }
  for (float value : {1e38F, -1e38F, std::numeric_limits<float>::max()}) {
    const std::vector<std::string> lines = warned(with(value, {6}));
    ASSERT_EQ(lines.size(), 1u) << value;
    expect_says(lines[0], {"6.25 % of its cells (1 of 16) are ", "e+38"});
  }
  const double declared = -9999;
  EXPECT_TRUE(warnings_of(grid(with(-9999, {0}), 4, "dem.tif", &declared)).empty());
  EXPECT_EQ(warned(with(-9999, {5}), {1, 0.1, 3}).size(), 1u) << "compared before scale and offset";
}

TEST_F(Dem, ANumberThatMayBeAnElevationIsNamedOnlyAtTheEdgeAndApartFromOthers) {
  std::vector<float> values(25, 20);
  values[12] = 999;
  EXPECT_TRUE(warnings_of(grid(values, 5)).empty()) << "a summit in the middle";
  values[0] = 999;
  EXPECT_EQ(warnings_of(grid(values, 5)).size(), 1u);
  values[1] = 1003;
  EXPECT_TRUE(warnings_of(grid(values, 5)).empty()) << "a landscape at that height";
}

TEST_F(Dem, ALowestNumberFarBelowAllOthersIsNamedWhereSeveralCellsHaveIt) {
  std::vector<float> values;
  for (int i = 0; i < 25; ++i) values.push_back(static_cast<float>(800 + i));
  values[7] = 0;
  EXPECT_TRUE(warnings_of(grid(values, 5)).empty()) << "one pit";
  values[8] = 0;
  EXPECT_EQ(warnings_of(grid(values, 5)).size(), 1u);
  EXPECT_TRUE(warnings_of(grid(values, 5), {1, 0.1}).empty()) << "80 m deep";
  values[9] = 500;
  EXPECT_TRUE(warnings_of(grid(values, 5)).empty()) << "a valley's floor";
}

TEST_F(Dem, NodataBeyondFloatsIsNamedBeforeTheValuesAreRefused) {
  const std::string file = make("dem.tif", "GTiff", 2, 1, GDT_Float64, std::vector<double>{5, -1.7e308});
  test::LogLines log;
  expect_says(refusal(file), {"beyond float32"});
  ASSERT_EQ(log.lines.size(), 1u);
  expect_says(log.lines[0], {"nodata: -1.7e+308"});
}

TEST_F(Dem, TheNodataThatIsAdvisedIsTheNumberInTheFile) {
  std::vector<float> values(400, 100);
  for (int i = 0; i < 400; ++i)
    if (i % 20 > 1 && i % 20 < 18 && i > 40 && i < 360)
      values[static_cast<std::size_t>(i)] = 8500 + 3.0F * (i % 7);
  const std::vector<std::string> lines = warnings_of(grid(values, 20), {1, 0.1, -7});
  ASSERT_EQ(lines.size(), 1u);
  expect_says(lines[0], {"a frame of ", "is exactly 3, ", "nodata: 100,"});
}

TEST_F(Dem, CoordinatesThatCanOnlyBeDegreesAreWarnedOf) {
  const auto warned = [&](double cell, const char* srs) {
    RasterRequest q;
    q.path = make("place.tif", "GTiff", 4, 4, GDT_Float32,
                  std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
                  {500000, cell, 0, 4000000, 0, -cell}, srs);
    q.width = q.height = 4;
    q.cell_size = cell;
    q.origin_x = 500000;
    q.origin_y = 4000000 - 4 * cell;
    test::LogLines log;
    gdal_raster_loader()(q);
    return log.lines;
  };
  EXPECT_TRUE(warned(10, "").empty());
  EXPECT_TRUE(warned(0.0003, "EPSG:32613").empty());
  const std::vector<std::string> lines = warned(0.0003, "");
  ASSERT_EQ(lines.size(), 1u);
  expect_says(lines[0], {"place.tif", "heights differ by 15 m over a width of 0.0012 m", "degrees?"});
}

TEST_F(Dem, NothingOvershootsBesideACliff) {
  std::vector<float> cliff;
  for (int i = 0; i < 64; ++i) cliff.push_back(i % 8 < 4 ? 100.0F : 200.0F);
  const std::string file = grid(cliff, 8);
  for (bool stretch : {false, true})
    for (int factor : {2, 3, 5}) {
      RasterRequest q = request(file, 8 * factor, 8 * factor, 10.0 / factor);
      q.stretch = stretch;
      const RasterField field = gdal_raster_loader()(q);
      ASSERT_EQ(field.values.size(), 64u * factor * factor);
      const auto [low, high] = std::minmax_element(field.values.begin(), field.values.end());
      EXPECT_EQ(*low, 100) << factor;
      EXPECT_EQ(*high, 200) << factor;
    }
}

TEST_F(Dem, DegreesAreRefusedWithTheCommandThatProjects) {
  const auto in_degrees = [&](double west, double north, double cell_x, double cell_y,
                              const std::string& name = "srtm.tif") {
    RasterRequest q;
    q.path = make(name, "GTiff", 4, 2, GDT_Float32, std::vector<float>(8, 1),
                  {west, cell_x, 0, north, 0, -cell_y}, "EPSG:4326");
    return load_refusal(q);
  };
  const std::string file = path("srtm.tif");
  expect_says(in_degrees(-105.002, 40, 0.001, 0.001),
              {"srtm.tif", "degrees",
               ("gdalwarp -t_srs EPSG:32613 -r bilinear -ot Float32 -dstnodata nan " + file + " " +
                path("srtm_32613.tif"))
                   .c_str()});
  expect_says(in_degrees(16.3, -23, 0.001, 0.001), {"EPSG:32733 "});
  expect_says(in_degrees(-180, 1, 0.001, 0.001), {"EPSG:32601 "});
  expect_says(in_degrees(179.99, 1, 0.001, 0.001), {"EPSG:32660 "});
  expect_says(in_degrees(359.5, 10, 0.001, 0.001), {"EPSG:32630 "});
  expect_says(in_degrees(10, 86, 0.001, 0.001), {"EPSG:32661 "});
  expect_says(in_degrees(10, -85, 0.001, 0.001), {"EPSG:32761 "});
  expect_says(in_degrees(-105.002, 70, 0.0015, 0.001),
              {"degrees", "EPSG:32613 "});  // cells that are not square
  expect_says(in_degrees(-105.002, 40, 0.001, 0.001, "my dem's.tif"),
              {("'" + path("my dem'\\''s.tif") + "'").c_str()});
}

TEST_F(Dem, FeetAreRefusedWithTheCommandThatProjects) {
  RasterRequest q;  // around Pittsburgh, in Pennsylvania's southern zone
  q.path = make("feet.tif", "GTiff", 4, 4, GDT_Float32, std::vector<float>(16, 1),
                {1340000, 10, 0, 410000, 0, -10}, "EPSG:2272");
  expect_says(load_refusal(q), {"US survey foot", "gdalwarp -t_srs EPSG:32617 "});
}

/// Of a local system it cannot be known where on Earth it lies, thus not which projection fits.
TEST_F(Dem, LocalFeetAreRefusedWithoutNamingAProjection) {
  RasterRequest q;
  q.path = make("local.tif", "GTiff", 4, 4, GDT_Float32, std::vector<float>(16, 1), {0, 10, 0, 0, 0, -10},
                R"(LOCAL_CS["site",UNIT["foot",0.3048],AXIS["x",EAST],AXIS["y",NORTH]])");
  const std::string refusal = load_refusal(q);
  expect_says(refusal, {"local.tif", "foot", "metres are needed"});
  EXPECT_EQ(refusal.find("EPSG"), std::string::npos) << refusal;
}

TEST_F(Dem, MoreCellsThanTheFileCanHaveAreRefusedBeforeTheyAreRead) {
  const char* const options[] = {"SPARSE_OK=TRUE", "TILED=YES", "BLOCKXSIZE=4096", "BLOCKYSIZE=4096",
                                 nullptr};
  const GDALDatasetUniquePtr sparse(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      path("sparse.tif").c_str(), 40000, 40000, 1, GDT_Byte, const_cast<char**>(options)));
  ASSERT_TRUE(sparse);
  sparse->FlushCache();
  RasterRequest q = request(path("sparse.tif"), 12, 12, 1);
  EXPECT_EQ(gdal_raster_loader()(q).values[0], 0) << "few cells are needed";
  q.stretch = true;
  expect_says(load_refusal(q), {"sparse.tif", "40000 x 40000 cells are needed", "bytes cannot have"});
}

// GDAL alone reads the lines before a broken one again and again.
TEST_F(Dem, ATextWithBrokenLinesIsRefusedSoon) {
  const std::string message =
      load_refusal(request(DESERT_SOURCE_DIR "/test/fuzz/corpus/raster/text_with_broken_lines", 9, 7, 2));
  EXPECT_NE(message.find("is not a number"), std::string::npos) << message;
}

}  // namespace
}  // namespace desert_sim

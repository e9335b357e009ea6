#include "src/io/declared_values.hpp"

#include <opencv2/imgcodecs.hpp>

#include "src/core/log.hpp"
#include "test/support/log_lines.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

class DeclaredValuesOf : public RasterTest {
 protected:
  std::string file(double scale, double offset, const char* unit) const {
    const std::string name = make("dem.tif", "GTiff", 2, 1, GDT_Int16, std::vector<std::int16_t>{200, -40});
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(name.c_str(), GDAL_OF_UPDATE));
    dataset->GetRasterBand(1)->SetScale(scale);
    dataset->GetRasterBand(1)->SetOffset(offset);
    dataset->GetRasterBand(1)->SetUnitType(unit);
    return name;
  }
  static void expect_values(const std::string& name, float first, float second,
                            const RasterOptions& options = {}) {
    const Raster r = read_raster(name, options);
    EXPECT_FLOAT_EQ(r.values[0], first);
    EXPECT_FLOAT_EQ(r.values[1], second);
  }
};

TEST_F(DeclaredValuesOf, ABandAreAppliedBeforeTheStepsOwn) {
  expect_values(file(0.5, 0, ""), 100, -20);
  expect_values(file(0.5, 10, ""), 110, -10);
  expect_values(file(0.5, 10, "cm"), 1.1F, -0.1F);
  expect_values(file(0.5, 10, "m"), -108, 12, {1, -1, 2});
}

TEST_F(DeclaredValuesOf, UnitsOfLengthBecomeMetres) {
  const std::pair<const char*, double> units[] = {{"m", 1},
                                                  {"Metre", 1},
                                                  {"dm", 0.1},
                                                  {"cm", 0.01},
                                                  {"mm", 0.001},
                                                  {"km", 1000},
                                                  {"ft", 0.3048},
                                                  {"feet", 0.3048},
                                                  {"FOOT", 0.3048},
                                                  {"decimeters", 0.1},
                                                  {"US survey foot", 0.3048006096}};
  for (const auto& [unit, metres] : units) {
    SCOPED_TRACE(unit);
    ASSERT_TRUE(metres_of_unit(unit));
    EXPECT_NEAR(*metres_of_unit(unit), metres, 1e-9 * metres);
    expect_values(file(1, 0, unit), static_cast<float>(200 * metres), static_cast<float>(-40 * metres));
  }
  EXPECT_FALSE(metres_of_unit("kelvin"));
}

TEST_F(DeclaredValuesOf, AnUnknownUnitIsWarnedOf) {
  test::LogLines log;
  expect_values(file(1, 0, "degC"), 200, -40);
  ASSERT_EQ(log.lines.size(), 1u);
  expect_says(log.lines[0], {"dem.tif", "degC", "taken as they are"});
  expect_values(file(1, 0, ""), 200, -40);
  EXPECT_EQ(log.lines.size(), 1u);
}

/// Scenarios were told to give what the file declares.
TEST_F(DeclaredValuesOf, AScaleThatTheScenarioGivesTooCountsOnce) {
  test::LogLines log;
  expect_values(file(1, 0, "US survey foot"), 60.96F, -12.192F, {1, 0.3048});
  expect_values(file(0.5, 0, ""), 100, -20, {1, 0.5});
  ASSERT_EQ(log.lines.size(), 2u);
  expect_says(log.lines[1], {"dem.tif", "0.5", "applied once"});
  expect_values(file(0.5, 0, ""), 25, -5, {1, 0.25});
}

TEST_F(DeclaredValuesOf, ANonsensicalOneIsRefused) {
  expect_says(refusal(file(0, 1, "m")), {"dem.tif", "the scale 0", "not 0"});
}

TEST_F(DeclaredValuesOf, PicturesOfColoursAreNoHeights) {
  const cv::Mat colours(2, 3, CV_8UC3, cv::Scalar(128, 74, 129));  // blue, green, red: 330.5 m as terrarium
  const std::string picture = path("terrarium.png");
  ASSERT_TRUE(cv::imwrite(picture, colours));
  expect_says(refusal(picture), {"terrarium.png", "a picture of colours", "encoding: terrarium"});
  EXPECT_EQ(read_raster(picture, {1, 1, 0, {}, RasterEncoding::terrarium}).values[0], 330.5F);
  EXPECT_FLOAT_EQ(read_raster(picture, {1, 1, 0, {}, RasterEncoding::mapbox}).values[0],
                  (65536 * 129 + 256 * 74 + 128) / 10.0F - 10000);
  EXPECT_EQ(read_raster(picture, {1, 1, 0, {}, RasterEncoding::channel}).values[0], 129);
  EXPECT_EQ(read_raster(picture, {2}).values[0], 74) << "a band that the scenario names";
  const std::string grey = path("grey.png");
  ASSERT_TRUE(cv::imwrite(grey, cv::Mat(2, 2, CV_8UC1, cv::Scalar(9))));
  EXPECT_EQ(read_raster(grey).values[0], 9);
  expect_says(refusal(grey, {1, 1, 0, {}, RasterEncoding::terrarium}), {"grey.png", "red, green and blue"});
}

TEST_F(DeclaredValuesOf, IndicesOfAPaletteAreNoHeights) {
  const GDALDatasetUniquePtr memory(
      GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 4, 4, 1, GDT_Byte, nullptr));
  GDALColorTable palette;
  const GDALColorEntry red{255, 0, 0, 255};
  for (int index = 0; index < 4; ++index) palette.SetColorEntry(index, &red);
  memory->GetRasterBand(1)->SetColorTable(&palette);
  memory->GetRasterBand(1)->Fill(3);
  const std::string name = path("palette.png");
  ASSERT_TRUE(GDALDatasetUniquePtr(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(
      name.c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr)));
  expect_says(refusal(name), {"palette.png", "palette", "encoding: channel"});
  EXPECT_EQ(read_raster(name, {1, 1, 0, {}, RasterEncoding::channel}).values[0], 3);
}

/// What gdalwarp -dstalpha makes.
TEST_F(DeclaredValuesOf, OpacityOfEveryTypeIsAMask) {
  const auto expect_mask = [this](auto number, GDALDataType type) {
    const std::vector<decltype(number)> heights_and_opacity{1, 2, 3, 0, 255, 255, 255, 0};
    const std::string name = make("alpha.tif", "GTiff", 2, 2, type, heights_and_opacity, {}, "", nullptr, 2);
    const GDALDatasetUniquePtr dataset(GDALDataset::Open(name.c_str(), GDAL_OF_UPDATE));
    dataset->GetRasterBand(2)->SetColorInterpretation(GCI_AlphaBand);
    dataset->FlushCache();
    const Raster r = read_raster(name);
    EXPECT_EQ(r.nodata_count(), 1) << GDALGetDataTypeName(type);
    EXPECT_TRUE(std::isnan(r.values[1])) << GDALGetDataTypeName(type);
  };
  expect_mask(std::uint8_t{}, GDT_Byte);
  expect_mask(std::uint16_t{}, GDT_UInt16);
  expect_mask(std::int16_t{}, GDT_Int16);
  expect_mask(0.0F, GDT_Float32);
}

TEST_F(DeclaredValuesOf, PicturesOf16BitsAreNoHeightsEither) {
  const std::string picture = path("colours.png");
  ASSERT_TRUE(cv::imwrite(picture, cv::Mat(2, 3, CV_16UC3, cv::Scalar(128, 74, 129))));
  expect_says(refusal(picture), {"colours.png", "a picture of colours"});
}

/// As with --all-raster-formats.
TEST_F(DeclaredValuesOf, CellsUnderAnExternalMaskAreWithoutData) {
  const std::string name = make("external.tif", "GTiff", 2, 2, GDT_Float32, std::vector<float>{1, 2, 3, 0});
  {
    const GDALDatasetUniquePtr dataset(
        GDALDataset::Open(name.c_str()));  // read-only: the mask becomes a file beside it
    ASSERT_EQ(dataset->CreateMaskBand(GMF_PER_DATASET), CE_None);
    const std::vector<unsigned char> valid{255, 255, 255, 0};
    ASSERT_EQ(
        dataset->GetRasterBand(1)->GetMaskBand()->RasterIO(
            GF_Write, 0, 0, 2, 2, const_cast<unsigned char*>(valid.data()), 2, 2, GDT_Byte, 0, 0, nullptr),
        CE_None);
  }
  ASSERT_TRUE(std::filesystem::exists(name + ".msk"));
  for (bool all_formats : {false, true}) {
    const Raster r = read_raster(name, {}, {"", all_formats});
    EXPECT_EQ(r.nodata_count(), 1) << all_formats;
    EXPECT_TRUE(std::isnan(r.values[1])) << all_formats;
  }
}

}  // namespace
}  // namespace desert_sim

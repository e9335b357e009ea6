// Reading and writing rasters: orientation, geotransform, nodata, every format, every refusal.

#include "desert_sim/io/raster.hpp"

#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "desert_sim/core/error.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class RasterTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "raster_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    GDALAllRegister();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string write_text(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

  /// A file of any GDAL driver, made through a dataset in memory: `values` north row first.
  template <class Value>
  std::string make(const std::string& name, const char* driver, int width, int height, GDALDataType type,
                   std::vector<Value> values, const std::vector<double>& geotransform = {},
                   const std::string& epsg = "", const double* nodata = nullptr, int bands = 1) const {
    GDALDatasetUniquePtr memory(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", width, height, bands, type, nullptr));
    if (!geotransform.empty()) memory->SetGeoTransform(const_cast<double*>(geotransform.data()));
    if (!epsg.empty()) {
      OGRSpatialReference crs;
      crs.SetFromUserInput(epsg.c_str());
      memory->SetSpatialRef(&crs);
    }
    const std::size_t cells = static_cast<std::size_t>(width) * height;
    for (int band = 1; band <= bands; ++band) {
      if (nodata) memory->GetRasterBand(band)->SetNoDataValue(*nodata);
      EXPECT_EQ(memory->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, width, height,
                                                      values.data() + (band - 1) * cells, width, height, type,
                                                      0, 0, nullptr),
                CE_None);
    }
    GDALDriver* maker = GetGDALDriverManager()->GetDriverByName(driver);
    EXPECT_NE(maker, nullptr) << driver;
    GDALDatasetUniquePtr file(
        maker->CreateCopy(path(name).c_str(), memory.get(), FALSE, nullptr, nullptr, nullptr));
    EXPECT_NE(file, nullptr) << driver;
    return path(name);
  }

  fs::path folder_;
};

/// What is said when the raster is refused; empty if it is not.
std::string refusal(const std::string& path, const RasterOptions& options = {}) {
  try {
    read_raster(path, options);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

void expect_says(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// 3 x 2 cells; on the map:  1 2 3   (north)
//                           4 5 6   (south, where the raster starts)
const std::vector<float> kNorthFirst{1, 2, 3, 4, 5, 6};
const std::vector<float> kSouthFirst{4, 5, 6, 1, 2, 3};
const std::vector<double> kPlaced{500000.25, 4.988744589, 0, 4100000.125, 0, -4.988744589};

TEST_F(RasterTest, GeoTiffNorthUp) {
  const Raster r = read_raster(make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst, kPlaced, "EPSG:32613"));
  EXPECT_EQ(r.width, 3);
  EXPECT_EQ(r.height, 2);
  EXPECT_EQ(r.values, kSouthFirst);
  EXPECT_EQ(r.cell_size, 4.988744589);
  EXPECT_EQ(r.origin_x, 500000.25);
  EXPECT_NEAR(r.origin_y, 4100000.125 - 2 * 4.988744589, 1e-8);
  EXPECT_NE(r.projection.find("UTM zone 13N"), std::string::npos) << r.projection;
  EXPECT_EQ(r.length_unit(), "metre");
  EXPECT_EQ(r.nodata_count(), 0);
}

TEST_F(RasterTest, SouthUpIsNotFlipped) {
  const Raster r = read_raster(make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst, {10, 2, 0, 20, 0, 2}));
  EXPECT_EQ(r.values, kNorthFirst);
  EXPECT_EQ(r.origin_x, 10);
  EXPECT_EQ(r.origin_y, 20);
  EXPECT_EQ(r.geotransform, (std::array<double, 6>{10, 2, 0, 24, 0, -2}));
}

TEST_F(RasterTest, GeotransformAndProjectionSurviveToTheBit) {
  // 1/3-like steps, a southern origin where the lower edge has fewer digits than the upper, nearly square
  // cells.
  const std::vector<std::vector<double>> placements{
      kPlaced, {1.0 / 3, 0.1, 0, -0.7, 0, -0.1}, {-7, 30.000001, 0, 0.123456789012345, 0, -30.000002}};
  for (const auto& placed : placements) {
    const std::string first = make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst, placed, "EPSG:32613");
    const Raster read = read_raster(first);
    write_geotiff(path("b.tif"), read);
    GDALDatasetUniquePtr before(GDALDataset::Open(first.c_str())),
        after(GDALDataset::Open(path("b.tif").c_str()));
    double g_before[6], g_after[6];
    ASSERT_EQ(before->GetGeoTransform(g_before), CE_None);
    ASSERT_EQ(after->GetGeoTransform(g_after), CE_None);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(g_before[i], g_after[i]) << "term " << i;
    EXPECT_TRUE(before->GetSpatialRef()->IsSame(after->GetSpatialRef()));
    EXPECT_EQ(read_raster(path("b.tif")).values, kSouthFirst);
  }
}

TEST_F(RasterTest, WritesWhatWasMadeOrMoved) {
  Raster r;
  r.width = 3;
  r.height = 2;
  r.cell_size = 0.5;
  r.origin_x = -4;
  r.origin_y = 7;
  r.values = {4, kNaN, 6, 1, 2, 3};
  write_geotiff(path("a.tif"), r);
  Raster back = read_raster(path("a.tif"));
  EXPECT_EQ(back.cell_size, 0.5);
  EXPECT_EQ(back.origin_x, -4);
  EXPECT_EQ(back.origin_y, 7);
  EXPECT_EQ(back.values[0], 4);
  EXPECT_TRUE(std::isnan(back.values[1]));
  EXPECT_EQ(back.values[5], 3);
  EXPECT_EQ(back.nodata_count(), 1);

  back.origin_x = 100;  // the geotransform that was read no longer holds
  write_geotiff(path("a.tif"), back);
  EXPECT_EQ(read_raster(path("a.tif")).origin_x, 100);

  GDALDatasetUniquePtr file(GDALDataset::Open(path("a.tif").c_str()));
  GDALRasterBand& band = *file->GetRasterBand(1);
  EXPECT_EQ(band.GetRasterDataType(), GDT_Float32);
  EXPECT_TRUE(std::isnan(band.GetNoDataValue()));
  float north_west = 0;
  ASSERT_EQ(band.RasterIO(GF_Read, 0, 0, 1, 1, &north_west, 1, 1, GDT_Float32, 0, 0, nullptr), CE_None);
  EXPECT_EQ(north_west, 1);
}

TEST_F(RasterTest, WritingLeavesNothingElseBehind) {
  Raster r;
  r.width = r.height = 1;
  r.values = {2};
  write_text("a.tif.aux.xml", "<PAMDataset><GeoTransform>9, 9, 0, 9, 0, -9</GeoTransform></PAMDataset>");
  write_geotiff(path("a.tif"), r);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_)) files += entry.exists();
  EXPECT_EQ(files, 1);

  fs::create_directory(folder_ / "taken.tif");
  fs::create_directory(folder_ / "taken.tif" / "inside");
  EXPECT_THROW(write_geotiff(path("taken.tif"), r), ConfigError);
  try {
    write_geotiff(path("no_such_folder/a.tif"), r);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    expect_says(error.what(), {"no_such_folder/a.tif", "cannot be written"});
  }
  for (const auto& entry : fs::directory_iterator(folder_)) EXPECT_NE(entry.path().extension(), ".part");
}

TEST_F(RasterTest, RefusesToWriteNonsense) {
  Raster r;
  r.width = 2;
  r.height = 2;
  r.values = {1, 2, 3};
  EXPECT_THROW(write_geotiff(path("a.tif"), r), ConfigError);
  r.values = {1, 2, 3, 4};
  r.cell_size = 0;
  EXPECT_THROW(write_geotiff(path("a.tif"), r), ConfigError);
  EXPECT_FALSE(fs::exists(path("a.tif")));
}

TEST_F(RasterTest, BandScaleAndOffset) {
  const std::string file =
      make("a.tif", "GTiff", 2, 1, GDT_Int16, std::vector<std::int16_t>{1, 2, 30, -40}, {}, "", nullptr, 2);
  EXPECT_EQ(read_raster(file).values, (std::vector<float>{1, 2}));
  EXPECT_EQ(read_raster(file, {2, 0.5, 100}).values, (std::vector<float>{115, 80}));
}

TEST_F(RasterTest, NoDataByValueNaNAndMask) {
  const double minus = -9999;
  const Raster a = read_raster(
      make("a.tif", "GTiff", 2, 2, GDT_Int16, std::vector<std::int16_t>{-9999, 1, 2, 3}, {}, "", &minus),
      {1, 2, 1});
  EXPECT_EQ(a.nodata_count(), 1);
  EXPECT_TRUE(std::isnan(a.values[2]));
  EXPECT_EQ(a.values[3], 3);

  const double lowest = -3.4028234663852886e+38;  // the usual float raster: its nodata is not exact in text
  const Raster b =
      read_raster(make("b.tif", "GTiff", 2, 1, GDT_Float32,
                       std::vector<float>{-std::numeric_limits<float>::max(), 1}, {}, "", &lowest));
  EXPECT_EQ(b.nodata_count(), 1);

  const Raster c = read_raster(make("c.tif", "GTiff", 2, 1, GDT_Float32, std::vector<float>{kNaN, 1}));
  EXPECT_EQ(c.nodata_count(), 1);

  const double infinite = -std::numeric_limits<double>::infinity();
  const Raster d = read_raster(make("d.tif", "GTiff", 2, 1, GDT_Float32,
                                    std::vector<float>{static_cast<float>(infinite), 1}, {}, "", &infinite));
  EXPECT_EQ(d.nodata_count(), 1);
}

TEST_F(RasterTest, EsriAscii) {
  const std::string head = "ncols 3\nnrows 2\nxllcorner 100.5\nyllcorner -20\ncellsize 4.988744589\n";
  const Raster a = read_raster(write_text("a.asc", head + "1.5 2 3\n4 5 6\n"));
  EXPECT_EQ(a.values, (std::vector<float>{4, 5, 6, 1.5, 2, 3}));
  EXPECT_EQ(a.cell_size, 4.988744589);
  EXPECT_EQ(a.origin_x, 100.5);
  EXPECT_NEAR(a.origin_y, -20, 1e-12);
  EXPECT_EQ(a.projection, "");
  EXPECT_EQ(a.length_unit(), "");

  const Raster b =
      read_raster(write_text("b.asc", head + "NODATA_value -9999\n1 2 3\n-9999 5 1.7266459960937500e+03\n"));
  EXPECT_TRUE(std::isnan(b.values[0]));
  EXPECT_EQ(b.values[2], 1726.64599609375F);
  EXPECT_EQ(b.nodata_count(), 1);
}

TEST_F(RasterTest, EnviRaw) {
  const float values[] = {1, 2, 3, 4, 5, 6};
  write_text("a", std::string(reinterpret_cast<const char*>(values), sizeof values));
  write_text("a.hdr",
             "ENVI\nsamples = 3\nlines = 2\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
             "byte order = 0\nmap info = {Arbitrary, 1, 1, 10, 20, 2.5, 2.5, 0, North}\n");
  const Raster r = read_raster(path("a"));
  EXPECT_EQ(r.values, kSouthFirst);
  EXPECT_EQ(r.cell_size, 2.5);
  EXPECT_EQ(r.origin_x, 10);
  EXPECT_EQ(r.origin_y, 15);
}

TEST_F(RasterTest, Png16HasUnitCells) {
  const std::string file =
      make("a.png", "PNG", 3, 2, GDT_UInt16, std::vector<std::uint16_t>{1, 2, 3, 4, 5, 65535});
  const Raster r = read_raster(file, {1, 0.01, -5});
  EXPECT_EQ(r.cell_size, 1);
  EXPECT_EQ(r.origin_x, 0);
  EXPECT_EQ(r.origin_y, 0);
  EXPECT_FLOAT_EQ(r.values[2], 650.35F);
  EXPECT_FLOAT_EQ(r.values[3], -4.99F);
  write_geotiff(path("a.tif"), r);
  EXPECT_EQ(read_raster(path("a.tif")).origin_y, 0);
}

TEST_F(RasterTest, Exr) {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  const float rgb[2][3][3] = {{{10, 20, 30}, {11, 21, 31}, {12, 22, 32}},
                              {{13, 23, 33}, {14, 24, 34}, {15, 25, 35}}};
  const float grey[2][3] = {{1, 2, 3}, {4, 5, 6}};
  if (!cv::imwrite(path("grey.exr"), cv::Mat(2, 3, CV_32FC1, const_cast<float(*)[3]>(grey))))
    GTEST_SKIP() << "OpenCV without OpenEXR";
  ASSERT_TRUE(cv::imwrite(path("rgb.EXR"), cv::Mat(2, 3, CV_32FC3, const_cast<float(*)[3][3]>(rgb))));
  EXPECT_EQ(read_raster(path("grey.exr")).values, kSouthFirst);
  EXPECT_EQ(read_raster(path("rgb.EXR"), {1, 1, 0}).values,
            (std::vector<float>{33, 34, 35, 30, 31, 32}));  // red
  EXPECT_EQ(read_raster(path("rgb.EXR"), {3, 1, 0}).values,
            (std::vector<float>{13, 14, 15, 10, 11, 12}));  // blue
  expect_says(refusal(path("grey.exr"), {5, 1, 0}), {"grey.exr", "band 5"});
  expect_says(refusal(write_text("bad.exr", "no picture")), {"bad.exr", "EXR"});

  const float infinite[2] = {1, std::numeric_limits<float>::infinity()};
  ASSERT_TRUE(cv::imwrite(path("inf.exr"), cv::Mat(1, 2, CV_32FC1, const_cast<float*>(infinite))));
  expect_says(refusal(path("inf.exr")), {"inf.exr", "1 values are infinite", "column 1, row 0"});
}

TEST_F(RasterTest, UsgsDem) {
  if (!GetGDALDriverManager()->GetDriverByName("USGSDEM")) GTEST_SKIP() << "GDAL without USGSDEM";
  std::vector<std::int16_t> values(20 * 10);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<std::int16_t>(100 + i);
  const std::string file =
      make("a.dem", "USGSDEM", 20, 10, GDT_Int16, values, {499995, 30, 0, 4100025, 0, -30}, "EPSG:26713");
  const Raster r = read_raster(file);
  ASSERT_EQ(r.width, 20);
  ASSERT_EQ(r.height, 10);
  EXPECT_EQ(r.cell_size, 30);
  EXPECT_EQ(r.length_unit(), "metre");
  EXPECT_EQ(r.values[0], 100 + 9 * 20);   // south-west
  EXPECT_EQ(r.values[9 * 20], 100);       // north-west
  EXPECT_EQ(r.values[9 * 20 + 19], 119);  // north-east
}

TEST_F(RasterTest, SaysWhenCellsAreInDegrees) {
  const Raster r = read_raster(
      make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst, {-105, 0.001, 0, 40, 0, -0.001}, "EPSG:4326"));
  EXPECT_EQ(r.length_unit(), "degree");
}

TEST_F(RasterTest, RefusesWhatIsNoRaster) {
  expect_says(refusal(path("missing.tif")), {"missing.tif", "no such file"});
  expect_says(refusal(write_text("notes.txt", "dunes are nice\n")), {"notes.txt", "not a raster"});
  expect_says(refusal(write_text("empty.tif", "")), {"empty.tif", "not a raster"});
  expect_says(refusal(path("")), {"not a raster"});  // a folder
}

TEST_F(RasterTest, RefusesBandScaleOffset) {
  const std::string file = make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst);
  expect_says(refusal(file, {2, 1, 0}), {"a.tif", "band 2", "1 to 1"});
  expect_says(refusal(file, {0, 1, 0}), {"a.tif", "band 0"});
  expect_says(refusal(file, {1, 0, 0}), {"a.tif", "scale is 0"});
  expect_says(refusal(file, {1, NAN, 0}), {"a.tif", "scale is nan"});
  expect_says(refusal(file, {1, 1, INFINITY}), {"a.tif", "offset is inf"});
}

TEST_F(RasterTest, RefusesGeotransforms) {
  const auto with = [&](const std::vector<double>& g) {
    return refusal(make("a.tif", "GTiff", 3, 2, GDT_Float32, kNorthFirst, g));
  };
  expect_says(with({0, 10, 0, 0, 0, -10.02}), {"a.tif", "not square", "10 x 10.02"});
  EXPECT_EQ(with({0, 10, 0, 0, 0, -10.005}), "");  // within 0.1 %
  expect_says(with({0, 10, 0.5, 0, 0.5, -10}), {"a.tif", "rotated", "0.5"});
  expect_says(with({0, -10, 0, 0, 0, -10}), {"a.tif", "-10"});
}

TEST_F(RasterTest, RefusesValues) {
  const float infinite = std::numeric_limits<float>::infinity();
  expect_says(
      refusal(make("a.tif", "GTiff", 3, 2, GDT_Float32, std::vector<float>{1, -infinite, 3, 4, 5, infinite})),
      {"a.tif", "2 values are infinite", "column 2, row 0"});
  expect_says(refusal(make("b.tif", "GTiff", 1, 1, GDT_Float64, std::vector<double>{1e300})),
              {"b.tif", "float32"});
  expect_says(refusal(make("c.tif", "GTiff", 2, 1, GDT_Float32, std::vector<float>{kNaN, kNaN})),
              {"c.tif", "all 2 cells are nodata"});
  expect_says(refusal(make("d.tif", "GTiff", 1, 1, GDT_CFloat32, std::vector<float>{1, 2})),
              {"d.tif", "complex", "CFloat32"});
}

TEST_F(RasterTest, RefusesSizes) {
  const std::string envi =
      "lines = 2\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\nbyte order = 0\n";
  write_text("a", std::string(24, '\0'));
  write_text("a.hdr", "ENVI\nsamples = 0\n" + envi);
  expect_says(refusal(path("a")), {"/a'"});
  const std::string huge = write_text("huge.vrt",
                                      "<VRTDataset rasterXSize=\"65536\" rasterYSize=\"65536\">"
                                      "<VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>");
  expect_says(refusal(huge), {"huge.vrt", "65536 x 65536", "2^31"});
}

TEST_F(RasterTest, RefusesTruncatedFiles) {
  std::vector<float> values(200 * 200);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(std::sin(i * 0.1));
  for (const char* name : {"a.tif", "a.asc"}) {
    const bool tiff = std::string(name) == "a.tif";
    const std::string file =
        make(name, tiff ? "GTiff" : "AAIGrid", 200, 200, GDT_Float32, values, {0, 1, 0, 200, 0, -1});
    fs::resize_file(file, fs::file_size(file) / 2);
    expect_says(refusal(file), {name});
  }
  write_text("short", std::string(40, '\1'));
  write_text("short.hdr",
             "ENVI\nsamples = 3\nlines = 20\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
             "byte order = 0\n");
  expect_says(refusal(path("short")), {"short'", "40 bytes of 240"});
}

TEST_F(RasterTest, GdalStaysQuiet) {
  ::testing::internal::CaptureStderr();
  refusal(write_text("notes.txt", "dunes are nice\n"));
  refusal(path("missing.tif"));
  refusal(write_text("broken.asc", "ncols 3\nnrows two\ncellsize 1\n1 2 3\n"));
  Raster r;
  r.width = r.height = 1;
  r.values = {1};
  r.projection = "nonsense";
  EXPECT_EQ(r.length_unit(), "");
  EXPECT_THROW(write_geotiff(path("no/a.tif"), r), ConfigError);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace desert_sim

// Every raster format, scales, and cells without data.

#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>

#include "src/io/raster.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

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

  const Raster c = read_raster(make("c.tif", "GTiff", 2, 1, GDT_Float32, std::vector<float>{nan_value, 1}));
  EXPECT_EQ(c.nodata_count(), 1);

  const double infinite = -std::numeric_limits<double>::infinity();
  const Raster d = read_raster(make("d.tif", "GTiff", 2, 1, GDT_Float32,
                                    std::vector<float>{static_cast<float>(infinite), 1}, {}, "", &infinite));
  EXPECT_EQ(d.nodata_count(), 1);
}

TEST_F(RasterTest, EsriAscii) {
  const std::string head = "ncols 3\nnrows 2\nxllcorner 100.5\nyllcorner -20\ncellsize 4.988744589\n";
  const Raster a = read_raster(folder_.write("a.asc", head + "1.5 2 3\n4 5 6\n"));
  EXPECT_EQ(a.values, (std::vector<float>{4, 5, 6, 1.5, 2, 3}));
  EXPECT_EQ(a.cell_size, 4.988744589);
  EXPECT_EQ(a.origin_x, 100.5);
  EXPECT_NEAR(a.origin_y, -20, 1e-12);
  EXPECT_EQ(a.projection, "");
  EXPECT_EQ(a.length_unit(), "");

  const Raster b = read_raster(
      folder_.write("b.asc", head + "NODATA_value -9999\n1 2 3\n-9999 5 1.7266459960937500e+03\n"));
  EXPECT_TRUE(std::isnan(b.values[0]));
  EXPECT_EQ(b.values[2], 1726.64599609375F);
  EXPECT_EQ(b.nodata_count(), 1);
}

TEST_F(RasterTest, EnviRaw) {
  const float values[] = {1, 2, 3, 4, 5, 6};
  folder_.write("a", std::string(reinterpret_cast<const char*>(values), sizeof values));
  folder_.write(
      "a.hdr",
      "ENVI\nsamples = 3\nlines = 2\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
      "byte order = 0\nmap info = {Arbitrary, 1, 1, 10, 20, 2.5, 2.5, 0, North}\n");
  const Raster r = read_raster(path("a"));
  EXPECT_EQ(r.values, south_first);
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
  EXPECT_EQ(read_raster(path("grey.exr")).values, south_first);
  EXPECT_EQ(read_raster(path("rgb.EXR"), {1, 1, 0}).values,
            (std::vector<float>{33, 34, 35, 30, 31, 32}));  // red
  EXPECT_EQ(read_raster(path("rgb.EXR"), {3, 1, 0}).values,
            (std::vector<float>{13, 14, 15, 10, 11, 12}));  // blue
  expect_says(refusal(path("grey.exr"), {5, 1, 0}), {"grey.exr", "band 5"});
  expect_says(refusal(folder_.write("bad.exr", "no picture")), {"bad.exr", "EXR"});

  const float infinite[2] = {1, std::numeric_limits<float>::infinity()};
  ASSERT_TRUE(cv::imwrite(path("inf.exr"), cv::Mat(1, 2, CV_32FC1, const_cast<float*>(infinite))));
  expect_says(refusal(path("inf.exr")), {"inf.exr", "1 values are infinite", "column 1, row 0"});
}

TEST_F(RasterTest, AnExrIsRefusedByTheSizeInItsHeader) {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);
  if (!cv::imwrite(path("a.exr"), cv::Mat(2, 3, CV_32FC1, cv::Scalar(1))))
    GTEST_SKIP() << "OpenCV without OpenEXR";
  std::string bytes = test::file_bytes(path("a.exr"));
  const std::string key("dataWindow\0box2i\0", 17);
  const std::size_t at = bytes.find(key);
  ASSERT_NE(at, std::string::npos);
  const std::int32_t window[] = {0, 0, 65535, 65535};
  bytes.replace(at + key.size() + 4, sizeof window,
                std::string(reinterpret_cast<const char*>(window), sizeof window));
  expect_says(refusal(folder_.write("huge.exr", bytes)), {"huge.exr", "65536 x 65536"});
  expect_says(refusal(folder_.write("cut.exr", bytes.substr(0, at + 3))), {"cut.exr", "not an EXR"});
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
      make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first, {-105, 0.001, 0, 40, 0, -0.001}, "EPSG:4326"));
  EXPECT_EQ(r.length_unit(), "degree");
}

}  // namespace
}  // namespace desert_sim

// What is refused as a raster, and what is said of it.

#include <unistd.h>

#include <cstdint>
#include <filesystem>

#include "src/io/raster.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

TEST_F(RasterTest, RefusesWhatIsNoRaster) {
  expect_says(refusal(path("missing.tif")), {"missing.tif", "no such file"});
  const std::string notes = folder_.write("notes.txt", "dunes are nice\n");
  expect_says(refusal(notes), {"notes.txt", "not a raster", ("`" + notes + "' not recognized").c_str()});
  expect_says(refusal(folder_.write("empty.tif", "")), {"empty.tif", "not a raster"});
  expect_says(refusal(path("")), {"not a regular file"});  // a folder
}

TEST_F(RasterTest, RefusesBandScaleOffset) {
  const std::string file = make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first);
  expect_says(refusal(file, {2, 1, 0}), {"a.tif", "band 2", "1 to 1"});
  expect_says(refusal(file, {0, 1, 0}), {"a.tif", "band 0"});
  expect_says(refusal(file, {1, 0, 0}), {"a.tif", "scale is 0"});
  expect_says(refusal(file, {1, NAN, 0}), {"a.tif", "scale is nan"});
  expect_says(refusal(file, {1, 1, INFINITY}), {"a.tif", "offset is inf"});
}

TEST_F(RasterTest, RefusesGeotransforms) {
  const auto with = [&](const std::vector<double>& g) {
    return refusal(make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first, g));
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
  expect_says(refusal(make("c.tif", "GTiff", 2, 1, GDT_Float32, std::vector<float>{nan_value, nan_value})),
              {"c.tif", "all 2 cells are nodata"});
  expect_says(refusal(make("d.tif", "GTiff", 1, 1, GDT_CFloat32, std::vector<float>{1, 2})),
              {"d.tif", "complex", "CFloat32"});
}

TEST_F(RasterTest, RefusesSizes) {
  const std::string envi =
      "lines = 2\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\nbyte order = 0\n";
  folder_.write("a", std::string(24, '\0'));
  folder_.write("a.hdr", "ENVI\nsamples = 0\n" + envi);
  expect_says(refusal(path("a")), {"/a'"});
  const std::string huge = folder_.write("huge.vrt",
                                         "<VRTDataset rasterXSize=\"65536\" rasterYSize=\"65536\">"
                                         "<VRTRasterBand dataType=\"Byte\" band=\"1\"/></VRTDataset>");
  expect_says(refusal(huge, {}, {"", true}), {"huge.vrt", "65536 x 65536", "2^31"});
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
  folder_.write("short", std::string(40, '\1'));
  folder_.write(
      "short.hdr",
      "ENVI\nsamples = 3\nlines = 20\nbands = 1\nheader offset = 0\ndata type = 4\ninterleave = bsq\n"
      "byte order = 0\n");
  expect_says(refusal(path("short")), {"short'", "40 bytes of 240"});
}

TEST_F(RasterTest, GdalStaysQuiet) {
  ::testing::internal::CaptureStderr();
  refusal(folder_.write("notes.txt", "dunes are nice\n"));
  refusal(path("missing.tif"));
  refusal(folder_.write("broken.asc", "ncols 3\nnrows two\ncellsize 1\n1 2 3\n"));
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

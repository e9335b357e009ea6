// Reading and writing rasters: orientation, geotransform, what is left behind.

#include "src/io/raster.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "test/support/full_disk.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

TEST_F(RasterTest, GeoTiffNorthUp) {
  const Raster r = read_raster(make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first, placed, "EPSG:32613"));
  EXPECT_EQ(r.width, 3);
  EXPECT_EQ(r.height, 2);
  EXPECT_EQ(r.values, south_first);
  EXPECT_EQ(r.cell_size, 4.988744589);
  EXPECT_EQ(r.origin_x, 500000.25);
  EXPECT_NEAR(r.origin_y, 4100000.125 - 2 * 4.988744589, 1e-8);
  EXPECT_NE(r.projection.find("UTM zone 13N"), std::string::npos) << r.projection;
  EXPECT_EQ(r.length_unit(), "metre");
  EXPECT_EQ(r.nodata_count(), 0);
}

TEST_F(RasterTest, SouthUpIsNotFlipped) {
  const Raster r = read_raster(make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first, {10, 2, 0, 20, 0, 2}));
  EXPECT_EQ(r.values, north_first);
  EXPECT_EQ(r.origin_x, 10);
  EXPECT_EQ(r.origin_y, 20);
  EXPECT_EQ(r.geotransform, (std::array<double, 6>{10, 2, 0, 24, 0, -2}));
}

TEST_F(RasterTest, GeotransformAndProjectionSurviveToTheBit) {
  // 1/3-like steps, a southern origin where the lower edge has fewer digits than the upper, nearly square
  // cells.
  const std::vector<std::vector<double>> placements{
      placed, {1.0 / 3, 0.1, 0, -0.7, 0, -0.1}, {-7, 30.000001, 0, 0.123456789012345, 0, -30.000002}};
  for (const auto& placed : placements) {
    const std::string first = make("a.tif", "GTiff", 3, 2, GDT_Float32, north_first, placed, "EPSG:32613");
    const Raster read = read_raster(first);
    write_geotiff(path("b.tif"), read);
    GDALDatasetUniquePtr before(GDALDataset::Open(first.c_str())),
        after(GDALDataset::Open(path("b.tif").c_str()));
    double g_before[6], g_after[6];
    ASSERT_EQ(before->GetGeoTransform(g_before), CE_None);
    ASSERT_EQ(after->GetGeoTransform(g_after), CE_None);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(g_before[i], g_after[i]) << "term " << i;
    EXPECT_TRUE(before->GetSpatialRef()->IsSame(after->GetSpatialRef()));
    EXPECT_EQ(read_raster(path("b.tif")).values, south_first);
  }
}

TEST_F(RasterTest, WritesWhatWasMadeOrMoved) {
  Raster r;
  r.width = 3;
  r.height = 2;
  r.cell_size = 0.5;
  r.origin_x = -4;
  r.origin_y = 7;
  r.values = {4, nan_value, 6, 1, 2, 3};
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
  folder_.write("a.tif.aux.xml", "<PAMDataset><GeoTransform>9, 9, 0, 9, 0, -9</GeoTransform></PAMDataset>");
  write_geotiff(path("a.tif"), r);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(path("."))) files += entry.exists();
  EXPECT_EQ(files, 1);

  fs::create_directory(path("taken.tif"));
  fs::create_directory(path("taken.tif/inside"));
  EXPECT_THROW(write_geotiff(path("taken.tif"), r), ConfigError);
  try {
    write_geotiff(path("no_such_folder/a.tif"), r);
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    expect_says(error.what(), {"no_such_folder/a.tif", "cannot be written"});
  }
  for (const auto& entry : fs::directory_iterator(path("."))) EXPECT_NE(entry.path().extension(), ".part");
}

TEST_F(RasterTest, DoesNotFollowLinksThatSomebodyHasPlanted) {
  Raster r;
  r.width = r.height = 1;
  r.values = {2};
  folder_.write("victim", "precious");
  for (int n = 0; n < 100; ++n)
    fs::create_symlink(path("victim"),
                       path("a.tif." + std::to_string(getpid()) + "-" + std::to_string(n) + ".part"));
  write_geotiff(path("a.tif"), r);
  EXPECT_EQ(read_raster(path("a.tif")).values, r.values);
  EXPECT_EQ(test::file_bytes(path("victim")), "precious");
  fs::create_symlink(path("victim"), path("link.tif"));
  EXPECT_THROW(write_geotiff(path("link.tif"), r), ConfigError);
  EXPECT_TRUE(fs::is_symlink(path("link.tif")));
}

TEST_F(RasterTest, OnAFullDiskIsNotWrittenAndLeavesNothing) {
  Raster r;
  r.width = r.height = 100;
  for (int i = 0; i < 10000; ++i) r.values.push_back(std::sin(static_cast<float>(i) * i));
  folder_.write("a.tif", "old");
  {
    const test::FullDisk disk(5000);
    EXPECT_THROW(write_geotiff(path("a.tif"), r), WriteError);
  }
  EXPECT_EQ(test::file_bytes(path("a.tif")), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(path(".")), fs::directory_iterator()), 1);
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

}  // namespace
}  // namespace desert_sim

// What lies beside a raster, or is said in its header, and GDAL leaves out in silence.
#include "src/io/raster_companions.hpp"

#include <filesystem>
#include <fstream>

#include "test/support/log_lines.hpp"
#include "test/support/raster_test.hpp"

namespace desert_sim {
namespace {

class Companions : public RasterTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::string dem(const std::string& name, const char* driver = "GTiff") const {
    return make(name, driver, 3, 2, GDT_Float32, north_first, placed);
  }
  static std::vector<std::string> warnings_of(const std::string& file, const RasterAccess& access = {}) {
    test::LogLines log;
    read_raster(file, {}, access);
    return log.lines;
  }
};

TEST_F(Companions, AMaskThatCannotBeReadIsRefused) {
  const std::string file = dem("masked.tif");
  write("masked.tif.msk", "no raster");
  for (bool all_formats : {false, true})
    expect_says(refusal(file, {}, {"", all_formats}), {"masked.tif.msk", "cannot be read"});
}

TEST_F(Companions, AProjectionThatIsNotUnderstoodIsWarnedOf) {
  const std::string file = dem("dem.asc", "AAIGrid");
  EXPECT_TRUE(warnings_of(file).empty());
  write("dem.prj", "PROJCS[nonsense");
  const std::vector<std::string> lines = warnings_of(file);
  ASSERT_EQ(lines.size(), 1u);
  expect_says(lines[0], {"dem.asc", "(.prj) is not understood"});
}

TEST_F(Companions, UnitsOfHeightsByArcInfoAreApplied) {
  const std::string file = dem("dem.asc", "AAIGrid");
  const auto first = [&](const std::string& zunits) {
    write("dem.prj", "Projection    UTM\nZone          33\nDatum         WGS84\nZunits        " + zunits +
                         "\nUnits         METERS\nXshift        0.0\nYshift        0.0\nParameters\n");
    return read_raster(file).values[0];
  };
  EXPECT_FLOAT_EQ(first("NO"), 4);
  EXPECT_FLOAT_EQ(first("METERS"), 4);
  EXPECT_FLOAT_EQ(first("FEET"), 4 * 0.3048F);
}

TEST_F(Companions, ARawFileThatIsLongerThanItsHeaderSaysIsWarnedOf) {
  const std::string file = dem("dem.bin", "ENVI");
  EXPECT_TRUE(warnings_of(file).empty());
  std::ofstream(file, std::ios::binary | std::ios::app) << "1234";
  const std::vector<std::string> lines = warnings_of(file);
  ASSERT_EQ(lines.size(), 1u);
  expect_says(lines[0], {"dem.bin", "28 bytes", "24", "3 samples, 2 lines"});
}

/// GDAL before 3.7 reads -5 as 251.
TEST_F(Companions, SignedBytesAreSigned) {
  const std::string file = path("bytes.tif");
  {
    const char* options[] = {"PIXELTYPE=SIGNEDBYTE", nullptr};
    const GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        file.c_str(), 3, 1, 1, GDT_Byte, const_cast<char**>(options)));
    dataset->GetRasterBand(1)->SetNoDataValue(-1);
    std::vector<unsigned char> bytes{251, 255, 100};
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 3, 1, bytes.data(), 3, 1, GDT_Byte, 0, 0,
                                                  nullptr),
              CE_None);
  }
  const Raster r = read_raster(file);
  EXPECT_EQ(r.values[0], -5);
  EXPECT_TRUE(std::isnan(r.values[1]));
  EXPECT_EQ(r.values[2], 100);
}

/// WGS 84 / UTM 33 N with depths below mean sea level.
TEST_F(Companions, DepthsAreRefusedUntilTheyAreTurned) {
  const std::string file = make("depth.tif", "GTiff", 3, 2, GDT_Float32, north_first,
                                {500000, 10, 0, 4000000, 0, -10}, "EPSG:32633+5715");
  expect_says(refusal(file), {"depth.tif", "points down", "scale: -1"});
  EXPECT_EQ(read_raster(file, {1, -1}).values[0], -4);
}

}  // namespace
}  // namespace desert_sim

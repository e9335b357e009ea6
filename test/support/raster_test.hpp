#pragma once
/// Rasters of every format, made by GDAL, for the tests of reading them.

#include <gdal_priv.h>
#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "src/core/error.hpp"
#include "src/io/raster.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

class RasterTest : public ::testing::Test {
 protected:
  void SetUp() override { GDALAllRegister(); }

  std::string path(const std::string& name) const { return folder_.path(name); }

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

  const test::TemporaryFolder folder_;
};

/// What is said when the raster is refused; empty if it is not.
inline std::string refusal(const std::string& path, const RasterOptions& options = {},
                           const RasterAccess& access = {}) {
  try {
    read_raster(path, options, access);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

inline void expect_says(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// 3 x 2 cells; on the map:  1 2 3   (north)
//                           4 5 6   (south, where the raster starts)
inline const std::vector<float> north_first{1, 2, 3, 4, 5, 6};
inline const std::vector<float> south_first{4, 5, 6, 1, 2, 3};
inline const std::vector<double> placed{500000.25, 4.988744589, 0, 4100000.125, 0, -4.988744589};

}  // namespace desert_sim

#pragma once

#include <array>
#include <string>
#include <vector>

namespace desert_sim {

/// A single-band raster in this package's orientation: row-major, x fastest, row 0 = SOUTH (GDAL's row 0 is
/// north).
struct Raster {
  int width = 0, height = 0;
  double cell_size = 1;               ///< side of a square cell [unit of the CRS, see length_unit()]
  double origin_x = 0, origin_y = 0;  ///< lower-left corner of the lower-left cell [unit of the CRS]
  std::string projection;             ///< WKT, empty if none
  std::vector<float> values;          ///< width * height values, NaN where nodata

  /// The north-up geotransform of the file this was read from, all zero if none. write_geotiff() uses it as
  /// long as it still says what cell_size and origin say, so that reading and writing keeps it to the bit.
  std::array<double, 6> geotransform{};

  /// Number of NaN values.
  long nodata_count() const;
  /// Unit of cell_size and origin by the projection: "metre", "degree" (a geographic CRS: this is no metric
  /// grid), another linear unit by its name, or empty where there is no projection.
  std::string length_unit() const;
};

/// How the numbers in a file become values: value = raw * scale + offset. Scale and offset that the file
/// itself declares for a band are not applied, as in GDAL.
struct RasterOptions {
  int band = 1;  ///< counted from 1; of an EXR picture read by OpenCV: R, G, B, A
  double scale = 1, offset = 0;
};

/// Reads one band of any raster that GDAL can open (GeoTIFF, ESRI ASCII, USGS DEM, ENVI raw, 16-bit PNG,
/// ...). EXR goes through OpenCV where GDAL has no driver for it. A raster without geotransform gets
/// cell_size 1 and origin 0; south-up rasters are turned. Masked and nodata cells become NaN. Throws
/// ConfigError, naming the file and the reason: file missing or not a raster, no such band, zero size or more
/// than 2^31 cells, a rotated or mirrored geotransform, cells not square to 0.1 %, complex numbers, infinite
/// values, nodata everywhere, scale or offset not finite or scale zero, or what GDAL says.
Raster read_raster(const std::string& path, const RasterOptions& options = {});

/// Writes a float32 GeoTIFF, north up, nodata NaN, with geotransform and projection. The file is written to a
/// temporary name in the same folder and renamed. Throws ConfigError; the file of that name is then as
/// before.
void write_geotiff(const std::string& path, const Raster& raster);

}  // namespace desert_sim

#pragma once
/// Reads and writes single-band rasters through GDAL.

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "src/scenario/raster_encoding.hpp"

namespace desert_sim {

/// Stands for missing data, here and in the files that are written.
constexpr float no_data = std::numeric_limits<float>::quiet_NaN();

/// What the band that is read declares of its numbers: a unit, or that they are the red of colours.
struct DeclaredBand {
  bool has_unit = false, is_colour = false;
};

/// A single-band raster in this package's orientation: row-major, x fastest, row 0 = SOUTH (in GDAL, row 0 is
/// the northern row).
struct Raster {
  int width = 0, height = 0;
  double cell_size = 1;               ///< side of a square cell [unit of the CRS, see length_unit()]
  double origin_x = 0, origin_y = 0;  ///< lower-left corner of the lower-left cell [unit of the CRS]
  std::string projection;             ///< WKT, empty if none
  std::vector<float> values;          ///< width * height values, no_data where missing

  /// The north-up geotransform of the file that the raster was read from; all zero if there is none.
  /// write_geotiff() writes it unchanged as long as it agrees with cell_size and origin, so that reading and
  /// writing a raster preserves its geotransform exactly.
  std::array<double, 6> geotransform{};

  /// Why the file's own placement cannot be used, with the command that helps; empty if it can, or if it has
  /// none.
  std::string unusable_placement;
  DeclaredBand declared = {};

  /// Number of NaN values.
  long nodata_count() const;
  /// Unit of cell_size and origin by the projection: "metre", "degree" (a geographic CRS, so that the grid is
  /// not metric), the name of another linear unit, or empty if there is no projection.
  std::string length_unit() const;
};

/// The band to read and the conversion of its numbers: value = (what the file declares) * scale + offset. The
/// file declares raw * its scale + its offset, in its unit, of which metres are made (declared_values()).
struct RasterOptions {
  int band = 1;  ///< counted from 1; for EXR files read by OpenCV: R, G, B, A
  double scale = 1, offset = 0;
  std::optional<double> nodata = {};  ///< a raw number that stands for missing data, besides the declared one
  RasterEncoding encoding = RasterEncoding::values;
  bool complete = false;  ///< every cell has data: no number is suspected to stand for missing data
};

/// Which rasters may be read. By default files of the formats GeoTIFF, ESRI ASCII (AAIGrid), ENVI, PNG, EXR
/// and USGS DEM, with their companions (.hdr, .prj, .msk, world files); they cannot make GDAL read anything
/// else.
struct RasterAccess {
  std::string folder;        ///< only files below it, as in InputFile; empty: any file
  bool all_formats = false;  ///< whatever GDAL reads, also what names other files or hosts; needs no folder
};

/// Reads one band of a raster. EXR goes through OpenCV where GDAL has no driver for it. A raster without
/// geotransform gets cell_size 1 and origin 0; south-up rasters are flipped. Masked and nodata cells become
/// NaN. Throws ConfigError that names the file and the reason: the file is missing, may not be read or is not
/// a raster, there is no such band, the size is zero, more than 2^31 cells or more than the memory holds, the
/// geotransform is rotated or mirrored, cells are not square to 0.1 %, numbers are complex, values are
/// infinite, all cells are nodata, scale or offset is not finite, scale is zero, colours or indices of a
/// palette are taken for values, PROJ has no database to understand the projection with, or GDAL reports an
/// error.
Raster read_raster(const std::string& path, const RasterOptions& options = {},
                   const RasterAccess& access = {});

/// Writes a float32 GeoTIFF, north up, with NaN as nodata value, geotransform and projection. The data go
/// through a TemporaryFile. Throws ConfigError if the path or the raster cannot be written, WriteError if
/// the disk is full or broken; an existing file of that name is then unchanged. Without `declare_no_data` no
/// value stands for missing data, for programs that take NaN for all values.
void write_geotiff(const std::string& path, const Raster& raster, bool declare_no_data = true);

/// Writes the values as an EXR file of one channel of 32-bit floats, north up, without a place. Throws like
/// write_file(), ConfigError that names the file if OpenCV has no EXR, and WriteError if it cannot make one.
void write_exr(const std::string& path, const Raster& raster);

}  // namespace desert_sim

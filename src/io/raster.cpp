#include "src/io/raster.hpp"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "src/core/temporary_file.hpp"
#include "src/io/gdal_messages.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {
namespace {

/// The geotransform to write: the recorded one if it agrees with cell_size and origin, otherwise one that is
/// computed from them.
GeoTransform geotransform_of(const Raster& raster) {
  Raster recorded;
  recorded.height = raster.height;
  set_geotransform(recorded, raster.geotransform);
  if (recorded.cell_size == raster.cell_size && recorded.origin_x == raster.origin_x &&
      recorded.origin_y == raster.origin_y)
    return raster.geotransform;
  const double top = raster.origin_y + raster.height * raster.cell_size;
  return {raster.origin_x, raster.cell_size, 0, top, 0, -raster.cell_size};
}

void check_writable(const std::string& path, const Raster& raster) {
  check_raster_shape(path, raster.width, raster.height, 1, 1);
  if (raster.values.size() != static_cast<std::size_t>(raster.width) * raster.height)
    throw_raster_error(path, concatenate("cannot be written with ", raster.values.size(), " values: ",
                                         raster.width, " x ", raster.height, " cells need one value each"));
  if (!(raster.cell_size > 0) || !std::isfinite(raster.cell_size + raster.origin_x + raster.origin_y))
    throw_raster_error(
        path, concatenate("cannot be written with cell_size ", raster.cell_size, " and origin ",
                          raster.origin_x, ", ", raster.origin_y, "; must be finite, cell_size > 0"));
}

/// A file of GDAL's in memory, which goes with this object. Not every version of GDAL reports that a disk is
/// full (3.10 does not), so what it makes comes to the disk by our own means.
class MemoryFile {
 public:
  MemoryFile() : folder_("/vsimem/desert_sim_" + std::to_string(next_number())) {}
  ~MemoryFile() { VSIRmdirRecursive(folder_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return folder_ + "/raster.tif"; }
  /// Empty if there is no such file, or if GDAL has put what does not fit into it into another one.
  std::string_view bytes() const {
    const CPLStringList names(VSIReadDir(folder_.c_str()));
    if (names.size() != 1) return {};
    vsi_l_offset size = 0;
    const GByte* const found = VSIGetMemFileBuffer(path().c_str(), &size, FALSE);
    return {reinterpret_cast<const char*>(found), found ? static_cast<std::size_t>(size) : 0};
  }

 private:
  static std::uint64_t next_number() {
    static std::atomic<std::uint64_t> number{0};
    return ++number;
  }
  const std::string folder_;
};

/// Writes a GeoTIFF to `path`; false if GDAL reported a failure, which can also happen on closing the file.
bool write_dataset(const std::string& path, const Raster& raster, bool declare_no_data,
                   GdalMessages& messages) {
  const char* settings[] = {"COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=1", "BIGTIFF=IF_SAFER", nullptr};
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (!driver) return false;
  GDALDatasetUniquePtr dataset(driver->Create(path.c_str(), raster.width, raster.height, 1, GDT_Float32,
                                              const_cast<char**>(settings)));
  if (!dataset) return false;
  GeoTransform g = geotransform_of(raster);
  dataset->SetGeoTransform(g.data());
  if (!raster.projection.empty()) dataset->SetProjection(raster.projection.c_str());
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  if (declare_no_data) band.SetNoDataValue(no_data);
  for (int row = 0; row < raster.height && !messages.failed(); ++row) {
    float* values = const_cast<float*>(raster.values.data()) + static_cast<std::size_t>(row) * raster.width;
    if (band.RasterIO(GF_Write, 0, raster.height - 1 - row, raster.width, 1, values, raster.width, 1,
                      GDT_Float32, 0, 0, nullptr) != CE_None)
      return false;
  }
  dataset.reset();
  return !messages.failed();
}

}  // namespace

void check_raster_shape(const std::string& path, std::int64_t width, std::int64_t height, int bands,
                        int band) {
  constexpr std::int64_t max_cells = std::int64_t{1} << 31;
  if (bands < 1) throw_raster_error(path, "has no raster band");
  if (band < 1 || band > bands)
    throw_raster_error(
        path, concatenate("band ", band, " is requested, but the raster has the bands 1 to ", bands));
  if (width < 1 || height < 1)
    throw_raster_error(path, concatenate("size is ", width, " x ", height, " cells, must be at least 1 x 1"));
  if (width > max_cells / height)
    throw_raster_error(
        path, concatenate("size is ", width, " x ", height, " cells, at most 2^31 cells are allowed"));
}

GeoTransform default_geotransform(int height) { return {0, 1, 0, static_cast<double>(height), 0, -1}; }

void set_geotransform(Raster& raster, const GeoTransform& g) {
  raster.geotransform = g;
  raster.cell_size = 0.5 * (g[1] - g[5]);
  raster.origin_x = g[0];
  raster.origin_y = g[3] + raster.height * g[5];
}

long Raster::nodata_count() const {
  return static_cast<long>(
      std::count_if(values.begin(), values.end(), [](float v) { return std::isnan(v); }));
}

std::string Raster::length_unit() const {
  if (projection.empty()) return "";
  GdalMessages messages;
  OGRSpatialReference crs;
  if (crs.importFromWkt(projection.c_str()) != OGRERR_NONE) return "";
  if (crs.IsGeographic()) return "degree";
  const char* name = nullptr;
  crs.GetLinearUnits(&name);
  return name ? name : "";
}

void write_geotiff(const std::string& path, const Raster& raster, bool declare_no_data) {
  check_writable(path, raster);
  TemporaryFile file(path);
  GdalMessages messages;
  const MemoryFile written;
  if (!write_dataset(written.path(), raster, declare_no_data, messages) || written.bytes().empty())
    throw WriteError(concatenate("raster '", path, "': cannot be written: ", messages.text()));
  file.write(written.bytes());
  file.publish();
  std::error_code error;
  std::filesystem::remove(path + ".aux.xml", error);  // GDAL's metadata of the replaced file
  if (error) throw WriteError(path + ".aux.xml: cannot be removed: " + error.message());
}

}  // namespace desert_sim

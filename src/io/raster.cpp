#include "src/io/raster.hpp"

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "src/core/error.hpp"
#include "src/core/temporary_file.hpp"
#include "src/io/gdal_messages.hpp"

namespace desert_sim {
namespace {

constexpr double kSquareTolerance = 1e-3;    // relative difference of cell width and height
constexpr double kRotationTolerance = 1e-6;  // shear [cells per cell]
constexpr std::int64_t kMaxCells = std::int64_t{1} << 31;
constexpr float kNoData = std::numeric_limits<float>::quiet_NaN();
/// As in GDAL: x = g0 + g1 column + g2 row, y = g3 + g4 column + g5 row.
using GeoTransform = std::array<double, 6>;

[[noreturn]] void throw_error(const std::string& path, const std::string& reason) {
  throw ConfigError("raster '" + path + "': " + reason);
}

template <class... Parts>
std::string concatenate(const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  (text << ... << parts);
  return text.str();
}

void check_options(const std::string& path, const RasterOptions& options) {
  if (!std::isfinite(options.scale) || options.scale == 0)
    throw_error(path, concatenate("scale is ", options.scale, ", must be finite and not 0"));
  if (!std::isfinite(options.offset))
    throw_error(path, concatenate("offset is ", options.offset, ", must be finite"));
}

void check_shape(const std::string& path, std::int64_t width, std::int64_t height, int bands, int band) {
  if (bands < 1) throw_error(path, "has no raster band");
  if (band < 1 || band > bands)
    throw_error(path, concatenate("band ", band, " is requested, but the raster has the bands 1 to ", bands));
  if (width < 1 || height < 1)
    throw_error(path, concatenate("size is ", width, " x ", height, " cells, must be at least 1 x 1"));
  if (width * height > kMaxCells)
    throw_error(path,
                concatenate("size is ", width, " x ", height, " cells, at most 2^31 cells are allowed"));
}

/// Geotransform of a raster that has none: cells of size 1, lower-left corner at (0, 0), north up.
GeoTransform default_geotransform(int height) { return {0, 1, 0, static_cast<double>(height), 0, -1}; }

/// The dataset's geotransform, flipped to north-up; `south_up` is set if it had to be flipped.
GeoTransform north_up_geotransform(const std::string& path, GDALDataset& dataset, bool& south_up) {
  const GeoTransform none{0, 1, 0, 0, 0, 1};
  GeoTransform g = none;
  south_up = false;
  const int height = dataset.GetRasterYSize();
  if (dataset.GetGeoTransform(g.data()) != CE_None || g == none) return default_geotransform(height);
  for (double term : g)
    if (!std::isfinite(term))
      throw_error(path, concatenate("geotransform has the value ", term, ", must be finite"));
  if (std::max(std::abs(g[2]), std::abs(g[4])) >
      kRotationTolerance * std::max(std::abs(g[1]), std::abs(g[5])))
    throw_error(path, concatenate("geotransform is rotated (row and column terms ", g[2], ", ", g[4],
                                  "), must be 0"));
  if (g[1] <= 0 || g[5] == 0)
    throw_error(path, concatenate("cells are ", g[1], " x ", std::abs(g[5]),
                                  ", the width must be > 0 and the height not 0"));
  if (std::abs(g[1] - std::abs(g[5])) > kSquareTolerance * g[1])
    throw_error(path, concatenate("cells are not square: ", g[1], " x ", std::abs(g[5]),
                                  ", at most 0.1 % of difference allowed"));
  if (g[5] > 0) {
    south_up = true;
    g[3] += height * g[5];
    g[5] = -g[5];
  }
  g[2] = g[4] = 0;
  return g;
}

/// Sets the raster's geotransform, and its cell_size and origin accordingly.
void set_geotransform(Raster& raster, const GeoTransform& g) {
  raster.geotransform = g;
  raster.cell_size = 0.5 * (g[1] - g[5]);
  raster.origin_x = g[0];
  raster.origin_y = g[3] + raster.height * g[5];
}

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

float value_of(double raw, const RasterOptions& options) {
  return static_cast<float>(raw * options.scale + options.offset);
}

void read_band(const std::string& path, GDALRasterBand& band, const RasterOptions& options, bool south_up,
               Raster& raster, GdalMessages& messages) {
  const int width = raster.width, height = raster.height;
  GDALRasterBand* mask = (band.GetMaskFlags() & GMF_ALL_VALID) ? nullptr : band.GetMaskBand();
  std::vector<double> raw(width);
  std::vector<GByte> valid(width, 255);
  messages.clear();
  for (int line = 0; line < height; ++line) {
    CPLErr status =
        band.RasterIO(GF_Read, 0, line, width, 1, raw.data(), width, 1, GDT_Float64, 0, 0, nullptr);
    if (status == CE_None && mask)
      status = mask->RasterIO(GF_Read, 0, line, width, 1, valid.data(), width, 1, GDT_Byte, 0, 0, nullptr);
    if (status != CE_None || messages.failed())
      throw_error(path,
                  concatenate("cannot be read at line ", line + 1, " of ", height, ": ", messages.text()));
    const int row = south_up ? line : height - 1 - line;
    float* out = raster.values.data() + static_cast<std::size_t>(row) * width;
    for (int x = 0; x < width; ++x) out[x] = valid[x] ? value_of(raw[x], options) : kNoData;
  }
}

void check_values(const std::string& path, const Raster& raster) {
  std::size_t infinite = 0, first = 0, finite = 0;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    if (std::isinf(raster.values[i]) && infinite++ == 0) first = i;
    finite += std::isfinite(raster.values[i]);
  }
  if (infinite > 0)
    throw_error(path, concatenate(infinite, " values are infinite or beyond float32, the first at column ",
                                  first % raster.width, ", row ", first / raster.width,
                                  " (row 0 = south), must be finite"));
  if (finite == 0)
    throw_error(path,
                concatenate("all ", raster.values.size(), " cells are nodata, at least one value is needed"));
}

bool is_exr_without_driver(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".exr" && !GetGDALDriverManager()->GetDriverByName("EXR");
}

Raster read_exr(const std::string& path, const RasterOptions& options) {
  static std::once_flag once;  // OpenCV reads this variable once, at its first EXR file
  std::call_once(once, [] { setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0); });
  cv::Mat picture;
  try {
    picture = cv::imread(path, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& error) {
    throw_error(path, "OpenCV cannot read this EXR file: " + error.err);
  }
  if (picture.empty()) throw_error(path, "is not an EXR file that OpenCV can read");
  const int channels = picture.channels();
  check_shape(path, picture.cols, picture.rows, channels, options.band);
  // OpenCV orders the channels B, G, R, A.
  const int channel = channels >= 3 && options.band <= 3 ? 3 - options.band : options.band - 1;
  cv::Mat numbers;
  picture.convertTo(numbers, CV_64F);
  Raster raster;
  raster.width = picture.cols;
  raster.height = picture.rows;
  set_geotransform(raster, default_geotransform(raster.height));
  raster.values.reserve(picture.total());
  for (int row = raster.height - 1; row >= 0; --row)
    for (int x = 0; x < raster.width; ++x)
      raster.values.push_back(value_of(numbers.ptr<double>(row)[x * channels + channel], options));
  return raster;
}

/// Refuses a truncated raw file (ENVI, EHdr), because GDAL would read the missing part as zeros.
void check_raw_file(const std::string& path, GDALDataset& dataset) {
  const std::string driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  const char* compressed = dataset.GetMetadataItem("file_compression", "ENVI");
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if ((driver != "ENVI" && driver != "EHdr") || (compressed && std::string(compressed) != "0") ||
      band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE"))
    return;
  const char* header = dataset.GetMetadataItem("header_offset", "ENVI");
  const std::uintmax_t cells =
      static_cast<std::uintmax_t>(dataset.GetRasterXSize()) * dataset.GetRasterYSize();
  const std::uintmax_t needed =
      cells * dataset.GetRasterCount() * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) +
      (header ? std::strtoull(header, nullptr, 10) : 0);
  std::error_code error;
  const std::uintmax_t found = std::filesystem::file_size(path, error);
  if (!error && found < needed)
    throw_error(path, concatenate("is truncated: it has ", found, " bytes of ", needed));
}

Raster read_by_gdal(const std::string& path, const RasterOptions& options) {
  GdalMessages messages;
  GDALDatasetUniquePtr dataset(GDALDataset::FromHandle(GDALOpenEx(
      path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr, nullptr, nullptr)));
  if (!dataset) throw_error(path, "is not a raster that GDAL can open: " + messages.text());
  check_shape(path, dataset->GetRasterXSize(), dataset->GetRasterYSize(), dataset->GetRasterCount(),
              options.band);
  GDALRasterBand& band = *dataset->GetRasterBand(options.band);
  if (GDALDataTypeIsComplex(band.GetRasterDataType()))
    throw_error(path, concatenate("band ", options.band, " has complex numbers (",
                                  GDALGetDataTypeName(band.GetRasterDataType()), "), must be real"));
  check_raw_file(path, *dataset);
  Raster raster;
  raster.width = dataset->GetRasterXSize();
  raster.height = dataset->GetRasterYSize();
  bool south_up = false;
  set_geotransform(raster, north_up_geotransform(path, *dataset, south_up));
  if (const char* wkt = dataset->GetProjectionRef()) raster.projection = wkt;
  raster.values.resize(static_cast<std::size_t>(raster.width) * raster.height);
  read_band(path, band, options, south_up, raster, messages);
  return raster;
}

void check_writable(const std::string& path, const Raster& raster) {
  check_shape(path, raster.width, raster.height, 1, 1);
  if (raster.values.size() != static_cast<std::size_t>(raster.width) * raster.height)
    throw_error(path, concatenate("cannot be written with ", raster.values.size(), " values: ", raster.width,
                                  " x ", raster.height, " cells need one value each"));
  if (!(raster.cell_size > 0) || !std::isfinite(raster.cell_size + raster.origin_x + raster.origin_y))
    throw_error(path, concatenate("cannot be written with cell_size ", raster.cell_size, " and origin ",
                                  raster.origin_x, ", ", raster.origin_y, "; must be finite, cell_size > 0"));
}

/// Writes a GeoTIFF directly to `path`; false if GDAL reported a failure, which can also happen on closing
/// the file, for instance on a full disk.
bool write_dataset(const std::string& path, const Raster& raster, GdalMessages& messages) {
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
  band.SetNoDataValue(kNoData);
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

Raster read_raster(const std::string& path, const RasterOptions& options) {
  check_options(path, options);
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw_error(path, error ? error.message() : "no such file");
  { GdalMessages registers_drivers; }
  Raster raster = is_exr_without_driver(path) ? read_exr(path, options) : read_by_gdal(path, options);
  check_values(path, raster);
  return raster;
}

void write_geotiff(const std::string& path, const Raster& raster) {
  check_writable(path, raster);
  TemporaryFile file(path);
  GdalMessages messages;
  if (!write_dataset(file.library_path(), raster, messages))
    throw WriteError(concatenate("raster '", path, "': cannot be written: ", messages.text()));
  file.publish();
  std::error_code error;
  std::filesystem::remove(path + ".aux.xml", error);  // GDAL's metadata of the replaced file
  if (error) throw WriteError(path + ".aux.xml: cannot be removed: " + error.message());
}

}  // namespace desert_sim

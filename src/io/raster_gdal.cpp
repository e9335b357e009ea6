/// Files that GDAL reads: what they are, where they lie, and their numbers.
#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "src/io/gdal_input.hpp"
#include "src/io/gdal_messages.hpp"
#include "src/io/projection.hpp"
#include "src/io/raster_companions.hpp"
#include "src/io/raster_file.hpp"
#include "src/io/raster_geometry.hpp"
#include "src/io/text_grid.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

constexpr double square_tolerance = 1e-3;    // relative difference of cell width and height
constexpr double rotation_tolerance = 1e-6;  // shear [cells per cell]
/// Formats whose drivers read nothing but the file and its companions.
constexpr const char* allowed_drivers[] = {"GTiff", "AAIGrid", "ENVI", "PNG", "EXR", "USGSDEM", nullptr};
constexpr const char* allowed_formats = "GeoTIFF, ESRI ASCII, ENVI, PNG, EXR, USGS DEM";

std::string unit_of(GDALRasterBand& band) {
  const char* unit = band.GetUnitType();
  return unit ? unit : "";
}

DeclaredBand declared_band(GDALDataset& dataset, int band) {
  GDALRasterBand& read = *dataset.GetRasterBand(band);
  return {!unit_of(read).empty(),
          dataset.GetRasterCount() >= 3 && read.GetColorInterpretation() == GCI_RedBand};
}

/// Refuses terms that no north-up raster with square cells has.
void check_geotransform(const std::string& path, GDALDataset& dataset, int band, const GeoTransform& g) {
  for (double term : g)
    if (!std::isfinite(term))
      throw_raster_error(path, concatenate("geotransform has the value ", term, ", must be finite"));
  if (std::max(std::abs(g[2]), std::abs(g[4])) >
      rotation_tolerance * std::max(std::abs(g[1]), std::abs(g[5])))
    throw_raster_error(path, concatenate("geotransform is rotated (row and column terms ", g[2], ", ", g[4],
                                         "), must be 0"));
  if (g[1] <= 0 || g[5] == 0)
    throw_raster_error(path, concatenate("cells are ", g[1], " x ", std::abs(g[5]),
                                         ", the width must be > 0 and the height not 0"));
  if (std::abs(g[1] - std::abs(g[5])) <= square_tolerance * g[1]) return;
  const char* wkt = dataset.GetProjectionRef();
  const int width = dataset.GetRasterXSize(), height = dataset.GetRasterYSize();
  require_metres(path, wkt ? wkt : "",
                 {g[0], std::min(g[3], g[3] + height * g[5]), g[1], std::abs(g[5]), width, height},
                 declared_band(dataset, band));
  throw_raster_error(path, concatenate("cells are not square: ", g[1], " x ", std::abs(g[5]),
                                       ", at most 0.1 % of difference allowed"));
}

/// The dataset's geotransform, flipped to north-up; `south_up` is set if it had to be flipped.
GeoTransform north_up_geotransform(const std::string& path, GDALDataset& dataset, int band, bool& south_up) {
  const GeoTransform none{0, 1, 0, 0, 0, 1};
  GeoTransform g = none;
  south_up = false;
  const int height = dataset.GetRasterYSize();
  if (dataset.GetGeoTransform(g.data()) != CE_None || g == none) return default_geotransform(height);
  check_geotransform(path, dataset, band, g);
  if (g[5] > 0) {
    south_up = true;
    g[3] += height * g[5];
    g[5] = -g[5];
  }
  g[2] = g[4] = 0;
  return g;
}

/// Why a dataset without geotransform, but with ground control points, RPC or geolocation arrays, has no
/// cells of one size; empty if it has none of these.
std::string unusable_placement(const std::string& path, GDALDataset& dataset, int band) {
  std::string has;
  if (dataset.GetGCPCount() > 0) has = std::to_string(dataset.GetGCPCount()) + " ground control points";
  if (dataset.GetMetadata("RPC")) has = "rational polynomials (RPC)";
  if (dataset.GetMetadata("GEOLOCATION")) has = "arrays of coordinates (GEOLOCATION)";
  if (has.empty()) return "";
  const std::string placed = "is placed by " + has + ", not by a size of cells; project it first";
  const OGRSpatialReference* crs = dataset.GetGCPSpatialRef();
  if (dataset.GetGCPCount() == 0 || !crs) return placed + " with gdalwarp -t_srs to a projection in metres";
  const GDAL_GCP* points = dataset.GetGCPs();
  double x = 0, y = 0;
  for (int n = 0; n < dataset.GetGCPCount(); ++n) {
    x += points[n].dfGCPX / dataset.GetGCPCount();
    y += points[n].dfGCPY / dataset.GetGCPCount();
  }
  return placed + how_to_project(path, *crs, x, y, declared_band(dataset, band));
}

class GdalRasterFile final : public RasterFile {
 public:
  GdalRasterFile(const std::string& path, const RasterOptions& options, const RasterAccess& access)
      : RasterFile(path, options) {
    if (access.all_formats && access.folder.empty()) {
      open_anything();
    } else {
      open_allowed(access);
    }
    check_raster_shape(path, dataset_->GetRasterXSize(), dataset_->GetRasterYSize(),
                       dataset_->GetRasterCount(), options.band);
    band_ = dataset_->GetRasterBand(options.band);
    is_text_ = dataset_->GetDriver() && std::string(dataset_->GetDriver()->GetDescription()) == "AAIGrid";
    if (GDALDataTypeIsComplex(band_->GetRasterDataType()))
      throw_raster_error(path,
                         concatenate("band ", options.band, " has complex numbers (",
                                     GDALGetDataTypeName(band_->GetRasterDataType()), "), must be real"));
    read_header();
    if (!header_.projection.empty() || messages_.text().find("PROJ") != std::string::npos)
      require_projection_database("raster '" + path + "'");
    require_external_mask(path, *dataset_, *band_);
    mask_ = (band_->GetMaskFlags() & GMF_ALL_VALID) ? alpha_band() : band_->GetMaskBand();
    const char* pixels = band_->GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
    signed_bytes_ = band_->GetRasterDataType() == GDT_Byte && pixels && std::string(pixels) == "SIGNEDBYTE";
    if (signed_bytes_ && (band_->GetMaskFlags() & GMF_NODATA)) mask_ = nullptr;
    messages_.clear();
  }

 private:
  void open_allowed(const RasterAccess& access) {
    input_ = std::make_unique<GdalInput>(path(), access.folder);
    const std::vector<std::string> names = input_->siblings();
    std::vector<const char*> siblings;
    siblings.reserve(names.size() + 1);
    for (const std::string& name : names) siblings.push_back(name.c_str());
    siblings.push_back(nullptr);
    dataset_.reset(GDALDataset::FromHandle(
        GDALOpenEx(input_->name().c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                   allowed_drivers, nullptr, siblings.data())));
    if (!dataset_)
      throw_raster_error(path(),
                         concatenate("is not a raster that may be read here (", allowed_formats,
                                     "; the rasters with which desert_run or the node starts may have "
                                     "other formats with --all-raster-formats or "
                                     "~all_raster_formats): ",
                                     reason()));
    file_bytes_ = input_->file().size();
    check_raw_file(path(), *dataset_, file_bytes_, warnings_);
    if (!input_->unread_metadata().empty())
      warnings_.push_back("raster '" + path() + "': " + input_->unread_metadata() +
                          " beside it is read with --all-raster-formats or ~all_raster_formats only");
  }

  void open_anything() {
    std::error_code error;
    const fs::file_type type = fs::status(path(), error).type();
    if (type != fs::file_type::not_found && type != fs::file_type::regular &&
        type != fs::file_type::directory)
      throw_raster_error(path(), "is not a regular file");  // GDAL would wait for a writer of a FIFO
    dataset_.reset(GDALDataset::FromHandle(
        GDALOpenEx(path().c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                   nullptr, nullptr)));
    if (!dataset_) throw_raster_error(path(), "is not a raster that GDAL can open: " + messages_.text());
    const std::uint64_t bytes = fs::file_size(path(), error);
    if (!error) check_raw_file(path(), *dataset_, bytes, warnings_);
  }

  void read_header() {
    header_.width = dataset_->GetRasterXSize();
    header_.height = dataset_->GetRasterYSize();
    set_geotransform(header_, north_up_geotransform(path(), *dataset_, options_.band, south_up_));
    if (const char* wkt = dataset_->GetProjectionRef()) header_.projection = wkt;
    GeoTransform placed;
    if (dataset_->GetGeoTransform(placed.data()) != CE_None)
      header_.unusable_placement = unusable_placement(path(), *dataset_, options_.band);
    warn_of_unused_projection(path(), *dataset_, header_.projection, warnings_);
    header_.declared = declared_band(*dataset_, options_.band);
    std::string unit = unit_of(*band_);
    if (unit.empty()) unit = unit_of_heights(header_.projection);
    if (unit.empty()) unit = unit_of_arc_info(*dataset_);
    declared_ =
        declared_values(path(), band_->GetScale(), band_->GetOffset(), unit, options_.scale, warnings_);
  }

  /// Its band of opacity, which GDAL takes for a mask where that has bytes or 16 bits alone; null without
  /// one.
  GDALRasterBand* alpha_band() {
    for (int n = 1; n <= dataset_->GetRasterCount(); ++n) {
      GDALRasterBand* const band = dataset_->GetRasterBand(n);
      if (band != band_ && band->GetColorInterpretation() == GCI_AlphaBand) return band;
    }
    return nullptr;
  }

  /// Numbers that are no values, and encodings that the raster does not have.
  void prepare() override {
    require_heights(path(), header_.projection, options_.scale);
    if (is_text_)
      check_text_grid(path(), dataset_->GetDescription(), header_.width, header_.height,
                      GDALDataTypeIsInteger(band_->GetRasterDataType()) != 0);
    const GDALColorInterp colour = band_->GetColorInterpretation();
    const int bands = dataset_->GetRasterCount();
    const bool bytes = band_->GetRasterDataType() == GDT_Byte;
    switch (options_.encoding) {
      case RasterEncoding::channel:
        return;
      case RasterEncoding::values:
        if (colour == GCI_PaletteIndex || band_->GetColorTable())
          throw_raster_error(
              path(),
              "its numbers are indices of a palette of colours, not values; values are needed, "
              "or encoding: channel where the index itself is meant");
        if (header_.declared.is_colour && options_.band == 1)
          throw_raster_error(path(),
                             "is a picture of colours, not of values; where colours encode heights give "
                             "encoding: terrarium or encoding: mapbox, where red itself is meant encoding: "
                             "channel");
        return;
      case RasterEncoding::terrarium:
      case RasterEncoding::mapbox:
        if (!bytes || bands < 3)
          throw_raster_error(path(),
                             concatenate("cannot be of that encoding, which has the three bands red, green "
                                         "and blue of bytes: it has ",
                                         bands, " of ", GDALGetDataTypeName(band_->GetRasterDataType())));
    }
  }

  void read_row(int row, int x, int width, double* raw, unsigned char* valid) override {
    const int line = south_up_ ? row : header_.height - 1 - row;
    if (is_text_) pass_lines_before(line);
    CPLErr status = read_numbers(*band_, line, x, width, raw);
    if (status == CE_None &&
        (options_.encoding == RasterEncoding::terrarium || options_.encoding == RasterEncoding::mapbox))
      status = decode(line, x, width, raw);
    if (status == CE_None && mask_)
      status = mask_->RasterIO(GF_Read, x, line, width, 1, valid, width, 1, GDT_Byte, 0, 0, nullptr);
    if (status != CE_None || messages_.failed())
      throw_raster_error(
          path(), concatenate("cannot be read at line ", line + 1, " of ", header_.height, ": ", reason()));
    if (signed_bytes_) make_signed(width, raw, valid);
  }

  static CPLErr read_numbers(GDALRasterBand& band, int line, int x, int width, double* numbers) {
    return band.RasterIO(GF_Read, x, line, width, 1, numbers, width, 1, GDT_Float64, 0, 0, nullptr);
  }

  /// GDAL before 3.7 has no type of signed bytes: their numbers and their nodata do not fit each other.
  void make_signed(int width, double* raw, unsigned char* valid) const {
    int declares = 0;
    const double nodata = band_->GetNoDataValue(&declares);
    for (int i = 0; i < width; ++i) {
      if (raw[i] > 127) raw[i] -= 256;
      if (!mask_) valid[i] = declares && raw[i] == nodata ? 0 : 255;
    }
  }

  /// Heights from the three colours.
  CPLErr decode(int line, int x, int width, double* heights) {
    std::vector<double> colours[3];
    for (int n = 0; n < 3; ++n) {
      colours[n].resize(static_cast<std::size_t>(width));
      const CPLErr status = read_numbers(*dataset_->GetRasterBand(n + 1), line, x, width, colours[n].data());
      if (status != CE_None) return status;
    }
    for (std::size_t i = 0; i < colours[0].size(); ++i) {
      const double red = colours[0][i], green = colours[1][i], blue = colours[2][i];
      heights[i] = options_.encoding == RasterEncoding::terrarium
                       ? 256 * red + green + blue / 256 - 32768
                       : (65536 * red + 256 * green + blue) / 10 - 10000;
    }
    return CE_None;
  }

  /// Reads the lines of a text before `line` in turn. GDAL itself calls itself for each of them, and again
  /// for each that is broken, which takes for ever.
  void pass_lines_before(int line) {
    double ignored = 0;
    for (; lines_passed_ < line; ++lines_passed_)
      if (band_->RasterIO(GF_Read, 0, lines_passed_, 1, 1, &ignored, 1, 1, GDT_Float64, 0, 0, nullptr) !=
              CE_None ||
          messages_.failed())
        throw_raster_error(path(), concatenate("cannot be read at line ", lines_passed_ + 1, " of ",
                                               header_.height, ": ", reason()));
  }

  /// What GDAL says, with the raster's path for its name in GDAL's file system.
  std::string reason() const {
    std::string text = messages_.text();
    const std::string name = input_ ? input_->name() : path();
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + path().size()))
      text.replace(at, name.size(), path());
    return text;
  }

  double bytes_besides() const override {
    int width = 0, height = 0;
    band_->GetBlockSize(&width, &height);
    return static_cast<double>(width) * height * GDALGetDataTypeSizeBytes(band_->GetRasterDataType());
  }

  GdalMessages messages_;  // lives longer than the dataset, whose drivers speak until it is closed
  std::unique_ptr<GdalInput> input_;
  GDALDatasetUniquePtr dataset_;
  GDALRasterBand *band_ = nullptr, *mask_ = nullptr;
  bool south_up_ = false, signed_bytes_ = false;
  bool is_text_ = false;  ///< ESRI ASCII, whose lines can only be found one after the other
  int lines_passed_ = 0;
};

}  // namespace

std::unique_ptr<RasterFile> open_gdal(const std::string& path, const RasterOptions& options,
                                      const RasterAccess& access) {
  return std::make_unique<GdalRasterFile>(path, options, access);
}

}  // namespace desert_sim

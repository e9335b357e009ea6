#include "src/io/raster_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <vector>

#include "kernels/backend/exec.hpp"
#include "src/core/log.hpp"
#include "src/io/cell_values.hpp"
#include "src/io/gdal_input.hpp"
#include "src/io/gdal_messages.hpp"
#include "src/io/projection.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

constexpr double square_tolerance = 1e-3;    // relative difference of cell width and height
constexpr double rotation_tolerance = 1e-6;  // shear [cells per cell]
/// Formats whose drivers read nothing but the file and its companions.
constexpr const char* allowed_drivers[] = {"GTiff", "AAIGrid", "ENVI", "PNG", "EXR", "USGSDEM", nullptr};
constexpr const char* allowed_formats = "GeoTIFF, ESRI ASCII, ENVI, PNG, EXR, USGS DEM";

void check_options(const std::string& path, const RasterOptions& options) {
  if (!std::isfinite(options.scale) || options.scale == 0)
    throw_raster_error(path, concatenate("scale is ", options.scale, ", must be finite and not 0"));
  if (!std::isfinite(options.offset))
    throw_raster_error(path, concatenate("offset is ", options.offset, ", must be finite"));
}

/// Refuses terms that no north-up raster with square cells has.
void check_geotransform(const std::string& path, GDALDataset& dataset, const GeoTransform& g) {
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
  require_metres(path, wkt ? wkt : "", g[0] + 0.5 * g[1] * dataset.GetRasterXSize(),
                 g[3] + 0.5 * g[5] * dataset.GetRasterYSize());
  throw_raster_error(path, concatenate("cells are not square: ", g[1], " x ", std::abs(g[5]),
                                       ", at most 0.1 % of difference allowed"));
}

/// The dataset's geotransform, flipped to north-up; `south_up` is set if it had to be flipped.
GeoTransform north_up_geotransform(const std::string& path, GDALDataset& dataset, bool& south_up) {
  const GeoTransform none{0, 1, 0, 0, 0, 1};
  GeoTransform g = none;
  south_up = false;
  const int height = dataset.GetRasterYSize();
  if (dataset.GetGeoTransform(g.data()) != CE_None || g == none) return default_geotransform(height);
  check_geotransform(path, dataset, g);
  if (g[5] > 0) {
    south_up = true;
    g[3] += height * g[5];
    g[5] = -g[5];
  }
  g[2] = g[4] = 0;
  return g;
}

/// Refuses a truncated raw file (ENVI, EHdr), because GDAL would read the missing part as zeros.
void check_raw_file(const std::string& path, GDALDataset& dataset, std::uint64_t file_bytes) {
  const std::string driver = dataset.GetDriver() ? dataset.GetDriver()->GetDescription() : "";
  const char* compressed = dataset.GetMetadataItem("file_compression", "ENVI");
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  if ((driver != "ENVI" && driver != "EHdr") || (compressed && std::string(compressed) != "0") ||
      band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE"))
    return;
  const char* header = dataset.GetMetadataItem("header_offset", "ENVI");
  const std::uint64_t cells = static_cast<std::uint64_t>(dataset.GetRasterXSize()) * dataset.GetRasterYSize();
  const std::uint64_t needed =
      cells * dataset.GetRasterCount() * GDALGetDataTypeSizeBytes(band.GetRasterDataType()) +
      (header ? std::strtoull(header, nullptr, 10) : 0);
  if (file_bytes < needed)
    throw_raster_error(path, concatenate("is truncated: it has ", file_bytes, " bytes of ", needed));
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
    mask_ = (band_->GetMaskFlags() & GMF_ALL_VALID) ? nullptr : band_->GetMaskBand();
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
    check_raw_file(path(), *dataset_, file_bytes_);
    if (!input_->unread_metadata().empty())
      log_warning("raster '" + path() + "': " + input_->unread_metadata() +
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
    if (!error) check_raw_file(path(), *dataset_, bytes);
  }

  void read_header() {
    header_.width = dataset_->GetRasterXSize();
    header_.height = dataset_->GetRasterYSize();
    set_geotransform(header_, north_up_geotransform(path(), *dataset_, south_up_));
    if (const char* wkt = dataset_->GetProjectionRef()) header_.projection = wkt;
    if (const char* unit = band_->GetUnitType()) value_unit_ = unit;
  }

  void read_row(int row, int x, int width, double* raw, unsigned char* valid) override {
    const int line = south_up_ ? row : header_.height - 1 - row;
    if (is_text_) pass_lines_before(line);
    CPLErr status = band_->RasterIO(GF_Read, x, line, width, 1, raw, width, 1, GDT_Float64, 0, 0, nullptr);
    if (status == CE_None && mask_)
      status = mask_->RasterIO(GF_Read, x, line, width, 1, valid, width, 1, GDT_Byte, 0, 0, nullptr);
    if (status != CE_None || messages_.failed())
      throw_raster_error(
          path(), concatenate("cannot be read at line ", line + 1, " of ", header_.height, ": ", reason()));
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
  bool south_up_ = false;
  bool is_text_ = false;  ///< ESRI ASCII, whose lines can only be found one after the other
  int lines_passed_ = 0;
};

void check_values(const std::string& path, const Raster& raster, const RasterWindow& window) {
  std::size_t infinite = 0, first = 0, finite = 0;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    if (std::isinf(raster.values[i]) && infinite++ == 0) first = i;
    finite += std::isfinite(raster.values[i]);
  }
  if (infinite > 0)
    throw_raster_error(path,
                       concatenate(infinite, " values are infinite or beyond float32, the first at column ",
                                   window.x + first % raster.width, ", row ", window.y + first / raster.width,
                                   " (row 0 = south), must be finite"));
  if (finite == 0)
    throw_raster_error(
        path, concatenate("all ", raster.values.size(), " cells are nodata, at least one value is needed"));
}

void reverse_rows(Raster& raster) {
  for (int y = 0; y < raster.height / 2; ++y) {
    const auto row = [&](int n) {
      return raster.values.begin() + static_cast<std::ptrdiff_t>(n) * raster.width;
    };
    std::swap_ranges(row(y), row(y + 1), row(raster.height - 1 - y));
  }
}

bool is_foot(std::string unit) {
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  return unit.find("ft") == 0 || unit.find("feet") != std::string::npos ||
         unit.find("foot") != std::string::npos;
}

bool is_exr(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".exr";
}

}  // namespace

void require_host_memory(const std::string& path, double bytes, const std::string& doing) {
  const auto available = static_cast<double>(host_memory_available());
  if (bytes > available)
    throw_raster_error(path, concatenate(doing, " takes ", bytes / 1073741824.0,
                                         " GiB of memory; available: ", available / 1073741824.0, " GiB"));
}

namespace {

/// A few bytes can declare billions of cells (a sparse GeoTIFF), which would fill the memory with nothing.
/// Deflate packs at most some 258 cells of four bytes into one.
void refuse_sparse(const std::string& path, const RasterWindow& window, std::uint64_t file_bytes) {
  constexpr std::uint64_t harmless_cells = 1u << 24, cells_per_byte = 1024;
  const std::uint64_t cells =
      static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
  if (file_bytes > 0 && cells > harmless_cells && cells / cells_per_byte > file_bytes)
    throw_raster_error(
        path,
        concatenate(window.width, " x ", window.height, " cells are needed, which a file of ", file_bytes,
                    " bytes cannot have (allowed: up to ", cells_per_byte, " cells for each byte)"));
}

}  // namespace

Raster RasterFile::read(const RasterWindow& window) {
  refuse_sparse(path_, window, file_bytes_);
  require_host_memory(path_,
                      static_cast<double>(window.width) * window.height * sizeof(float) + bytes_besides(),
                      concatenate("reading ", window.width, " x ", window.height, " cells"));
  Raster raster = header_;
  const bool whole = window.width == header_.width && window.height == header_.height;
  raster.width = window.width;
  raster.height = window.height;
  if (!whole) {
    raster.origin_x += window.x * header_.cell_size;
    raster.origin_y += window.y * header_.cell_size;
    raster.geotransform[0] = raster.origin_x;
    raster.geotransform[3] = raster.origin_y + window.height * header_.cell_size;
  }
  // Files begin in the north, and one that ends too early costs no more than what it has.
  raster.values.reserve(static_cast<std::size_t>(window.width) * window.height);
  CellValues cells(options_);
  std::vector<double> raw(window.width);
  std::vector<unsigned char> valid(window.width, 255);
  for (int row = window.y + window.height - 1; row >= window.y; --row) {
    read_row(row, window.x, window.width, raw.data(), valid.data());
    for (int x = 0; x < window.width; ++x) {
      const int column = window.x + x;
      const bool at_edge =
          row == 0 || row == header_.height - 1 || column == 0 || column == header_.width - 1;
      raster.values.push_back(valid[x] ? cells.convert(raw[x], at_edge)
                                       : std::numeric_limits<float>::quiet_NaN());
    }
  }
  reverse_rows(raster);
  warn_of_undeclared_nodata(cells, path_);
  if (options_.scale == 1 && is_foot(value_unit_))
    log_warning("raster '" + path_ + "': its values are in the unit '" + value_unit_ +
                "', and are taken as metres; for heights give scale: 0.3048");
  check_values(path_, raster, window);
  return raster;
}

std::unique_ptr<RasterFile> open_raster(const std::string& path, const RasterOptions& options,
                                        const RasterAccess& access) {
  check_options(path, options);
  { GdalMessages registers_drivers; }
  if (is_exr(path) && !GetGDALDriverManager()->GetDriverByName("EXR")) return open_exr(path, options, access);
  return std::make_unique<GdalRasterFile>(path, options, access);
}

Raster read_raster(const std::string& path, const RasterOptions& options, const RasterAccess& access) {
  return open_raster(path, options, access)->read();
}

}  // namespace desert_sim

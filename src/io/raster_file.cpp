#include "src/io/raster_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "src/core/host_memory.hpp"
#include "src/core/log.hpp"
#include "src/core/lower_case.hpp"
#include "src/io/cell_values.hpp"
#include "src/io/frame.hpp"
#include "src/io/gdal_messages.hpp"
#include "src/io/raster_geometry.hpp"

namespace desert_sim {
namespace {

void check_options(const std::string& path, const RasterOptions& options) {
  if (!std::isfinite(options.scale) || options.scale == 0)
    throw_raster_error(path, concatenate("scale is ", options.scale, ", must be finite and not 0"));
  if (!std::isfinite(options.offset))
    throw_raster_error(path, concatenate("offset is ", options.offset, ", must be finite"));
}

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

bool is_exr(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string()) == ".exr";
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
  for (const std::string& warning : std::exchange(warnings_, {})) log_warning(warning);
  prepare();
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
  CellValues cells(options_, declared_);
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
  if (!options_.complete) warn_of_missing_data(raster, window, cells);  // which may be why values are refused
  check_values(path_, raster, window);
  return raster;
}

void RasterFile::warn_of_missing_data(const Raster& raster, const RasterWindow& window,
                                      const CellValues& cells) {
  std::optional<double> told;
  const bool part = window.width != header_.width || window.height != header_.height;
  if (const std::optional<Frame> frame = find_frame(raster, part)) {
    double raw = 0;
    unsigned char valid = 0;
    read_row(window.y + static_cast<int>(frame->cell / window.width),
             window.x + static_cast<int>(frame->cell % window.width), 1, &raw, &valid);
    told = raw;
    warn_of_frame(path_, *frame, raw);
  }
  warn_of_undeclared_nodata(cells, path_, told);
}

std::unique_ptr<RasterFile> open_raster(const std::string& path, const RasterOptions& options,
                                        const RasterAccess& access) {
  check_options(path, options);
  { GdalMessages registers_drivers; }
  if (is_exr(path) && !GetGDALDriverManager()->GetDriverByName("EXR")) return open_exr(path, options, access);
  return open_gdal(path, options, access);
}

Raster read_raster(const std::string& path, const RasterOptions& options, const RasterAccess& access) {
  return open_raster(path, options, access)->read();
}

}  // namespace desert_sim

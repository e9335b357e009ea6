#pragma once
/// Rasters that are open: first what their headers say, then the cells of a window.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "src/io/cell_values.hpp"
#include "src/io/declared_values.hpp"
#include "src/io/raster.hpp"

namespace desert_sim {

/// Columns and rows of a raster; row 0 is the southern one.
struct RasterWindow {
  int x = 0, y = 0, width = 0, height = 0;
};

class RasterFile {
 public:
  virtual ~RasterFile() = default;
  const std::string& path() const { return path_; }
  /// The raster without its values.
  const Raster& header() const { return header_; }
  /// Reads the cells of a window, which must lie in the raster, and logs a warning for numbers and for a
  /// frame around the raster that seem to stand for missing data, unless it is complete. Throws ConfigError
  /// for what is wrong with them (see read_raster()), and before any is read if the memory does not hold
  /// them, or if they are far more than the file can have.
  Raster read(const RasterWindow& window);
  Raster read() { return read({0, 0, header_.width, header_.height}); }

 protected:
  RasterFile(std::string path, const RasterOptions& options) : options_(options), path_(std::move(path)) {}
  /// Throws ConfigError where the numbers are not of the encoding that the options name.
  virtual void prepare() = 0;
  /// Makes `width` raw numbers of a row ready, from column x on; `valid` is 0 where they are declared to be
  /// missing.
  virtual void read_row(int row, int x, int width, double* raw, unsigned char* valid) = 0;
  /// Memory that reading takes besides the values [bytes].
  virtual double bytes_besides() const = 0;

  const RasterOptions options_;
  Raster header_;
  DeclaredValues declared_;
  std::vector<std::string> warnings_;  ///< of what its header says, which read() logs
  std::uint64_t file_bytes_ = 0;       ///< 0 if they are not all in one file

 private:
  void warn_of_missing_data(const Raster& raster, const RasterWindow& window, const CellValues& cells);

  const std::string path_;
};

/// Opens a raster and checks its header. Throws ConfigError as read_raster() does; for coordinates that are
/// not in metres and whose cells are not square, it says how to project the raster.
std::unique_ptr<RasterFile> open_raster(const std::string& path, const RasterOptions& options = {},
                                        const RasterAccess& access = {});

/// Part of open_raster(): a file that GDAL reads.
std::unique_ptr<RasterFile> open_gdal(const std::string& path, const RasterOptions& options,
                                      const RasterAccess& access);

/// Part of open_raster(): an EXR file that OpenCV reads.
std::unique_ptr<RasterFile> open_exr(const std::string& path, const RasterOptions& options,
                                     const RasterAccess& access);

/// Throws ConfigError that names the raster if `bytes` more are not there while it is `doing` something.
void require_host_memory(const std::string& path, double bytes, const std::string& doing);

}  // namespace desert_sim

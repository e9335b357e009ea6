#pragma once
/// Layers over time in one NetCDF-4 file after the CF conventions 1.8, which xarray, GDAL, QGIS and ParaView
/// read. A build without libnetcdf refuses them.
///
/// Dimensions time, y (from south to north), x; one variable a layer, float32, with NaN where a layer was not
/// in use. A chunk is one time and at most 512 × 512 cells, compressed with zlib at level 4 after shuffling.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

struct NetcdfHead {
  std::string title;
  std::string projection;      ///< WKT; empty: unknown
  std::optional<double> date;  ///< of time 0, in seconds since 1970-01-01 UTC
};

class NetcdfWriter {
 public:
  /// Creates the file, in place of a regular file of this name, with the grid of `first`. Throws ConfigError
  /// that names the file if it cannot.
  NetcdfWriter(const std::string& path, const NetcdfHead& head, const Snapshot& first);
  ~NetcdfWriter();
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  /// Appends all layers of the snapshot, and hands them to the disk. Throws ConfigError if its grid is not
  /// the first one's, WriteError if the disk is full.
  void add(const Snapshot& snapshot);

 private:
  struct File;
  std::unique_ptr<File> file_;
};

class NetcdfReader {
 public:
  /// Throws ConfigError unless the file has the dimensions time, y and x, with coordinates that are evenly
  /// spaced in metres.
  explicit NetcdfReader(const std::string& path);
  ~NetcdfReader();
  NetcdfReader(const NetcdfReader&) = delete;
  NetcdfReader& operator=(const NetcdfReader&) = delete;

  int width() const;
  int height() const;
  double cell_size() const;  ///< [m]
  double origin_x() const;   ///< of the south-west corner [m]
  double origin_y() const;
  const std::vector<double>& times() const;  ///< as they stand in the file [s]
  bool periodic() const;                     ///< by the global attribute `boundary`
  bool has(const std::string& variable) const;
  /// Row-major from the south-west. Throws ConfigError if there is no such variable.
  std::vector<float> read(const std::string& variable, std::size_t time) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace desert_sim

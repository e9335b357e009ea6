#pragma once
/// Checks and geometry that reading and writing rasters have in common.

#include <array>
#include <cstdint>
#include <sstream>
#include <string>

#include "src/core/error.hpp"
#include "src/io/raster.hpp"

namespace desert_sim {

/// As in GDAL: x = g0 + g1 column + g2 row, y = g3 + g4 column + g5 row.
using GeoTransform = std::array<double, 6>;

template <class... Parts>
std::string concatenate(const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  (text << ... << parts);
  return text.str();
}

[[noreturn]] inline void throw_raster_error(const std::string& path, const std::string& reason) {
  throw ConfigError("raster '" + path + "': " + reason);
}

/// Throws ConfigError for a raster without bands or cells, with more than 2^31 cells, or without that band.
void check_raster_shape(const std::string& path, std::int64_t width, std::int64_t height, int bands,
                        int band);

/// Geotransform of a raster that has none: cells of size 1, lower-left corner at (0, 0), north up.
GeoTransform default_geotransform(int height);

/// Sets the raster's geotransform, and its cell_size and origin accordingly.
void set_geotransform(Raster& raster, const GeoTransform& g);

}  // namespace desert_sim

#pragma once
/// The rasters that a scenario reads, and the grid that one of them may give it.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "src/scenario/raster_encoding.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// A raster as a RasterLoader returns it. The loader that uses GDAL is in the library desert_io; without it,
/// no_raster_loader() refuses every raster.
struct RasterField {
  int width = 0, height = 0;
  double cell_size = 1, origin_x = 0, origin_y = 0;
  std::string projection;
  std::vector<std::string> bands;  ///< names of all bands in order; empty if they have none
  std::vector<float> values;       ///< row-major from the south-west; none if only the grid was asked for
};
struct RasterRequest {
  std::string path;
  int band = 1;
  double scale = 1, offset = 0;
  std::optional<double> nodata;  ///< a raw value that stands for missing data, besides the declared one
  bool fill_nodata = false;      ///< fill nodata from neighbours; otherwise it is refused
  bool complete = false;         ///< every cell has data: none is suspected to have none
  // The grid to resample to; with width 0 only the raster's own grid is asked for, and no values are read.
  int width = 0, height = 0;
  double cell_size = 0, origin_x = 0, origin_y = 0;
  bool stretch = false;  ///< stretch the raster over the grid, whatever its position
  RasterEncoding encoding = RasterEncoding::values;
};
using RasterLoader = std::function<RasterField(const RasterRequest&)>;
RasterField no_raster_loader(const RasterRequest& request);

/// The path of `file` in the scenario's folder if it exists there; otherwise `file` itself.
std::string raster_path(const Scenario& scenario, const std::string& file);

/// Paths of all rasters that the scenario reads, resolved by raster_path().
std::vector<std::string> raster_paths(const Scenario& scenario);

/// Sets the values that the section `grid` leaves open: from its raster if it names one, else to defaults.
void resolve_grid(Scenario& scenario, const RasterLoader& load_raster);

}  // namespace desert_sim

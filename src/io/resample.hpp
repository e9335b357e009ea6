#pragma once
/// Resamples rasters to another grid and fills their nodata cells, both with GDAL.

#include "src/io/raster.hpp"

namespace desert_sim {

/// Resampling methods. `bilinear` and `cubic` widen their kernel when the new grid is coarser; `average`
/// weights each cell by the area that it covers. `cubic` is limited to the range of the cells that it weighs,
/// because it would overshoot beside a step.
enum class Resampling { bilinear, cubic, average };

/// Resamples a raster to a grid of width x height cells of cell_size with its lower-left corner at the origin
/// [unit of the raster's CRS]. NaN cells have no weight. A cell of the new grid is NaN if no valid cell is
/// within the kernel, or if its centre lies outside the raster. Throws ConfigError for a grid without cells
/// or a cell_size that is not > 0, and StateError if GDAL fails.
Raster resample(const Raster& source, int width, int height, double cell_size, double origin_x,
                double origin_y, Resampling method);

/// Where the cells of one grid lie in another, along one axis, in cells of the other one.
struct CellMapping {
  double first = 0;   ///< west or south edge of the first cell
  double length = 1;  ///< of each cell
};

/// Limits the values of an interpolated raster to the range of the source's cells that cubic convolution
/// weighs for them: two on each side, or more where the raster is coarser. NaN cells of the source do not
/// count.
void limit_to_sources(Raster& raster, const Raster& source, const CellMapping& x, const CellMapping& y);

/// Fills all NaN cells with the distance-weighted mean of the nearest valid cells in the quadrants around
/// them. Throws ConfigError if there is no valid cell, and StateError if GDAL fails; the raster is then
/// unchanged.
void fill_nodata(Raster& raster);

}  // namespace desert_sim

#pragma once
/// Rasters brought to another grid, and holes in them filled; both by GDAL.

#include "src/io/raster.hpp"

namespace desert_sim {

/// How a value is made of the cells around it. `bilinear` and `cubic` widen their reach when the new grid is
/// coarser; `average` weighs each cell by the area it covers; `cubic` may overshoot beside a step.
enum class Resampling { nearest, bilinear, cubic, average };

/// The raster on a grid of width x height cells of cell_size, lower-left corner at origin [unit of the
/// raster's CRS]. NaN cells have no weight; a cell that no valid cell reaches, or whose centre lies outside
/// the raster, is NaN. Throws ConfigError for a grid without cells or a cell_size that is not > 0, StateError
/// if GDAL fails.
Raster resample(const Raster& source, int width, int height, double cell_size, double origin_x,
                double origin_y, Resampling method);

/// The raster with cells of another size and the same lower-left corner: averaged when coarser, cubic when
/// finer. Width and height are the old extents over cell_size, rounded. Throws as resample(), and ConfigError
/// where cell_size is more than twice an extent, so that no cell would be left.
Raster resample_to_cell_size(const Raster& source, double cell_size);

/// Fills all NaN cells with the distance-weighted mean of the nearest valid cells in the quadrants around
/// them. Throws ConfigError if there is no valid cell, StateError if GDAL fails; the raster is then as
/// before.
void fill_nodata(Raster& raster);

}  // namespace desert_sim

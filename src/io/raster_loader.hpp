#pragma once
/// Loads rasters for a scenario's terrain.

#include "src/io/raster.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// Fills nodata cells of a raster and resamples it to the requested grid, as gdal_raster_loader() does.
RasterField resample_to_request(Raster raster, const RasterRequest& request);

/// A loader that reads any raster and resamples it to the requested grid. Values are copied if the cells
/// coincide, averaged if the grid is coarser, and interpolated if it is finer. Cells beyond the raster get
/// the value of the nearest cell on its edge. A raster without georeference is stretched over the grid. The
/// loader throws ConfigError that names the file and the reason.
RasterLoader gdal_raster_loader();

}  // namespace desert_sim

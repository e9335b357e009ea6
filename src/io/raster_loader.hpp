#pragma once
/// Loads rasters for a scenario's terrain.

#include "src/io/raster.hpp"
#include "src/scenario/raster_grid.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// What a request says about reading.
RasterOptions raster_options(const RasterRequest& request);

/// Fills nodata cells of a raster and resamples it to the requested grid, as gdal_raster_loader() does.
RasterField resample_to_request(Raster raster, const RasterRequest& request);

/// A loader that reads the rasters that `access` allows and resamples them to the requested grid. Values are
/// copied if the cells coincide, averaged if the grid is coarser, and interpolated if it is finer, within the
/// range of the cells around. Cells beyond the raster get the value of the nearest cell on its edge. A raster
/// without georeference is stretched over the grid. Only the cells that the grid covers are read, and none
/// before the header has been checked. The loader throws ConfigError that names the file and the reason; for
/// coordinates in degrees or feet, it says how to project the raster.
RasterLoader gdal_raster_loader(const RasterAccess& access = {});

}  // namespace desert_sim

#pragma once
/// Rasters for a scenario's terrain.

#include "src/io/raster.hpp"
#include "src/scenario/scenario.hpp"

namespace desert_sim {

/// Brings a raster that has been read to what was asked for, as gdal_raster_loader() does.
RasterField fitted(Raster raster, const RasterRequest& request);

/// Reads any raster and brings it to the grid that is asked for: taken as it is where cells coincide,
/// averaged where the grid is coarser, interpolated where it is finer. Cells beyond the raster continue its
/// edge. A raster without georeference is stretched over the grid. Throws ConfigError with the file and the
/// reason.
RasterLoader gdal_raster_loader();

}  // namespace desert_sim

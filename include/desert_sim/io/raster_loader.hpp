#pragma once
/// Public header: rasters that GDAL reads, as terrain.

#include "src/io/raster_loader.hpp"

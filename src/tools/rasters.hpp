#pragma once
/// The raster loader of this build, which depends on the libraries that it was built with.

#if DESERT_WITH_BAGS
#include "src/grid_map/grid_map_bag.hpp"
#elif DESERT_WITH_IO
#include "src/io/raster_loader.hpp"
#else
#include "src/scenario/raster_grid.hpp"
#include "src/scenario/scenario.hpp"
#endif

namespace desert_sim {

/// `all_formats`: as in RasterAccess.
inline RasterLoader raster_loader(bool all_formats = false) {
#if DESERT_WITH_BAGS
  return raster_loader_with_bags({"", all_formats});
#elif DESERT_WITH_IO
  return gdal_raster_loader({"", all_formats});
#else
  static_cast<void>(all_formats);
  return no_raster_loader;
#endif
}

}  // namespace desert_sim

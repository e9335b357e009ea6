// Rasters of the formats that services read, resampled to a small grid.
#include "fuzz/fuzz.hpp"
#include "src/io/raster_loader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  static const RasterLoader load = gdal_raster_loader();
  const fuzz::MemoryFile file(data, size);
  return fuzz::accept_or_refuse([&] {
    RasterRequest request;
    request.path = file.path();
    request.width = 9;
    request.height = 7;
    request.cell_size = 2;
    request.fill_nodata = size % 2 == 0;
    request.stretch = size % 3 == 0;
    load(request);
  });
}

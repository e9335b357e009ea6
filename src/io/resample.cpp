#include "src/io/resample.hpp"

#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gdalwarper.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

#include "src/core/error.hpp"
#include "src/io/gdal_messages.hpp"

namespace desert_sim {
namespace {

GDALResampleAlg gdal_method(Resampling method) {
  switch (method) {
    case Resampling::bilinear:
      return GRA_Bilinear;
    case Resampling::cubic:
      return GRA_Cubic;
    case Resampling::average:
      return GRA_Average;
  }
  return GRA_NearestNeighbour;
}

std::string size_text(int width, int height, double cell_size) {
  std::ostringstream text;
  text.precision(12);
  text << width << " x " << height << " cells of " << cell_size;
  return text.str();
}

void check_grid(const char* what, int width, int height, double cell_size) {
  if (width < 1 || height < 1 || !(cell_size > 0) || !std::isfinite(cell_size) ||
      std::int64_t{width} * height > (std::int64_t{1} << 31))
    throw ConfigError(std::string("resampling: the ") + what + " grid has " +
                      size_text(width, height, cell_size) + ", must be 1 to 2^31 cells of a size > 0");
}

void check_raster(const Raster& raster) {
  check_grid("source", raster.width, raster.height, raster.cell_size);
  if (raster.values.size() != static_cast<std::size_t>(raster.width) * raster.height)
    throw ConfigError("resampling: the source has " + std::to_string(raster.values.size()) + " values for " +
                      size_text(raster.width, raster.height, raster.cell_size));
}

/// A GDAL dataset in memory that refers to the raster's values without a copy. GDAL's first line is then the
/// raster's southern row, so the dataset uses coordinates whose y axis points south. Their origin is the
/// given corner, so that large coordinates lose no precision.
GDALDatasetUniquePtr wrap_as_dataset(Raster& raster, double corner_x, double corner_y) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDatasetUniquePtr dataset(
      driver ? driver->Create("", raster.width, raster.height, 0, GDT_Float32, nullptr) : nullptr);
  if (!dataset) return nullptr;
  char address[64] = "DATAPOINTER=";
  const int used = 12;
  address[used + CPLPrintPointer(address + used, raster.values.data(), sizeof(address) - used - 1)] = '\0';
  char* settings[] = {address, nullptr};
  if (dataset->AddBand(GDT_Float32, settings) != CE_None) return nullptr;
  double geotransform[6] = {raster.origin_x - corner_x, raster.cell_size, 0, -(raster.origin_y - corner_y), 0,
                            -raster.cell_size};
  dataset->SetGeoTransform(geotransform);
  dataset->GetRasterBand(1)->SetNoDataValue(no_data);
  return dataset;
}

struct FreeWarpOptions {
  void operator()(GDALWarpOptions* options) const {
    if (options->pTransformerArg) GDALDestroyGenImgProjTransformer(options->pTransformerArg);
    GDALDestroyWarpOptions(options);
  }
};

double* one_double(double value) {
  auto* list = static_cast<double*>(CPLMalloc(sizeof(double)));
  *list = value;
  return list;
}

int* first_band() {
  auto* list = static_cast<int*>(CPLMalloc(sizeof(int)));
  *list = 1;
  return list;
}

bool warp(GDALDataset& source, GDALDataset& target, GDALResampleAlg method) {
  std::unique_ptr<GDALWarpOptions, FreeWarpOptions> options(GDALCreateWarpOptions());
  options->hSrcDS = GDALDataset::ToHandle(&source);
  options->hDstDS = GDALDataset::ToHandle(&target);
  options->nBandCount = 1;
  options->panSrcBands = first_band();
  options->panDstBands = first_band();
  options->padfSrcNoDataReal = one_double(no_data);
  options->padfDstNoDataReal = one_double(no_data);
  options->eResampleAlg = method;
  options->eWorkingDataType = GDT_Float32;
  options->papszWarpOptions = CSLSetNameValue(options->papszWarpOptions, "INIT_DEST", "NO_DATA");
  options->pTransformerArg = GDALCreateGenImgProjTransformer2(options->hSrcDS, options->hDstDS, nullptr);
  options->pfnTransformer = GDALGenImgProjTransform;
  if (!options->pTransformerArg) return false;
  GDALWarpOperation operation;
  return operation.Initialize(options.get()) == CE_None &&
         operation.ChunkAndWarpImage(0, 0, target.GetRasterXSize(), target.GetRasterYSize()) == CE_None;
}

struct CellRange {
  int first, last;
};

/// The source cells, of `count`, that cubic convolution weighs for each of `cells`.
std::vector<CellRange> weighed_cells(const CellMapping& mapping, int cells, int count) {
  const double reach = 2 * std::max(1.0, mapping.length);
  std::vector<CellRange> ranges(cells);
  for (int n = 0; n < cells; ++n) {
    const double centre =
        mapping.first + (n + 0.5) * mapping.length - 0.5;  // 0: that of the first source cell
    ranges[n] = {static_cast<int>(std::clamp(std::ceil(centre - reach), 0.0, count - 1.0)),
                 static_cast<int>(std::clamp(std::floor(centre + reach), 0.0, count - 1.0))};
  }
  return ranges;
}

}  // namespace

Raster resample(const Raster& source, int width, int height, double cell_size, double origin_x,
                double origin_y, Resampling method) {
  check_raster(source);
  check_grid("target", width, height, cell_size);
  if (!std::isfinite(origin_x) || !std::isfinite(origin_y))
    throw ConfigError("resampling: the target's origin is not finite");
  Raster result;
  result.width = width;
  result.height = height;
  result.cell_size = cell_size;
  result.origin_x = origin_x;
  result.origin_y = origin_y;
  result.projection = source.projection;
  result.values.assign(static_cast<std::size_t>(width) * height, no_data);

  GdalMessages messages;
  auto from = wrap_as_dataset(const_cast<Raster&>(source), source.origin_x, source.origin_y);  // not written
  auto to = wrap_as_dataset(result, source.origin_x, source.origin_y);
  if (!from || !to || !warp(*from, *to, gdal_method(method)))
    throw StateError("resampling to " + size_text(width, height, cell_size) + " failed: " + messages.text());
  to.reset();  // flushes into result.values
  if (method == Resampling::cubic)
    limit_to_sources(result, source,
                     {(origin_x - source.origin_x) / source.cell_size, cell_size / source.cell_size},
                     {(origin_y - source.origin_y) / source.cell_size, cell_size / source.cell_size});
  return result;
}

void limit_to_sources(Raster& raster, const Raster& source, const CellMapping& x, const CellMapping& y) {
  const std::vector<CellRange> columns = weighed_cells(x, raster.width, source.width),
                               rows = weighed_cells(y, raster.height, source.height);
#pragma omp parallel for schedule(static)
  for (int iy = 0; iy < raster.height; ++iy)
    for (int ix = 0; ix < raster.width; ++ix) {
      float low = std::numeric_limits<float>::infinity(), high = -low;
      for (int j = rows[iy].first; j <= rows[iy].last; ++j)
        for (int i = columns[ix].first; i <= columns[ix].last; ++i) {
          const float v = source.values[static_cast<std::size_t>(j) * source.width + i];
          if (v < low) low = v;
          if (v > high) high = v;
        }
      float& value = raster.values[static_cast<std::size_t>(iy) * raster.width + ix];
      if (low <= high && !std::isnan(value)) value = std::clamp(value, low, high);
    }
}

void fill_nodata(Raster& raster) {
  check_raster(raster);
  const long nodata_cells = raster.nodata_count();
  if (nodata_cells == 0) return;
  if (nodata_cells == static_cast<long>(raster.values.size()))
    throw ConfigError("filling nodata: none of the " + std::to_string(nodata_cells) +
                      " cells has a value to fill from");
  Raster filled = raster;
  GdalMessages messages;
  const char* settings[] = {"TEMP_FILE_DRIVER=MEM", nullptr};
  long remaining = nodata_cells;
  bool done = true;
  // GDAL's time grows with the search distance, so the distance is doubled only while unfilled cells are
  // left.
  for (double search_distance = 100;
       done && remaining > 0 && search_distance < 4.0 * (raster.width + raster.height) + 200;
       search_distance *= 2) {
    auto view = wrap_as_dataset(filled, filled.origin_x, filled.origin_y);
    done = view && GDALFillNodata(GDALRasterBand::ToHandle(view->GetRasterBand(1)), nullptr, search_distance,
                                  0, 0, const_cast<char**>(settings), nullptr, nullptr) == CE_None;
    view.reset();
    remaining = filled.nodata_count();
  }
  if (!done || remaining > 0)
    throw StateError("filling nodata: " + std::to_string(remaining) + " of " + std::to_string(nodata_cells) +
                     " cells could not be filled: " + messages.text());
  raster.values = std::move(filled.values);
}

}  // namespace desert_sim

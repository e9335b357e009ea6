#include "src/io/raster_loader.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "src/io/resample.hpp"

namespace desert_sim {

namespace {

bool georeferenced(const Raster& r) {
  return std::any_of(r.geotransform.begin(), r.geotransform.end(), [](double v) { return v != 0; });
}

bool matches_grid(const Raster& r, const RasterRequest& q) {
  const double tolerance = 1e-6 * q.cell_size;
  return r.width == q.width && r.height == q.height &&
         std::abs(r.cell_size - q.cell_size) < 1e-9 * q.cell_size &&
         std::abs(r.origin_x - q.origin_x) < tolerance && std::abs(r.origin_y - q.origin_y) < tolerance;
}

void stretch_to_grid(Raster& r, const RasterRequest& q) {
  if (r.width == q.width && r.height == q.height) return;
  const cv::Mat source(r.height, r.width, CV_32F, r.values.data());
  cv::Mat target;
  const bool finer = q.width > r.width || q.height > r.height;
  cv::resize(source, target, cv::Size(q.width, q.height), 0, 0, finer ? cv::INTER_CUBIC : cv::INTER_AREA);
  r.values.assign(target.ptr<float>(), target.ptr<float>() + target.total());
  r.width = q.width;
  r.height = q.height;
}

/// Gives cells whose centre lies outside the source raster the value of the nearest cell inside it.
void extrapolate_edges(Raster& r, const Raster& source) {
  const auto reached = [](double origin, double cell, double from, double to, int n, int& first, int& last) {
    first = std::clamp(static_cast<int>(std::ceil((from - origin) / cell - 0.5 + 1e-6)), 0, n - 1);
    last = std::clamp(static_cast<int>(std::floor((to - origin) / cell - 0.5 - 1e-6)), first, n - 1);
  };
  int x0, x1, y0, y1;
  reached(r.origin_x, r.cell_size, source.origin_x, source.origin_x + source.width * source.cell_size,
          r.width, x0, x1);
  reached(r.origin_y, r.cell_size, source.origin_y, source.origin_y + source.height * source.cell_size,
          r.height, y0, y1);
  for (int y = 0; y < r.height; ++y)
    for (int x = 0; x < r.width; ++x) {
      const int nearest = std::clamp(y, y0, y1) * r.width + std::clamp(x, x0, x1);
      r.values[static_cast<std::size_t>(y) * r.width + x] = r.values[static_cast<std::size_t>(nearest)];
    }
  if (r.nodata_count() > 0) fill_nodata(r);  // interpolation leaves some beside the edges
}

void resample_to_grid(Raster& r, const RasterRequest& q) {
  if (matches_grid(r, q)) return;
  const double extent = q.cell_size * 1e-6;
  if (q.origin_x > r.origin_x + r.width * r.cell_size - extent ||
      q.origin_y > r.origin_y + r.height * r.cell_size - extent ||
      q.origin_x + q.width * q.cell_size < r.origin_x + extent ||
      q.origin_y + q.height * q.cell_size < r.origin_y + extent)
    throw ConfigError(q.path + ": lies completely outside the grid");
  const double ratio = q.cell_size / r.cell_size;
  const Resampling method =
      ratio > 1.5 ? Resampling::average : (ratio < 0.99 ? Resampling::cubic : Resampling::bilinear);
  Raster target = resample(r, q.width, q.height, q.cell_size, q.origin_x, q.origin_y, method);
  extrapolate_edges(target, r);
  r = std::move(target);
}

RasterField load(const RasterRequest& q) {
  RasterOptions options;
  options.band = q.band;
  options.scale = q.scale;
  options.offset = q.offset;
  return resample_to_request(read_raster(q.path, options), q);
}

}  // namespace

RasterField resample_to_request(Raster r, const RasterRequest& q) {
  if (r.length_unit() == "degree")
    throw ConfigError(
        q.path +
        ": its coordinates are in degrees; project it to metres first (gdalwarp -t_srs EPSG:326xx …)");
  const bool placed = georeferenced(r);
  if (q.width > 0) {
    if (r.nodata_count() > 0 && !q.fill_nodata)
      throw ConfigError(q.path + ": has " + std::to_string(r.nodata_count()) +
                        " cells without data; set fill_nodata to true to fill them from their neighbours");
    if (r.nodata_count() > 0) fill_nodata(r);
    if (q.stretch || !placed) {
      stretch_to_grid(r, q);
    } else {
      resample_to_grid(r, q);
    }
  }
  RasterField field;
  field.width = r.width;
  field.height = r.height;
  field.cell_size = r.cell_size;
  field.origin_x = r.origin_x;
  field.origin_y = r.origin_y;
  field.projection = r.projection;
  field.values = std::move(r.values);
  return field;
}

RasterLoader gdal_raster_loader() { return load; }

}  // namespace desert_sim

#include "src/io/raster_loader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "src/core/log.hpp"
#include "src/io/projection.hpp"
#include "src/io/raster_file.hpp"
#include "src/io/raster_geometry.hpp"
#include "src/io/resample.hpp"
#include "src/scenario/raster_grid.hpp"

namespace desert_sim {

namespace {

/// Of each cell: a copy, and the distances, values and masks of GDALFillNodata().
constexpr double bytes_to_fill = 24;

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
  Raster stretched;
  stretched.projection = r.projection;
  stretched.values.assign(target.ptr<float>(), target.ptr<float>() + target.total());
  stretched.width = q.width;
  stretched.height = q.height;
  stretched.cell_size = q.cell_size;
  stretched.origin_x = q.origin_x;
  stretched.origin_y = q.origin_y;
  if (finer)
    limit_to_sources(stretched, r, {0, static_cast<double>(r.width) / q.width},
                     {0, static_cast<double>(r.height) / q.height});
  r = std::move(stretched);
}

/// Gives cells whose centre lies outside the source raster the value of the nearest cell inside it.
void extrapolate_edges(Raster& r, const Raster& source) {
  const auto reached = [](double origin, double cell, double from, double to, int n, int& first, int& last) {
    const auto clamped = [n](double column,
                             int lowest) {  // before it is cut to an int, which may be too small
      return static_cast<int>(std::clamp<double>(column, lowest, n - 1));
    };
    first = clamped(std::ceil((from - origin) / cell - 0.5 + 1e-6), 0);
    last = clamped(std::floor((to - origin) / cell - 0.5 - 1e-6), first);
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
  const double ratio = q.cell_size / r.cell_size;
  const Resampling method =
      ratio > 1.5 ? Resampling::average : (ratio < 0.99 ? Resampling::cubic : Resampling::bilinear);
  Raster target = resample(r, q.width, q.height, q.cell_size, q.origin_x, q.origin_y, method);
  extrapolate_edges(target, r);
  r = std::move(target);
}

bool is_stretched(const Raster& header, const RasterRequest& q) {
  return q.stretch || !georeferenced(header);
}

void require_overlap(const Raster& header, const RasterRequest& q) {
  const double extent = q.cell_size * 1e-6;
  if (q.origin_x > header.origin_x + header.width * header.cell_size - extent ||
      q.origin_y > header.origin_y + header.height * header.cell_size - extent ||
      q.origin_x + q.width * q.cell_size < header.origin_x + extent ||
      q.origin_y + q.height * q.cell_size < header.origin_y + extent)
    throw ConfigError(q.path + ": lies completely outside the grid");
}

/// The cells that the grid's values depend on: all if the raster is stretched or gaps are filled from afar,
/// else those that the grid covers and as many around them as the widest kernel weighs.
RasterWindow needed_window(const Raster& header, const RasterRequest& q) {
  const RasterWindow whole{0, 0, header.width, header.height};
  if (is_stretched(header, q)) return whole;
  require_overlap(header, q);
  if (q.fill_nodata) return whole;
  const double margin = 4 * std::max(1.0, q.cell_size / header.cell_size);
  const auto range = [&](double from, double length, double origin, int cells, int& first, int& count) {
    const double low = std::floor((from - origin) / header.cell_size - margin),
                 high = std::ceil((from + length - origin) / header.cell_size + margin);
    first = static_cast<int>(std::clamp(low, 0.0, cells - 1.0));
    count = static_cast<int>(std::clamp(high, first + 1.0, 1.0 * cells)) - first;
  };
  RasterWindow window;
  range(q.origin_x, q.width * q.cell_size, header.origin_x, header.width, window.x, window.width);
  range(q.origin_y, q.height * q.cell_size, header.origin_y, header.height, window.y, window.height);
  return window;
}

void require_raster_in_metres(const Raster& header, const std::string& path) {
  if (!header.unusable_placement.empty()) throw_raster_error(path, header.unusable_placement);
  require_metres(
      path, header.projection,
      {header.origin_x, header.origin_y, header.cell_size, header.cell_size, header.width, header.height},
      header.declared);
}

/// Degrees without a projection make slopes that no terrain has.
void warn_of_degrees(const Raster& r, const std::string& path) {
  constexpr double most_heights_per_width = 5, largest_degrees = 0.1;
  if (!r.projection.empty() || !georeferenced(r) || r.cell_size > largest_degrees) return;
  float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
  for (float v : r.values)
    if (std::isfinite(v)) {
      lowest = std::min(lowest, v);
      highest = std::max(highest, v);
    }
  const double width = std::max(r.width, r.height) * r.cell_size;
  if (highest - lowest > most_heights_per_width * width)
    log_warning(concatenate("raster '", path, "': heights differ by ", highest - lowest,
                            " m over a width of ", width,
                            " m. Are its coordinates degrees? Without a projection they are taken for "
                            "metres; declare it with gdal_translate -a_srs"));
}

/// The needed cells of an open file.
Raster needed_cells(RasterFile& file, const RasterRequest& q) {
  Raster raster = file.read(needed_window(file.header(), q));
  if (!q.stretch) warn_of_degrees(raster, q.path);
  return raster;
}

RasterField field_of(Raster r) {
  RasterField field;
  field.width = r.width;
  field.height = r.height;
  field.cell_size = r.cell_size;
  field.origin_x = r.origin_x;
  field.origin_y = r.origin_y;
  field.projection = with_metric_heights(r.projection);
  field.values = std::move(r.values);
  return field;
}

}  // namespace

RasterOptions raster_options(const RasterRequest& q) {
  return {q.band, q.scale, q.offset, q.nodata, q.encoding, q.complete};
}

RasterField resample_to_request(Raster r, const RasterRequest& q) {
  if (q.width == 0) {
    r.values.clear();
    return field_of(std::move(r));
  }
  if (!is_stretched(r, q)) require_overlap(r, q);
  if (const long missing = r.nodata_count(); missing > 0) {
    if (!q.fill_nodata)
      throw ConfigError(q.path + ": has " + std::to_string(missing) +
                        " cells without data; set fill_nodata to true to fill them from their neighbours");
    require_host_memory(q.path, bytes_to_fill * static_cast<double>(r.values.size()),
                        "filling its cells without data");
    fill_nodata(r);
  }
  if (is_stretched(r, q)) {
    stretch_to_grid(r, q);
  } else {
    resample_to_grid(r, q);
  }
  return field_of(std::move(r));
}

RasterLoader gdal_raster_loader(const RasterAccess& access) {
  return [access](const RasterRequest& q) {
    const std::unique_ptr<RasterFile> file = open_raster(q.path, raster_options(q), access);
    if (!q.stretch) require_raster_in_metres(file->header(), q.path);
    return q.width == 0 ? field_of(file->header()) : resample_to_request(needed_cells(*file, q), q);
  };
}

}  // namespace desert_sim

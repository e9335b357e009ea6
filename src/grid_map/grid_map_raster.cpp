/// Converts a layer of a GridMap to a raster.
#include <cmath>
#include <set>
#include <sstream>

#include "src/core/quoted.hpp"
#include "src/grid_map/grid_map_bag.hpp"
#include "src/io/cell_values.hpp"

namespace desert_sim {

namespace {

template <class... Parts>
[[noreturn]] void throw_error(const std::string& source, const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  text << source << ": ";
  (text << ... << parts);
  throw ConfigError(text.str());
}

/// Refuses a rotated map, because grid_map has none. An all-zero quaternion is accepted, since programs that
/// fill in the message by hand often leave it unset.
void require_no_rotation(const GridMapInfo& info, const std::string& source) {
  const auto& q = info.pose.orientation;
  const bool unset = q.x == 0 && q.y == 0 && q.z == 0 && q.w == 0;
  if (!unset && !(std::abs(q.x) < 1e-6 && std::abs(q.y) < 1e-6 && std::abs(q.z) < 1e-6))
    throw_error(source, "the map is rotated: its orientation is (", q.x, ", ", q.y, ", ", q.z, ", ", q.w,
                "), allowed: (0, 0, 0, 1)");
}

void validate_geometry(const GridMapInfo& info, const std::string& source) {
  const auto& p = info.pose.position;
  if (!(std::isfinite(info.resolution) && info.resolution > 0))
    throw_error(source, "resolution: ", info.resolution, " is not a finite number above 0");
  for (double number : {info.length_x, info.length_y, p.x, p.y})
    if (!std::isfinite(number)) throw_error(source, "its lengths and position must be finite");
  require_no_rotation(info, source);
}

void validate_layers(const GridMap& map, const std::string& source) {
  if (map.layers.empty()) throw_error(source, "the map has no layers");
  if (map.layers.size() != map.data.size())
    throw_error(source, "names ", map.layers.size(), " layers but contains ", map.data.size());
  std::set<std::string> names;
  for (const std::string& name : map.layers)
    if (!names.insert(name).second) throw_error(source, "layers: ", in_quotes(name), " is given twice");
}

/// Throws ConfigError unless the layer is column-major and its number of cells agrees with the map's lengths.
void validate_layout(const GridMap& map, std::size_t n, const std::string& source) {
  const std_msgs::Float32MultiArray& layer = map.data[n];
  const std::string name = "layer " + in_quotes(map.layers[n]);
  const auto& dim = layer.layout.dim;
  if (dim.size() != 2 || dim[0].label != "column_index" || dim[1].label != "row_index")
    throw_error(source, name, ": must be column-major: dim[0] column_index and dim[1] row_index");
  const std::uint64_t cells = std::uint64_t{dim[0].size} * dim[1].size;
  if (cells == 0 || cells != layer.data.size() || layer.layout.data_offset != 0)
    throw_error(source, name, ": ", dim[1].size, " x ", dim[0].size, " cells and ", layer.data.size(),
                " values from offset ", layer.layout.data_offset,
                " do not match (required: one value per cell from offset 0)");
  const auto fits = [&](std::uint32_t size, double length) {
    return std::abs(size * map.info.resolution - length) < 0.5 * map.info.resolution;
  };
  if (!fits(dim[1].size, map.info.length_x) || !fits(dim[0].size, map.info.length_y))
    throw_error(source, name, ": ", dim[1].size, " x ", dim[0].size, " cells of ", map.info.resolution,
                " m do not match the map's lengths of ", map.info.length_x, " x ", map.info.length_y, " m");
  if (map.outer_start_index >= dim[1].size || map.inner_start_index >= dim[0].size)
    throw_error(source, "start indices (", map.outer_start_index, ", ", map.inner_start_index,
                ") are not below ", dim[1].size, " x ", dim[0].size);
}

void set_geometry(Raster& raster, const GridMapInfo& info) {
  raster.cell_size = info.resolution;
  raster.origin_x = info.pose.position.x - 0.5 * raster.width * info.resolution;
  raster.origin_y = info.pose.position.y - 0.5 * raster.height * info.resolution;
  const double north = raster.origin_y + raster.height * info.resolution;
  raster.geotransform = {raster.origin_x, info.resolution, 0, north, 0, -info.resolution};
}

}  // namespace

Raster to_raster(const GridMap& map, const RasterOptions& options, const std::string& source) {
  validate_geometry(map.info, source);
  validate_layers(map, source);
  if (options.band < 1 || options.band > static_cast<int>(map.layers.size()))
    throw_error(source, "has no band ", options.band, ": its layers are 1 to ", map.layers.size());
  const auto n = static_cast<std::size_t>(options.band - 1);
  validate_layout(map, n, source);
  if (options.encoding == RasterEncoding::terrarium || options.encoding == RasterEncoding::mapbox)
    throw_error(source, "cannot be of the encoding ",
                raster_encoding_names[static_cast<int>(options.encoding)], ", which pictures have");
  const std_msgs::Float32MultiArray& layer = map.data[n];
  const std::size_t rows = layer.layout.dim[1].size, columns = layer.layout.dim[0].size;
  Raster raster;
  raster.width = static_cast<int>(rows);
  raster.height = static_cast<int>(columns);
  set_geometry(raster, map.info);
  raster.values.resize(rows * columns);
  CellValues cells(options);
  // Row indices run towards lower x and column indices towards lower y, beginning at the start indices of the
  // circular buffer.
  for (std::size_t column = 0; column < columns; ++column)
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t from =
          (column + map.inner_start_index) % columns * rows + (row + map.outer_start_index) % rows;
      const bool at_edge = row == 0 || row == rows - 1 || column == 0 || column == columns - 1;
      const float value = cells.convert(layer.data[from], at_edge);
      if (std::isinf(value))
        throw_error(source, "layer ", in_quotes(map.layers[n]), ": has an infinite value");
      raster.values[(columns - 1 - column) * rows + (rows - 1 - row)] = value;
    }
  if (!options.complete) warn_of_undeclared_nodata(cells, source);
  return raster;
}

}  // namespace desert_sim

#include "src/ros/conversion/map_window.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "src/core/did_you_mean.hpp"
#include "src/core/error.hpp"
#include "src/core/joined.hpp"
#include "src/core/number_text.hpp"
#include "src/core/quoted.hpp"
#include "src/ros/simulation/simulation_thread.hpp"

namespace desert_sim {

// ---- Layers.

std::vector<MapLayer> map_layers_named(const std::vector<std::string>& names, const std::string& key) {
  if (names.size() > map_layers.size())
    throw ConfigError(key + ": " + std::to_string(names.size()) + " names are given, but only " +
                      std::to_string(map_layers.size()) + " layers exist");
  std::vector<MapLayer> chosen;
  for (const std::string& name : names) {
    const auto same = [&](const MapLayer& layer) { return name == layer.name; };
    const MapLayer* const found = find_map_layer(name);
    if (!found) throw ConfigError(key + ": " + not_one_of(name, map_layer_names()));
    if (std::any_of(chosen.begin(), chosen.end(), same))
      throw ConfigError(key + ": " + in_quotes(name) + " is given twice");
    chosen.push_back(*found);
  }
  return chosen;
}

std::string yaml_list(const std::vector<MapLayer>& layers) {
  return "[" + joined(layers, [](const MapLayer& layer) { return layer.name; }) + "]";
}

std::vector<Layer> layers_of(const std::vector<MapLayer>& layers) {
  std::vector<Layer> all;
  all.reserve(all.size() + layers.size());
  for (const MapLayer& layer : layers) all.push_back(layer.layer);
  return all;
}

// ---- Windows.

namespace {

constexpr double max_grid_cells = 1 << 29;  // along an axis, so that sums of two still fit an int
constexpr double max_values = 67108864;
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

[[noreturn]] void throw_error(const std::string& field, double value, const std::string& allowed) {
  std::ostringstream text;
  text << field << ": " << value << " is not " << allowed;
  throw ConfigError(text.str());
}

/// The first cell of a window along an axis, and the number of cells.
void axis_window(const std::string& axis, double center, double length, double origin, double cell,
                 int& first, int& count) {
  if (!std::isfinite(center)) throw_error("center." + axis, center, "a finite number");
  if (!std::isfinite(length) || length <= 0) throw_error("length_" + axis, length, "a finite number above 0");
  const double cells = std::max(1.0, std::floor(length / cell + 0.5));
  const double start = std::floor((center - origin) / cell - 0.5 * cells + 0.5);
  if (cells > max_grid_cells) throw_error("length_" + axis, length, "at most 2^29 cells");
  if (std::abs(start) > max_grid_cells)
    throw_error("center." + axis, center, "within 2^29 cells of the terrain");
  first = static_cast<int>(start);
  count = static_cast<int>(cells);
}

/// The indices of the terrain's cells along an axis of a window; −1 outside an open terrain.
std::vector<int> axis_cells(int first, int count, int n, bool periodic) {
  std::vector<int> cells(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    const int i = periodic ? wrap(first + k, n) : first + k;
    cells[static_cast<std::size_t>(k)] = i >= 0 && i < n ? i : -1;
  }
  return cells;
}

/// Reads cells of a window, and blocks of them (columns x0 … x1 − 1, rows y0 … y1 − 1 of the window). Cells
/// outside the terrain do not count.
struct WindowReader {
  const float* values;  ///< null: 0 everywhere
  std::size_t stride;
  std::vector<int> columns, rows;

  float cell(std::size_t x, std::size_t y) const {
    if (columns[x] < 0 || rows[y] < 0) return unknown;
    return values ? values[static_cast<std::size_t>(rows[y]) * stride + static_cast<std::size_t>(columns[x])]
                  : 0.0f;
  }
  float block(std::size_t x0, std::size_t x1, std::size_t y0, std::size_t y1, Aggregation aggregation) const {
    if (aggregation == Aggregation::center) return cell((x0 + x1) / 2, (y0 + y1) / 2);
    double sum = 0;
    float lowest = std::numeric_limits<float>::infinity();
    int cells = 0;
    for (std::size_t y = y0; y < y1; ++y)
      for (std::size_t x = x0; x < x1; ++x) {
        const float v = cell(x, y);
        if (std::isnan(v)) continue;
        sum += v;
        lowest = std::min(lowest, v);
        ++cells;
      }
    if (cells == 0) return unknown;
    return aggregation == Aggregation::min ? lowest : static_cast<float>(sum / cells);
  }
};

}  // namespace

MapWindow whole_window(const Snapshot& s) { return {0, 0, s.width, s.height}; }

MapWindow window_of(const MapRegion& region, const Snapshot& s) {
  MapWindow w;
  axis_window("x", region.center_x, region.length_x, s.origin_x, s.cell_size, w.x0, w.width);
  axis_window("y", region.center_y, region.length_y, s.origin_y, s.cell_size, w.y0, w.height);
  return w;
}

void require_inside(const MapWindow& w, const MapRegion& region, const Snapshot& s) {
  const bool inside = w.x0 >= 0 && w.y0 >= 0 && w.width <= s.width - w.x0 && w.height <= s.height - w.y0;
  if (inside) return;
  throw ConfigError("region: " + coordinate_text(region.length_x) + " x " + coordinate_text(region.length_y) +
                    " m around " + point_text(region.center_x, region.center_y) +
                    " is not inside the terrain, which reaches from " + point_text(s.origin_x, s.origin_y) +
                    " to " +
                    point_text(s.origin_x + s.width * s.cell_size, s.origin_y + s.height * s.cell_size));
}

void require_map_size(const MapWindow& window, std::size_t layers, const std::string& what) {
  const double values = static_cast<double>(window.width) * window.height * static_cast<double>(layers);
  if (values > max_values)
    throw ConfigError(what + ": " + std::to_string(window.width) + " x " + std::to_string(window.height) +
                      " cells of " + std::to_string(layers) + " layers are too many (allowed: at most " +
                      std::to_string(static_cast<long long>(max_values)) + " values)");
}

std::vector<float> window_values(const Snapshot& s, const MapLayer& layer, const MapWindow& w,
                                 int decimation) {
  const std::vector<float>* values = s.find(layer.layer);
  const WindowReader reader{values ? values->data() : nullptr, static_cast<std::size_t>(s.width),
                            axis_cells(w.x0, w.width, s.width, s.periodic_x),
                            axis_cells(w.y0, w.height, s.height, s.periodic_y)};
  const auto step = static_cast<std::size_t>(decimation);
  const std::size_t columns = reader.columns.size(), rows = reader.rows.size();
  std::vector<float> result;
  result.reserve(((columns + step - 1) / step) * ((rows + step - 1) / step));
  for (std::size_t y = 0; y < rows; y += step)
    for (std::size_t x = 0; x < columns; x += step)
      result.push_back(step == 1 ? reader.cell(x, y)
                                 : reader.block(x, std::min(x + step, columns), y, std::min(y + step, rows),
                                                layer.aggregation));
  return result;
}

std::vector<float> nearest_values(const Snapshot& s, const MapLayer& layer, const MicroReliefWindow& w) {
  const auto cells = [&w](double corner, double origin, double cell, int count, int n, bool periodic) {
    std::vector<int> all(static_cast<std::size_t>(count));
    for (int k = 0; k < count; ++k) {
      const double place = std::floor((corner + (k + 0.5) * w.resolution - origin) / cell),
                   i = periodic ? place - n * std::floor(place / n) : place;
      all[static_cast<std::size_t>(k)] = i >= 0 && i < n ? static_cast<int>(i) : -1;
    }
    return all;
  };
  // A band of a periodic terrain begins in one period and the window perhaps in another.
  const double period = s.micro_relief.periodic_y ? s.micro_relief.grid_height * s.cell_size : 0;
  const double south = period > 0 ? w.y0 - period * std::floor((w.y0 - s.origin_y) / period) : w.y0;
  const std::vector<float>* values = s.find(layer.layer);
  const WindowReader reader{values ? values->data() : nullptr, static_cast<std::size_t>(s.width),
                            cells(w.x0, s.origin_x, s.cell_size, w.columns, s.width, s.periodic_x),
                            cells(south, s.origin_y, s.cell_size, w.rows, s.height, s.periodic_y)};
  std::vector<float> result;
  result.reserve(w.points());
  for (std::size_t y = 0; y < reader.rows.size(); ++y)
    for (std::size_t x = 0; x < reader.columns.size(); ++x) result.push_back(reader.cell(x, y));
  return result;
}

// ---- Cuts.

MapCut cut_terrain(SimulationThread& simulation, const std::vector<MapLayer>& layers, const std::string& what,
                   const std::function<MapWindow(const Snapshot&)>& choose) {
  while (true) {
    const TerrainState whole = simulation.terrain({}).get();
    MapCut cut;
    cut.window = choose(*whole.snapshot);
    require_map_size(cut.window, layers.size(), what);
    cut.state = simulation.terrain(layers_of(layers), {cut.window.y0, cut.window.height}).get();
    if (cut.state.moment.terrain != whole.moment.terrain) continue;  // it was replaced in between
    const double south = cut.state.snapshot->origin_y - whole.snapshot->origin_y;
    cut.window.y0 -= static_cast<int>(std::lround(south / whole.snapshot->cell_size));
    return cut;
  }
}

MicroReliefCut cut_micro_relief(SimulationThread& simulation, const std::vector<MapLayer>& layers,
                                const std::string& what, const MapRegion& region, double resolution) {
  std::vector<Layer> needed = layers_of(layers);
  StateQuery query;
  query.feet = std::count(needed.begin(), needed.end(), Layer::elevation) > 0;
  if (query.feet) needed.insert(needed.end(), MicroRelief::layers().begin(), MicroRelief::layers().end());
  while (true) {
    const TerrainState whole = simulation.terrain({}).get();
    Snapshot squares = *whole.snapshot;
    squares.cell_size = resolution;
    const MapWindow w = window_of(region, squares);
    require_map_size(w, layers.size(), what);
    const MicroReliefWindow window{squares.origin_x + w.x0 * resolution, squares.origin_y + w.y0 * resolution,
                                   w.width, w.height, resolution};
    MicroReliefCut cut{simulation.terrain(needed, MicroRelief::band(window, *whole.snapshot), query).get(),
                       window};
    if (cut.state.moment.terrain == whole.moment.terrain) return cut;  // else it was replaced in between
  }
}

}  // namespace desert_sim

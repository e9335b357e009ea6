#include "src/simulation/editing/terrain_edit.hpp"

#include <algorithm>
#include <cmath>

#include "kernels/base/math.hpp"
#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/simulation/commands/edit_checks.hpp"
#include "src/simulation/commands/ring.hpp"
#include "src/simulation/undo/cell_list.hpp"

namespace desert_sim {

namespace {

constexpr int max_smoothing_radius = 64;  // [cells]
// What an edit may cost, so that no request holds up the simulation for long: visits of a cell by an edge or
// by a mean.
constexpr double max_edge_visits = 1e9, max_mean_visits = 4e9;

[[noreturn]] void throw_error(const std::string& what) { throw ConfigError("edit_terrain: " + what); }

void check_cost(double visits, double most, double cells, const std::string& what) {
  if (visits <= most) return;
  throw_error("the shape's rectangle has " + std::to_string(static_cast<long long>(cells)) +
              " cells, too many " + what +
              " (allowed: " + std::to_string(static_cast<long long>(cells * most / visits)) + ")");
}

/// The cells from `centre` − reach to `centre` + reach; not more than there are of a periodic axis, and those
/// that there are of an open one.
void span(double centre, double reach, int n, bool periodic, int& first, int& count) {
  double low = std::floor(centre - reach), high = std::ceil(centre + reach);
  if (periodic && high - low > n) low = std::floor(centre - 0.5 * n), high = low + n;
  if (!periodic) low = std::max(low, 0.0), high = std::min(high, static_cast<double>(n));
  first = high > low ? static_cast<int>(low) : 0;
  count = high > low ? static_cast<int>(high - low) : 0;
}

}  // namespace

TerrainEdit::TerrainEdit(const command::EditTerrain& command, Terrain& terrain, const GridParameters& grid,
                         LedgerView ledger)
    : command_(command), terrain_(terrain), grid_(grid) {
  check_edit(command);
  require_layer(command, terrain);
  layer_ = layer_by_name(command.layer);
  brush_.grid = terrain.grid();
  brush_.ledger = ledger;
  choose_layer();
  set_shape();
  change_ = Buffer<Quanta>(terrain.exec(), static_cast<std::size_t>(brush_.area().cells()));
  const double cells = brush_.area().cells();
  const int passes = command.merge == BrushMerge::smooth ? command.smooth_passes : 1;
  if (command.shape == BrushShape::polygon)
    check_cost(cells * brush_.shape.count * passes, max_edge_visits, cells,
               "for a polygon of " + std::to_string(brush_.shape.count) + " points");
  if (command.merge == BrushMerge::smooth)
    smooth();
  else
    merge();
  if (command.conserve) conserve();
  require_heights();
}

void TerrainEdit::choose_layer() {
  brush_.merge = command_.merge;
  brush_.quanta_per_metre = 1.0 / step_size();
  if (!of_material() && counted()) {
    brush_.layer = terrain_.view().quanta(layer_);
    brush_.depth = true;
    brush_.lowest = 0;
    brush_.highest = load_limit;
    brush_.value = command_.value * brush_.quanta_per_metre;
    return;
  }
  if (!of_material()) {
    steps_ = Buffer<Quanta>(terrain_.exec(), static_cast<std::size_t>(brush_.grid.cells()));
    with_backend(terrain_.exec(), [&](auto& e) {
      brush::read_steps(e, brush_.grid, terrain_.view().real(layer_),
                        static_cast<float>(brush_.quanta_per_metre), steps_.data());
    });
    brush_.layer = steps_.data();
    brush_.depth = true;
    brush_.lowest = static_cast<Quanta>(info(layer_).lowest * brush_.quanta_per_metre);
    brush_.highest = static_cast<Quanta>(info(layer_).highest * brush_.quanta_per_metre);
    brush_.value = command_.value * brush_.quanta_per_metre;
    return;
  }
  const TerrainView view = terrain_.view();
  int other_count = 0;
  if (layer_ != Layer::moisture &&
      layer_ != Layer::airborne_sand)  // in the pores of the column, and above it
    for (const Layer layer : {Layer::bedrock, Layer::soil, Layer::sand, Layer::water})
      if (layer != layer_) brush_.other_layers[other_count++] = view.quanta(layer);
  brush_.layer = view.quanta(layer_);
  brush_.material = material_of(layer_);
  brush_.depth = layer_ != Layer::bedrock;
  brush_.lowest = brush_.depth ? 0 : 1 - wall_height;
  brush_.highest = wall_height - 1;
  const bool shift = command_.merge == BrushMerge::add || command_.merge == BrushMerge::sub;
  const double above = brush_.depth || shift ? 0.0 : terrain_.scale().datum;
  brush_.value = (command_.value - above) * brush_.quanta_per_metre;
}

/// What an integer of the brush counts [unit of the layer].
double TerrainEdit::step_size() const {
  return counted() ? terrain_.scale().quantum() : 1 / steps_per_unit(layer_);
}

/// The shape in cells, and the rectangle of cells that bounds it.
void TerrainEdit::set_shape() {
  const double l = grid_.cell_size, ring = command_.conserve ? command_.ring_width / l : 0.0;
  const bool circle = command_.shape == BrushShape::circle;
  const wind::Vector axis = circle ? wind::Vector{1, 0} : unit_vector(command_.angle_deg);
  const double a = command_.radius / l, b = (circle ? command_.radius : command_.radius_y) / l;
  brush::Shape& s = brush_.shape;
  s = {command_.shape,
       static_cast<float>(a),
       static_cast<float>(b),
       axis.x,
       axis.y,
       static_cast<float>(command_.inner),
       static_cast<float>(command_.falloff / l),
       nullptr,
       0,
       command_.patch_use,
       {}};
  brush_.ring = static_cast<float>(ring);

  if (!command_.points.empty()) {
    double west = 1e300, south = 1e300, east = -1e300, north = -1e300;
    for (const command::Point& p : command_.points) {
      west = std::min(west, p.x), east = std::max(east, p.x);
      south = std::min(south, p.y), north = std::max(north, p.y);
    }
    const double x = 0.5 * (west + east), y = 0.5 * (south + north);
    const double cap_radius = command_.shape == BrushShape::capsule ? a : 0.0;
    std::vector<brush::Point> vertices;
    for (const command::Point& p : command_.points)
      vertices.push_back({static_cast<float>((p.x - x) / l), static_cast<float>((p.y - y) / l)});
    vertices_ = Buffer<brush::Point>(terrain_.exec(), vertices.size());
    vertices_.upload(vertices);
    s.vertices = vertices_.data();
    s.count = static_cast<int>(vertices.size());
    set_window(x, y, 0.5 * (east - west) / l + cap_radius, 0.5 * (north - south) / l + cap_radius);
    return;
  }
  const double u = a + ring, v = b + ring;  // half extents of the turned shape, with its ring
  if (circle || command_.shape == BrushShape::ellipse) {
    set_window(command_.x, command_.y, elementary::hypot(u * axis.x, v * axis.y) - ring,
               elementary::hypot(u * axis.y, v * axis.x) - ring);
  } else {
    const double along = std::abs(axis.x), across = std::abs(axis.y);
    set_window(command_.x, command_.y, u * along + v * across - ring, u * across + v * along - ring);
  }
  if (command_.shape != BrushShape::patch) return;
  patch_ = Buffer<float>(terrain_.exec(), command_.patch.values.size());
  patch_.upload(command_.patch.values);
  s.patch = {patch_.data(), command_.patch.columns, command_.patch.rows};
}

/// Centre [m] and half extents [cells] of the shape; the ring comes on top.
void TerrainEdit::set_window(double centre_x, double centre_y, double reach_x, double reach_y) {
  const Grid& g = brush_.grid;
  const double l = grid_.cell_size, ring = brush_.ring;
  // What is longer than a periodic axis would lie on itself. Round and rectangular shapes are cut off there.
  const bool long_kind = !command_.points.empty() || command_.shape == BrushShape::patch;
  if (long_kind && ((g.periodic_x && 2 * reach_x > g.width * (1 + 1e-9)) ||
                    (g.periodic_y && 2 * reach_y > g.height * (1 + 1e-9))))
    throw_error("the shape, " + std::to_string(2 * reach_x * l) + " x " + std::to_string(2 * reach_y * l) +
                " m, reaches around the periodic terrain (allowed: " + std::to_string(g.width * l) + " x " +
                std::to_string(g.height * l) + " m)");
  // Bring the centre onto a periodic grid, so that single precision places it.
  double x = (centre_x - grid_.origin_x) / l, y = (centre_y - grid_.origin_y) / l;
  if (g.periodic_x) x -= g.width * std::floor(x / g.width);
  if (g.periodic_y) y -= g.height * std::floor(y / g.height);
  span(x, reach_x + ring, g.width, g.periodic_x, brush_.x0, brush_.columns);
  span(y, reach_y + ring, g.height, g.periodic_y, brush_.y0, brush_.rows);
  brush_.centre_x = static_cast<float>(x);
  brush_.centre_y = static_cast<float>(y);
  if (brush_.columns == 0 || brush_.rows == 0)
    throw_error("the brush at (" + std::to_string(centre_x) + ", " + std::to_string(centre_y) +
                ") covers no cell of the terrain");
  changed_cells_ = {brush_.x0, brush_.y0, brush_.x0 + brush_.columns, brush_.y0 + brush_.rows};
  // Over a periodic border the rectangle that holds both parts is the whole axis.
  if (changed_cells_.x0 < 0 || changed_cells_.x1 > g.width)
    changed_cells_.x0 = 0, changed_cells_.x1 = g.width;
  if (changed_cells_.y0 < 0 || changed_cells_.y1 > g.height)
    changed_cells_.y0 = 0, changed_cells_.y1 = g.height;
}

void TerrainEdit::merge() {
  with_backend(terrain_.exec(), [&](auto& e) {
    brush::merge(e, brush_, change_.data());
    total_ = brush::total(e, brush_, change_.data());
  });
}

void TerrainEdit::smooth() {
  const double cells = std::max(1.0, std::round(command_.smooth_radius / grid_.cell_size));
  if (cells > max_smoothing_radius)
    throw_error("smooth_radius: " + std::to_string(command_.smooth_radius) + " is not in [0.001, " +
                std::to_string(max_smoothing_radius * static_cast<double>(grid_.cell_size)) + "] m (" +
                std::to_string(max_smoothing_radius) + " cells)");
  const int radius = static_cast<int>(cells);
  const double area = brush_.area().cells();
  check_cost(area * command_.smooth_passes * 2 * (2 * radius + 1), max_mean_visits, area,
             "to smooth over smooth_radius in smooth_passes");
  Exec& exec = terrain_.exec();
  const std::size_t rows = static_cast<std::size_t>(brush_.rows + 2 * radius);
  brush::SmoothWorkspace work{Buffer<Quanta>(exec, static_cast<std::size_t>(brush_.grid.cells())),
                              Buffer<long long>(exec, static_cast<std::size_t>(brush_.columns) * rows)};
  with_backend(exec, [&](auto& e) {
    brush::smooth(e, brush_, radius, command_.smooth_passes, work, change_.data());
    total_ = brush::total(e, brush_, change_.data());
  });
}

/// Lets the ring give or take what the shape needs or has left. Dealt on the host, which counts alike for
/// both backends.
void TerrainEdit::conserve() {
  Buffer<Quanta> on_device(terrain_.exec(), change_.size());
  with_backend(terrain_.exec(), [&](auto& e) { brush::ring_stock(e, brush_, on_device.data()); });
  const std::vector<Quanta> stock = on_device.download();
  if (total_ == 0) return;
  const double quantum = terrain_.scale().quantum(), cell = quantum * grid_.cell_size * grid_.cell_size;
  const RingTotals ring = ring_totals(stock);
  const std::string width = "conserve: the ring of " + std::to_string(command_.ring_width) + " m ";
  if (ring.cells == 0) throw_error(width + "around the shape contains no cell (choose a larger ring_width)");
  if (total_ > 0 && ring.stock < total_)
    throw_error(width + "contains " + std::to_string(static_cast<double>(ring.stock) * cell) + " m^3 of " +
                command_.layer + ", and the edit needs " +
                std::to_string(static_cast<double>(total_) * cell) + " m^3");
  if (std::abs(total_) / ring.cells >= load_limit)
    throw_error(width + "would change by " +
                std::to_string(static_cast<double>(std::abs(total_) / ring.cells) * quantum) +
                " m per cell (allowed: at most " + std::to_string(load_limit * quantum) + " m)");
  std::vector<Quanta> change = change_.download();
  distribute_to_ring(-total_, stock, change);
  change_.upload(change);
}

void TerrainEdit::require_heights() const {
  if (!of_material()) return;
  const long long beyond = with_backend(
      terrain_.exec(), [&](auto& e) { return brush::cells_beyond_limit(e, brush_, change_.data()); });
  if (beyond == 0) return;
  const double reach = static_cast<double>(load_limit) * terrain_.scale().quantum(),
               datum = terrain_.scale().datum;
  throw_error("value: " + std::to_string(command_.value) + " would bring " + std::to_string(beyond) +
              " cells out of the range of elevations that this terrain can represent (allowed: [" +
              std::to_string(datum - reach) + ", " + std::to_string(datum + reach) + "] m)");
}

CommandResult TerrainEdit::commit(bool with_change) {
  CommandResult result;
  if (!of_material() && counted()) {
    with_backend(terrain_.exec(), [&](auto& e) { brush::commit_change(e, brush_, change_.data(), true); });
  } else if (!of_material()) {
    if (edit_kind(layer_) == EditKind::painted && !change().painted.empty()) terrain_.allocate(layer_);
    with_backend(terrain_.exec(), [&](auto& e) {
      brush::commit_steps(e, brush_, change_.data(), static_cast<float>(step_size()),
                          terrain_.view().real(layer_));
    });
  } else {
    with_backend(terrain_.exec(),
                 [&](auto& e) { brush::commit_change(e, brush_, change_.data(), command_.conserve); });
    const double volume =
        static_cast<double>(total_) * terrain_.scale().quantum() * grid_.cell_size * grid_.cell_size;
    (command_.conserve ? result.moved_m3 : result.volume_m3) = volume;
  }
  result.changed_cells = changed_cells_;
  if (with_change)
    result.changes.push_back({command_.layer, grid_.origin_x + changed_cells_.x0 * grid_.cell_size,
                              grid_.origin_y + changed_cells_.y0 * grid_.cell_size, grid_.cell_size,
                              change_of_rectangle()});
  return result;
}

void TerrainEdit::loosen(const LoosenessParameters& p) {
  if (layer_ != Layer::sand || !terrain_.has(Layer::looseness)) return;
  with_backend(terrain_.exec(), [&](auto& e) {
    brush::loosen(e, brush_, change_.data(), p, static_cast<float>(terrain_.scale().quantum()),
                  terrain_.view().real(Layer::looseness));
  });
}

LayerEdit TerrainEdit::change() const {
  LayerEdit edit{layer_, command_.conserve, {}, {}};
  const std::vector<Quanta> change = change_.download();
  std::size_t k = 0;
  for (int y = 0; y < brush_.rows; ++y)
    for (int x = 0; x < brush_.columns; ++x, ++k)
      if (change[k] != 0) edit.cells.push_back({brush_.cell(x, y), change[k]});
  std::sort(edit.cells.begin(), edit.cells.end(),
            [](const CellAmount& a, const CellAmount& b) { return a.cell < b.cell; });
  if (of_material() || edit.cells.empty()) return edit;
  std::vector<int> cells;
  for (const CellAmount& c : edit.cells) cells.push_back(c.cell);
  const CellList list(terrain_.exec(), cells);
  std::vector<std::uint32_t> before(cells.size(), 0);
  if (terrain_.has(layer_)) before = list.read(terrain_.data(layer_));
  const std::vector<std::uint32_t> steps =
      counted() ? before : list.read(reinterpret_cast<const std::uint32_t*>(steps_.data()));
  for (std::size_t n = 0; n < cells.size(); ++n) {
    const Quanta now = static_cast<Quanta>(steps[n]) + edit.cells[n].amount;
    edit.painted.push_back({cells[n], before[n],
                            counted() ? static_cast<std::uint32_t>(now)
                                      : bits_of(static_cast<float>(now) * static_cast<float>(step_size())),
                            0});
  }
  edit.cells.clear();
  return edit;
}

std::vector<float> TerrainEdit::change_of_rectangle() const {
  const std::vector<Quanta> change = change_.download();
  const auto width = static_cast<std::size_t>(changed_cells_.x1 - changed_cells_.x0);
  std::vector<float> metres(width * static_cast<std::size_t>(changed_cells_.y1 - changed_cells_.y0), 0.0f);
  std::size_t k = 0;
  for (int y = 0; y < brush_.rows; ++y)
    for (int x = 0; x < brush_.columns; ++x, ++k) {
      const int cell = brush_.cell(x, y);
      const auto column = static_cast<std::size_t>(cell % brush_.grid.width - changed_cells_.x0),
                 row = static_cast<std::size_t>(cell / brush_.grid.width - changed_cells_.y0);
      metres[row * width + column] = static_cast<float>(change[k] * step_size());
    }
  return metres;
}

}  // namespace desert_sim

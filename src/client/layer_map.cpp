#include "include/desert_sim/client/layer_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "src/client/layer_tile.hpp"

namespace desert_sim {

namespace {

/// Bit by bit, so that NaN equals NaN.
bool same_bits(const float* a, const float* b, std::uint32_t cells) {
  return std::memcmp(a, b, cells * sizeof(float)) == 0;
}

}  // namespace

void LayerMap::Rectangle::include(const Rectangle& other) {
  if (other.empty()) return;
  if (empty()) {
    *this = other;
    return;
  }
  const std::uint32_t right = std::max(x + width, other.x + other.width),
                      top = std::max(y + height, other.y + other.height);
  x = std::min(x, other.x);
  y = std::min(y, other.y);
  width = right - x;
  height = top - y;
}

// ---- construction ----

LayerMap::LayerMap(MapKeyframe keyframe, const LayerMap* before, Rectangle& changed)
    : info_(std::move(keyframe.info)), keyframe_(std::move(keyframe.values)) {
  blocks_.resize(static_cast<std::size_t>(blocks_across()) * ((info_.height + block_side - 1) / block_side));

  changed = {0, 0, info_.width, info_.height};
  if (!before || !same_geometry(*before)) return;
  changed = difference(*before);
}

/// The smallest rectangle with all cells that differ from a map of the same geometry. Cells inside what is
/// known of it already are not looked at.
LayerMap::Rectangle LayerMap::difference(const LayerMap& other) const {
  const auto row_differs = [&](std::uint32_t y) {
    return first_difference(other, y, 0, info_.width) < info_.width;
  };
  std::uint32_t south = 0, north = info_.height, west = info_.width, east = 0;
  while (south < north && !row_differs(south)) ++south;
  if (south == north) return {};
  while (!row_differs(north - 1)) --north;
  for (std::uint32_t y = south; y < north; ++y) {
    west = first_difference(other, y, 0, west);
    east = end_of_difference(other, y, east, info_.width);
  }
  return {west, south, east - west, north - south};
}

/// The first cell of a row from column x on that differs; `end` if none before it does.
std::uint32_t LayerMap::first_difference(const LayerMap& other, std::uint32_t y, std::uint32_t x,
                                         std::uint32_t end) const {
  for (; x < end; x += row_segment_length(x, end)) {
    const float *a = row_segment(x, y), *b = other.row_segment(x, y);
    if (same_bits(a, b, row_segment_length(x, end))) continue;
    while (same_bits(a++, b++, 1)) ++x;
    return x;
  }
  return end;
}

/// One column beyond the last cell of a row before `end` that differs; `begin` if none from there on does.
std::uint32_t LayerMap::end_of_difference(const LayerMap& other, std::uint32_t y, std::uint32_t begin,
                                          std::uint32_t end) const {
  while (begin < end) {
    const std::uint32_t x = std::max(begin, (end - 1) / block_side * block_side);
    const float *a = row_segment(x, y), *b = other.row_segment(x, y);
    if (same_bits(a, b, end - x)) {
      end = x;
      continue;
    }
    while (same_bits(a + (end - 1 - x), b + (end - 1 - x), 1)) --end;
    return end;
  }
  return begin;
}

std::shared_ptr<const LayerMap> LayerMap::with_update(const MapUpdate& update) const {
  std::shared_ptr<LayerMap> map(new LayerMap(*this));
  map->info_.stamp = update.stamp;
  map->info_.step = update.step;
  map->info_.sim_time = update.sim_time;
  map->info_.sequence = update.sequence;
  TileDecoder reader;
  for (const LayerTile& tile : *update.tiles) map->apply_tile(tile, reader, *this);
  return map;
}

void LayerMap::apply_tile(const LayerTile& tile, TileDecoder& reader, const LayerMap& before) {
  const std::uint32_t right = tile.x + tile.width, top = tile.y + tile.height;
  reader.begin(tile);
  for (std::uint32_t y = tile.y; y < top; ++y)
    for (std::uint32_t x = tile.x; x < right;) {
      float* const row = writable_block(x, y, before).data() + y % block_side * block_side;
      const std::uint32_t cells = row_segment_length(x, right);
      reader.apply_next(row + x % block_side, cells);
      x += cells;
    }
}

/// The block of a cell, for writing. A block that is still shared with the previous map is copied first.
LayerMap::Block& LayerMap::writable_block(std::uint32_t x, std::uint32_t y, const LayerMap& before) {
  const std::size_t n = y / block_side * blocks_across() + x / block_side;
  if (blocks_[n] == before.blocks_[n]) {
    std::shared_ptr<Block> copy(new Block);  // make_shared would fill it with zeros
    const std::uint32_t west = x / block_side * block_side, south = y / block_side * block_side;
    const std::uint32_t cells = row_segment_length(west, info_.width),
                        rows = row_segment_length(south, info_.height);
    for (std::uint32_t row = 0; row < rows; ++row)
      std::copy_n(row_segment(west, south + row), cells, copy->data() + row * block_side);
    blocks_[n] = std::move(copy);
  }
  return const_cast<Block&>(*blocks_[n]);  // no other map refers to this block yet
}

// ---- queries ----

bool LayerMap::same_geometry(const LayerMap& other) const {
  const Info &a = info_, &b = other.info_;
  return a.frame == b.frame && a.width == b.width && a.height == b.height && a.cell_size == b.cell_size &&
         a.origin_x == b.origin_x && a.origin_y == b.origin_y;
}

std::optional<LayerMap::Cell> LayerMap::cell_of(double x, double y) const {
  const double east = (x - info_.origin_x) / info_.cell_size, north = (y - info_.origin_y) / info_.cell_size;
  if (!(east >= 0 && east <= info_.width && north >= 0 && north <= info_.height)) return std::nullopt;
  return Cell{std::min(static_cast<std::uint32_t>(east), info_.width - 1),
              std::min(static_cast<std::uint32_t>(north), info_.height - 1)};
}

geometry_msgs::Point LayerMap::center_of(const Cell& cell) const {
  geometry_msgs::Point center;
  center.x = info_.origin_x + (cell.x + 0.5) * info_.cell_size;
  center.y = info_.origin_y + (cell.y + 0.5) * info_.cell_size;
  return center;
}

float LayerMap::at(std::uint32_t x, std::uint32_t y) const {
  if (x >= info_.width || y >= info_.height)
    throw std::out_of_range("LayerMap: cell (" + std::to_string(x) + ", " + std::to_string(y) + ") of " +
                            std::to_string(info_.width) + " x " + std::to_string(info_.height));
  return cell(x, y);
}

/// Values of the four cells around a point, and the point's position between their centres, 0…1.
struct LayerMap::CellQuad {
  double z00, z10, z01, z11, fx, fy;
};

std::optional<LayerMap::CellQuad> LayerMap::cells_around(double x, double y) const {
  const double east = (x - info_.origin_x) / info_.cell_size, north = (y - info_.origin_y) / info_.cell_size;
  if (!(east >= 0 && east <= info_.width && north >= 0 && north <= info_.height)) return std::nullopt;
  const auto between = [](double cells, std::uint32_t n, std::uint32_t& first, std::uint32_t& second) {
    const double centre = std::clamp(cells - 0.5, 0.0, n - 1.0);
    first = std::min(static_cast<std::uint32_t>(centre), n > 1 ? n - 2 : 0);
    second = std::min(first + 1, n - 1);
    return centre - first;
  };
  std::uint32_t x0, x1, y0, y1;
  const double fx = between(east, info_.width, x0, x1), fy = between(north, info_.height, y0, y1);
  return CellQuad{cell(x0, y0), cell(x1, y0), cell(x0, y1), cell(x1, y1), fx, fy};
}

std::optional<double> LayerMap::value(double x, double y) const {
  const std::optional<CellQuad> p = cells_around(x, y);
  if (!p) return std::nullopt;
  // A cell of weight 0 may be unknown (NaN).
  const auto part = [](double weight, double z) { return weight > 0 ? weight * z : 0.0; };
  const double z = part((1 - p->fx) * (1 - p->fy), p->z00) + part(p->fx * (1 - p->fy), p->z10) +
                   part((1 - p->fx) * p->fy, p->z01) + part(p->fx * p->fy, p->z11);
  if (std::isnan(z)) return std::nullopt;
  return z;
}

std::optional<double> LayerMap::cell_value(double x, double y) const {
  const std::optional<Cell> c = cell_of(x, y);
  if (!c || std::isnan(cell(c->x, c->y))) return std::nullopt;
  return cell(c->x, c->y);
}

std::optional<LayerMap::Gradient> LayerMap::gradient(double x, double y) const {
  const std::optional<CellQuad> p = cells_around(x, y);
  if (!p) return std::nullopt;
  const Gradient g{((p->z10 - p->z00) * (1 - p->fy) + (p->z11 - p->z01) * p->fy) / info_.cell_size,
                   ((p->z01 - p->z00) * (1 - p->fx) + (p->z11 - p->z10) * p->fx) / info_.cell_size};
  if (std::isnan(g.x) || std::isnan(g.y)) return std::nullopt;
  return g;
}

std::optional<geometry_msgs::Vector3> LayerMap::normal(double x, double y) const {
  const std::optional<Gradient> g = gradient(x, y);
  if (!g) return std::nullopt;
  const double length = std::sqrt(1 + g->x * g->x + g->y * g->y);
  geometry_msgs::Vector3 normal;
  normal.x = -g->x / length;
  normal.y = -g->y / length;
  normal.z = 1 / length;
  return normal;
}

std::optional<double> LayerMap::slope(double x, double y) const {
  const std::optional<Gradient> g = gradient(x, y);
  if (!g) return std::nullopt;
  return std::atan(std::hypot(g->x, g->y));
}

std::vector<float> LayerMap::values() const { return values({0, 0, info_.width, info_.height}); }

std::vector<float> LayerMap::values(const Rectangle& r) const {
  const std::uint64_t right = std::uint64_t{r.x} + r.width, top = std::uint64_t{r.y} + r.height;
  if (right > info_.width || top > info_.height)
    throw std::out_of_range("LayerMap: cells up to (" + std::to_string(right) + ", " + std::to_string(top) +
                            ") of " + std::to_string(info_.width) + " x " + std::to_string(info_.height));
  std::vector<float> copy;
  copy.reserve(static_cast<std::size_t>(r.width) * r.height);
  for (std::uint32_t y = r.y; y < top; ++y)
    for (std::uint32_t x = r.x; x < right;) {
      const std::uint32_t n = row_segment_length(x, static_cast<std::uint32_t>(right));
      const float* const from = row_segment(x, y);
      copy.insert(copy.end(), from, from + n);
      x += n;
    }
  return copy;
}

}  // namespace desert_sim

#include "src/client/layer_map.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "src/client/layer_tile.hpp"

namespace desert_sim {

namespace {

/// The range of cells in which two rows of values differ, as a rectangle in row 0. They are compared bit
/// by bit, so that NaN equals NaN.
LayerMap::Rectangle changed_range(const float* a, const float* b, std::uint32_t cells) {
  const auto same = [a, b](std::uint32_t first, std::uint32_t count) {
    return std::memcmp(a + first, b + first, count * sizeof(float)) == 0;
  };
  if (same(0, cells)) return {};
  std::uint32_t first = 0, last = cells - 1;
  while (same(first, 1)) ++first;
  while (same(last, 1)) --last;
  return {first, 0, last - first + 1, 1};
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

// ---- messages ----

namespace {

template <class Message>
MapInfo info_of(const Message& keyframe, const std::string& layer, const std::string& unit) {
  MapInfo info;
  info.layer = layer;
  info.unit = unit;
  info.frame = keyframe.header.frame_id;
  info.stamp = keyframe.header.stamp;
  info.step = keyframe.step;
  info.sim_time = keyframe.sim_time;
  info.keyframe = keyframe.keyframe;
  info.width = keyframe.width;
  info.height = keyframe.height;
  info.cell_size = keyframe.cell_size;
  info.origin_x = keyframe.origin.position.x;
  info.origin_y = keyframe.origin.position.y;
  return info;
}

const std::vector<float>& values_of(const ElevationGrid& keyframe) { return keyframe.elevation; }
const std::vector<float>& values_of(const LayerGrid& keyframe) { return keyframe.data; }

const std::string elevation_layer = "elevation";
const std::string& layer_of(const ElevationUpdate&) { return elevation_layer; }
const std::string& layer_of(const LayerUpdate& update) { return update.layer; }

/// A part of a message, which keeps the message.
template <class Part, class Message>
std::shared_ptr<const Part> shared_part(const boost::shared_ptr<const Message>& message, const Part& part) {
  return {&part, [message](const Part*) {}};
}

}  // namespace

MapKeyframe::MapKeyframe(const ElevationGrid::ConstPtr& message)
    : info(info_of(*message, elevation_layer, "m")), values(shared_part(message, message->elevation)) {}

MapKeyframe::MapKeyframe(const LayerGrid::ConstPtr& message)
    : info(info_of(*message, message->layer, message->unit)), values(shared_part(message, message->data)) {}

template <class Message>
MapUpdate::MapUpdate(const Message& message, std::shared_ptr<const std::vector<LayerTile>> its_tiles)
    : layer(layer_of(message)),
      frame(message.header.frame_id),
      stamp(message.header.stamp),
      step(message.step),
      sim_time(message.sim_time),
      keyframe(message.keyframe),
      sequence(message.sequence),
      tiles(std::move(its_tiles)) {}

MapUpdate::MapUpdate(const ElevationUpdate::ConstPtr& message)
    : MapUpdate(*message, shared_part(message, message->tiles)) {}

MapUpdate::MapUpdate(const LayerUpdate::ConstPtr& message)
    : MapUpdate(*message, shared_part(message, message->tiles)) {}

namespace {

/// The update without its message, which has to outlive it.
MapUpdate borrowed(const ElevationUpdate& update) {
  return MapUpdate(ElevationUpdate::ConstPtr(&update, [](const ElevationUpdate*) {}));
}

}  // namespace

// ---- construction ----

LayerMap::LayerMap(MapKeyframe keyframe, const LayerMap* before, Rectangle& changed)
    : info_(std::move(keyframe.info)), keyframe_(std::move(keyframe.values)) {
  blocks_.resize(static_cast<std::size_t>(blocks_across()) * ((info_.height + block_side - 1) / block_side));

  changed = {0, 0, info_.width, info_.height};
  if (!before || !same_geometry(*before)) return;
  changed = {};
  for (std::uint32_t y = 0; y < info_.height; ++y)
    for (std::uint32_t x = 0; x < info_.width; x += row_segment_length(x, info_.width)) {
      Rectangle cells =
          changed_range(row_segment(x, y), before->row_segment(x, y), row_segment_length(x, info_.width));
      cells.x += x;
      cells.y = y;
      changed.include(cells);
    }
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

std::shared_ptr<const LayerMap> LayerMap::with_update(const ElevationUpdate& update) const {
  return with_update(borrowed(update));
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
LayerMap::Block& LayerMap::writable_block(std::uint32_t x, std::uint32_t y,
                                                  const LayerMap& before) {
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
  const double east = (x - info_.origin_x) / info_.cell_size, north = (y - info_.origin_y) / info_.cell_size;
  if (!(east >= 0 && east <= info_.width && north >= 0 && north <= info_.height)) return std::nullopt;
  const float v = cell(std::min(static_cast<std::uint32_t>(east), info_.width - 1),
                       std::min(static_cast<std::uint32_t>(north), info_.height - 1));
  if (std::isnan(v)) return std::nullopt;
  return v;
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
    throw std::out_of_range("LayerMap: cells up to (" + std::to_string(right) + ", " +
                            std::to_string(top) + ") of " + std::to_string(info_.width) + " x " +
                            std::to_string(info_.height));
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

// ---- validation ----

namespace {

std::string cells_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height) + " cells";
}

std::string size_error(std::size_t numbers, std::uint32_t width, std::uint32_t height) {
  if (width > 0 && height > 0 && numbers == static_cast<std::uint64_t>(width) * height) return "";
  return std::to_string(numbers) + " values for " + cells_text(width, height);
}

std::string find_infinite(const std::vector<float>& values) {
  unsigned any = 0;  // without a branch, compilers can vectorise the loop
  for (const float z : values) any |= std::fabs(z) == HUGE_VALF ? 1u : 0u;
  if (any == 0) return "";
  const auto bad = std::find_if(values.begin(), values.end(), [](float z) { return std::isinf(z); });
  return "value " + std::to_string(bad - values.begin()) + " is " + std::to_string(*bad) +
         ": must be finite, or NaN if unknown";
}

/// Number of cells that the mask of a tile selects. Sets `error` if the mask does not fit the tile's size.
std::size_t count_changed(const LayerTile& tile, std::string& error) {
  const std::uint64_t cells = std::uint64_t{tile.width} * tile.height;
  if (tile.changed.size() != mask_bytes(cells)) {
    error = std::to_string(tile.changed.size()) + " bytes of mask for " + cells_text(tile.width, tile.height);
    return 0;
  }
  for (std::size_t bit = cells; bit < 8 * tile.changed.size(); ++bit)
    if (mask_bit(tile.changed, bit))
      error = "bit " + std::to_string(bit) + " of its mask is set, and it has " +
              cells_text(tile.width, tile.height);
  std::size_t count = 0;
  for (const std::uint8_t eight : tile.changed) count += std::bitset<8>(eight).count();
  return count;
}

std::string validation_error(const LayerTile& tile) {
  std::string error;
  if (!tile.changes.empty() && !tile.data.empty()) return "has changes and absolute values";
  if (!tile.changes.empty() && tile.bits != 8 && tile.bits != 4)
    return "has changes of " + std::to_string(tile.bits) + " bits: must be 8 or 4";
  std::size_t cells = std::size_t{tile.width} * tile.height, values = tile.changes.size() + tile.data.size();
  if (!tile.changed.empty()) cells = count_changed(tile, error);
  if (tile.bits == 4 && !tile.changes.empty()) values = values == change_bytes(cells, 4) ? cells : 2 * values;
  if (tile.changed.empty()) {
    error = size_error(values, tile.width, tile.height);
  } else if (error.empty() && (cells != values || values == 0)) {
    error = std::to_string(values) + " values for " + std::to_string(cells) + " cells that changed";
  }
  if (error.empty() && !tile.changes.empty() && !(std::isfinite(tile.resolution) && tile.resolution > 0))
    error = "resolution is " + std::to_string(tile.resolution) + ": must be finite and above 0";
  return error.empty() ? find_infinite(tile.data) : error;
}

template <class Keyframe>
std::string keyframe_error(const Keyframe& keyframe) {
  const std::string where = "keyframe " + std::to_string(keyframe.keyframe) + ": ";
  if (const std::string error = size_error(values_of(keyframe).size(), keyframe.width, keyframe.height);
      !error.empty())
    return where + error;
  if (!(std::isfinite(keyframe.cell_size) && keyframe.cell_size > 0))
    return where + "cell_size is " + std::to_string(keyframe.cell_size) + ": must be finite and above 0";
  const geometry_msgs::Point& p = keyframe.origin.position;
  if (!std::isfinite(p.x) || !std::isfinite(p.y) || p.z != 0)
    return where + "origin is (" + std::to_string(p.x) + ", " + std::to_string(p.y) + ", " +
           std::to_string(p.z) + "): must be finite with z = 0";
  const geometry_msgs::Quaternion& q = keyframe.origin.orientation;
  if (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 1)
    return where + "origin's orientation is (" + std::to_string(q.x) + ", " + std::to_string(q.y) + ", " +
           std::to_string(q.z) + ", " + std::to_string(q.w) + "): must be identity (0, 0, 0, 1)";
  if (!std::isfinite(keyframe.sim_time)) return where + "sim_time is not finite";
  if (const std::string error = find_infinite(values_of(keyframe)); !error.empty()) return where + error;
  return "";
}

template <class Update>
std::string place_of(const Update& update) {
  return "update " + std::to_string(update.sequence) + " of keyframe " + std::to_string(update.keyframe) +
         ": ";
}

template <class Update>
std::string update_error(const Update& update) {
  const std::string where = place_of(update);
  if (update.sequence == 0) return where + "sequence counts from 1";
  if (!std::isfinite(update.sim_time)) return where + "sim_time is not finite";
  for (std::size_t i = 0; i < update.tiles.size(); ++i) {
    const std::string error = validation_error(update.tiles[i]);
    if (!error.empty()) return where + "tile " + std::to_string(i) + ": " + error;
  }
  return "";
}

}  // namespace

std::string validation_error(const ElevationGrid& keyframe) { return keyframe_error(keyframe); }
std::string validation_error(const LayerGrid& keyframe) { return keyframe_error(keyframe); }
std::string validation_error(const ElevationUpdate& update) { return update_error(update); }
std::string validation_error(const LayerUpdate& update) { return update_error(update); }

std::string validation_error(const MapUpdate& update, const MapInfo& map) {
  const std::string where = place_of(update);
  if (update.layer != map.layer)
    return where + "its layer is '" + update.layer + "', that of the keyframe '" + map.layer + "'";
  if (update.frame != map.frame)
    return where + "its frame is '" + update.frame + "', that of the keyframe '" + map.frame + "'";
  for (std::size_t i = 0; i < update.tiles->size(); ++i) {
    const LayerTile& tile = (*update.tiles)[i];
    const std::uint64_t right = std::uint64_t{tile.x} + tile.width, top = std::uint64_t{tile.y} + tile.height;
    if (right > map.width || top > map.height)
      return where + "tile " + std::to_string(i) + " reaches to cell (" + std::to_string(right) + ", " +
             std::to_string(top) + ") of a grid of " + std::to_string(map.width) + " x " +
             std::to_string(map.height);
  }
  return "";
}

std::string validation_error(const ElevationUpdate& update, const MapInfo& map) {
  return validation_error(borrowed(update), map);
}

}  // namespace desert_sim

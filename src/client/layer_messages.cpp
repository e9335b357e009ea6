#include "include/desert_sim/client/layer_messages.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <sstream>

#include "src/client/layer_tile.hpp"

namespace desert_sim {

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

constexpr const char* elevation_layer = "elevation";
std::string layer_of(const ElevationUpdate&) { return elevation_layer; }
std::string layer_of(const LayerUpdate& update) { return update.layer; }

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

MapUpdate::MapUpdate(const ElevationUpdate& message)
    : MapUpdate(message, {&message.tiles, [](const std::vector<LayerTile>*) {}}) {}

MapUpdate::MapUpdate(const ElevationUpdate::ConstPtr& message)
    : MapUpdate(*message, shared_part(message, message->tiles)) {}

MapUpdate::MapUpdate(const LayerUpdate::ConstPtr& message)
    : MapUpdate(*message, shared_part(message, message->tiles)) {}

// ---- validation ----

namespace {

std::string cells_text(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height) + " cells";
}

std::string size_error(std::size_t numbers, std::uint32_t width, std::uint32_t height) {
  if (width > 0 && height > 0 && numbers == static_cast<std::uint64_t>(width) * height) return "";
  return std::to_string(numbers) + " values for " + cells_text(width, height);
}

// What a desert can have, as its node does: what draws or measures a map can count on it.
constexpr float largest_value = 1e7f;  // of any layer, in its unit
constexpr double smallest_cell = 0.999e-3, largest_cell = 1.001e4, largest_origin = 1.001e8;  // [m]
constexpr float largest_resolution = 1e4f;

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Empty unless a value is out of range; NaN stands for an unknown one.
std::string find_extreme(const std::vector<float>& values) {
  unsigned any = 0;  // without a branch, compilers can vectorise the loop
  for (const float z : values) any |= std::fabs(z) > largest_value ? 1u : 0u;
  if (any == 0) return "";
  const auto bad =
      std::find_if(values.begin(), values.end(), [](float z) { return std::fabs(z) > largest_value; });
  return "value " + std::to_string(bad - values.begin()) + " is " + number(static_cast<double>(*bad)) +
         ": must be within 1e+07, or NaN if unknown";
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
  if (error.empty() && !tile.changes.empty() &&
      !(tile.resolution <= largest_resolution && tile.resolution > 0))
    error =
        "resolution is " + number(static_cast<double>(tile.resolution)) + ": must be above 0, up to 1e+04";
  return error.empty() ? find_extreme(tile.data) : error;
}

template <class Keyframe>
std::string keyframe_error(const Keyframe& keyframe) {
  const std::string where = "keyframe " + std::to_string(keyframe.keyframe) + ": ";
  if (const std::string error = size_error(values_of(keyframe).size(), keyframe.width, keyframe.height);
      !error.empty())
    return where + error;
  if (!(keyframe.cell_size >= smallest_cell && keyframe.cell_size <= largest_cell))
    return where + "cell_size is " + number(keyframe.cell_size) + ": must be 0.001 to 1e+04 m";
  const geometry_msgs::Point& p = keyframe.origin.position;
  if (!(std::abs(p.x) <= largest_origin && std::abs(p.y) <= largest_origin && p.z == 0))
    return where + "origin is (" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) +
           "): must be within 1e+08 m with z = 0";
  const geometry_msgs::Quaternion& q = keyframe.origin.orientation;
  if (q.x != 0 || q.y != 0 || q.z != 0 || q.w != 1)
    return where + "origin's orientation is (" + std::to_string(q.x) + ", " + std::to_string(q.y) + ", " +
           std::to_string(q.z) + ", " + std::to_string(q.w) + "): must be identity (0, 0, 0, 1)";
  if (!std::isfinite(keyframe.sim_time)) return where + "sim_time is not finite";
  if (const std::string error = find_extreme(values_of(keyframe)); !error.empty()) return where + error;
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

}  // namespace desert_sim

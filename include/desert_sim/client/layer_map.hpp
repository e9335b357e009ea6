#pragma once
/// The map of a layer that a client has: of the elevation, or of another layer. A map is immutable. An update
/// creates a new map, which shares with the previous one all blocks of cells that the update does not change,
/// and with the keyframe message all blocks that no update has changed since.

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "desert_sim/client/layer_messages.hpp"

namespace desert_sim {

class TileDecoder;

class LayerMap {
 public:
  /// Cells x … x + width - 1, y … y + height - 1; (0, 0) is the south-west cell of the grid.
  struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width == 0 || height == 0; }
    /// Enlarges the rectangle so that it contains `other`.
    void include(const Rectangle& other);
  };

  /// A cell of the grid; (0, 0) is the south-west one.
  struct Cell {
    std::uint32_t x = 0, y = 0;
  };

  using Info = MapInfo;

  /// The map of a keyframe, which must be valid (see validation_error()). Sets `changed` to the smallest
  /// rectangle that contains all cells that differ from `before`, or to the whole grid if `before` is null or
  /// has another geometry.
  LayerMap(MapKeyframe keyframe, const LayerMap* before, Rectangle& changed);
  LayerMap(const ElevationGrid::ConstPtr& keyframe, const LayerMap* before, Rectangle& changed)
      : LayerMap(MapKeyframe(keyframe), before, changed) {}

  const Info& info() const { return info_; }
  /// Whether both maps have the same frame, size, origin and cell size, so that cell (x, y) covers the same
  /// ground.
  bool same_geometry(const LayerMap& other) const;

  /// The cell in which a point (x, y) of the map's frame lies; empty if it is outside the grid, whose outer
  /// edges belong to it.
  std::optional<Cell> cell_of(double x, double y) const;
  /// Centre of a cell in the map's frame; z is 0.
  geometry_msgs::Point center_of(const Cell& cell) const;

  /// Value of a cell in the map's unit, NaN if unknown. Throws std::out_of_range for a cell outside the grid.
  float at(std::uint32_t x, std::uint32_t y) const;
  /// Value at a point (x, y) in the map's frame, interpolated bilinearly between cell centres and constant
  /// beyond the outermost centres. Empty if the point is outside the grid or an interpolated cell is unknown.
  std::optional<double> value(double x, double y) const;
  /// Value of the cell in which a point lies, for layers whose values are no quantities (the species of
  /// `plants`), or must not be blended (a traversability of 0). Empty where value() would be.
  std::optional<double> cell_value(double x, double y) const;

  /// value() by the name that it has for the elevation. normal() and slope() are those of the surface that it
  /// describes, for layers in metres, and are empty in the same cases.
  std::optional<double> elevation(double x, double y) const { return value(x, y); }
  /// Upward unit normal.
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  /// Angle to the horizontal, 0 … π/2 [rad].
  std::optional<double> slope(double x, double y) const;

  /// A copy of all cells, row-major, x fastest, row 0 in the south.
  std::vector<float> values() const;
  /// A copy of the cells of a rectangle in the same order. Throws std::out_of_range if it exceeds the grid.
  std::vector<float> values(const Rectangle& cells) const;
  /// values() by the name that it has for the elevation.
  std::vector<float> elevations() const { return values(); }
  std::vector<float> elevations(const Rectangle& cells) const { return values(cells); }

  /// The map after an update, which must be valid for this map (see validation_error()).
  std::shared_ptr<const LayerMap> with_update(const MapUpdate& update) const;
  std::shared_ptr<const LayerMap> with_update(const ElevationUpdate& update) const {
    return with_update(MapUpdate(update));
  }

 private:
  static constexpr std::uint32_t block_side = 64;  ///< side of a block [cells]
  using Block = std::array<float, block_side * block_side>;
  struct Gradient {
    double x, y;
  };
  struct CellQuad;

  LayerMap() = default;
  std::uint32_t blocks_across() const { return (info_.width + block_side - 1) / block_side; }
  /// The values from cell (x, y) eastwards, contiguous up to the end of its block.
  const float* row_segment(std::uint32_t x, std::uint32_t y) const {
    const Block* const block = blocks_[y / block_side * blocks_across() + x / block_side].get();
    return block ? block->data() + y % block_side * block_side + x % block_side
                 : keyframe_->data() + static_cast<std::size_t>(y) * info_.width + x;
  }
  /// The number of contiguous cells from column `x` to the end of its block, at most up to column `end`.
  static std::uint32_t row_segment_length(std::uint32_t x, std::uint32_t end) {
    return std::min(end, (x / block_side + 1) * block_side) - x;
  }
  float cell(std::uint32_t x, std::uint32_t y) const { return *row_segment(x, y); }
  Rectangle difference(const LayerMap& other) const;
  std::uint32_t first_difference(const LayerMap& other, std::uint32_t y, std::uint32_t x,
                                 std::uint32_t end) const;
  std::uint32_t end_of_difference(const LayerMap& other, std::uint32_t y, std::uint32_t begin,
                                  std::uint32_t end) const;
  void apply_tile(const LayerTile& tile, TileDecoder& reader, const LayerMap& before);
  Block& writable_block(std::uint32_t x, std::uint32_t y, const LayerMap& before);
  std::optional<CellQuad> cells_around(double x, double y) const;
  std::optional<Gradient> gradient(double x, double y) const;

  Info info_;
  std::shared_ptr<const std::vector<float>> keyframe_;  ///< its values
  std::vector<std::shared_ptr<const Block>> blocks_;    ///< row-major; null if unchanged since the keyframe
};

/// The map of the elevation.
using ElevationMap = LayerMap;

}  // namespace desert_sim

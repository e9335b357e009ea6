#pragma once
/// The elevation map of a client. A map is immutable. An update creates a new map, which shares with the
/// previous one all blocks of cells that the update does not change, and with the keyframe message all blocks
/// that no update has changed since.

#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <geometry_msgs/Vector3.h>
#include <ros/time.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace desert_sim {

class TileDecoder;

class ElevationMap {
 public:
  /// Cells x … x + width - 1, y … y + height - 1; (0, 0) is the south-west cell of the grid.
  struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width == 0 || height == 0; }
    /// Enlarges the rectangle so that it contains `other`.
    void include(const Rectangle& other);
  };

  struct Info {
    std::string frame;           ///< name of the frame: x east, y north, z up
    ros::Time stamp;             ///< when this state was reached
    std::uint64_t step = 0;      ///< steps since the scenario's start
    double sim_time = 0;         ///< simulated time [s]
    std::uint32_t keyframe = 0;  ///< number of the keyframe on which the map is built
    std::uint32_t sequence = 0;  ///< sequence of the last update in the map; 0: none
    std::uint32_t width = 0;     ///< cells from west to east
    std::uint32_t height = 0;    ///< cells from south to north
    double cell_size = 0;        ///< [m]
    double origin_x = 0;         ///< lower-left corner of cell (0, 0) in the frame [m]
    double origin_y = 0;         ///< [m]
  };

  /// The map of a keyframe, which must be valid (see validation_error()). Sets `changed` to the smallest
  /// rectangle that contains all cells that differ from `before`, or to the whole grid if `before` is null or
  /// has another geometry.
  ElevationMap(ElevationGrid::ConstPtr keyframe, const ElevationMap* before, Rectangle& changed);

  const Info& info() const { return info_; }
  /// Whether both maps have the same frame, size, origin and cell size, so that cell (x, y) covers the same
  /// ground.
  bool same_geometry(const ElevationMap& other) const;

  /// Elevation of a cell [m], NaN if unknown. Throws std::out_of_range for a cell outside the grid.
  float at(std::uint32_t x, std::uint32_t y) const;
  /// Elevation at a point (x, y) in the map's frame [m], interpolated bilinearly between cell centres and
  /// constant beyond the outermost centres. Empty if the point is outside the grid or an interpolated cell is
  /// unknown. normal() and slope() are those of this surface and are empty in the same cases.
  std::optional<double> elevation(double x, double y) const;
  /// Upward unit normal.
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  /// Angle to the horizontal, 0 … π/2 [rad].
  std::optional<double> slope(double x, double y) const;

  /// A copy of all cells, row-major, x fastest, row 0 in the south [m].
  std::vector<float> elevations() const;
  /// A copy of the cells of a rectangle in the same order [m]. Throws std::out_of_range if it exceeds the
  /// grid.
  std::vector<float> elevations(const Rectangle& cells) const;

  /// The map after an update, which must be valid for this map (see validation_error()).
  std::shared_ptr<const ElevationMap> with_update(const ElevationUpdate& update) const;

 private:
  static constexpr std::uint32_t block_side = 64;  ///< side of a block [cells]
  using Block = std::array<float, block_side * block_side>;
  struct Gradient {
    double x, y;
  };
  struct CellQuad;

  ElevationMap() = default;
  std::uint32_t blocks_across() const { return (info_.width + block_side - 1) / block_side; }
  /// The elevations from cell (x, y) eastwards, contiguous up to the end of its block.
  const float* row_segment(std::uint32_t x, std::uint32_t y) const {
    const Block* const block = blocks_[y / block_side * blocks_across() + x / block_side].get();
    return block ? block->data() + y % block_side * block_side + x % block_side
                 : keyframe_->elevation.data() + static_cast<std::size_t>(y) * info_.width + x;
  }
  /// The number of contiguous cells from column `x` to the end of its block, at most up to column `end`.
  static std::uint32_t row_segment_length(std::uint32_t x, std::uint32_t end) {
    return std::min(end, (x / block_side + 1) * block_side) - x;
  }
  float cell(std::uint32_t x, std::uint32_t y) const { return *row_segment(x, y); }
  void apply_tile(const ElevationTile& tile, TileDecoder& reader, const ElevationMap& before);
  Block& writable_block(std::uint32_t x, std::uint32_t y, const ElevationMap& before);
  std::optional<CellQuad> cells_around(double x, double y) const;
  std::optional<Gradient> gradient(double x, double y) const;

  Info info_;
  ElevationGrid::ConstPtr keyframe_;
  std::vector<std::shared_ptr<const Block>> blocks_;  ///< row-major; null if unchanged since the keyframe
};

/// Why a keyframe is invalid, with the offending value; empty if it is valid.
std::string validation_error(const ElevationGrid& keyframe);
/// Why an update is invalid for any map; empty if it is valid.
std::string validation_error(const ElevationUpdate& update);
/// Why an update cannot be applied to this map; empty if it can.
std::string validation_error(const ElevationUpdate& update, const ElevationMap::Info& map);

}  // namespace desert_sim

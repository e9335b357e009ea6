#pragma once
/// The surface as a client holds it. A map never changes once it is made; the map after an update shares with
/// the one before all blocks of cells that the update leaves alone, and the keyframe's own cells where no
/// update has written since.

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

class TileReader;

class ElevationMap {
 public:
  /// Cells x … x + width - 1, y … y + height - 1; (0, 0) is the south-west one.
  struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
    bool empty() const { return width == 0 || height == 0; }
    void include(const Rectangle& other);
  };

  struct Info {
    std::string frame;           ///< x east, y north, z up
    ros::Time stamp;             ///< when this state was reached
    std::uint64_t step = 0;      ///< since the scenario's start
    double sim_time = 0;         ///< [s]
    std::uint32_t keyframe = 0;  ///< the keyframe that this is built on
    std::uint32_t sequence = 0;  ///< the last update written over it; 0: none
    std::uint32_t width = 0;     ///< cells from west to east
    std::uint32_t height = 0;    ///< cells from south to north
    double cell_size = 0;        ///< [m]
    double origin_x = 0;         ///< lower-left corner of cell (0, 0) in the frame [m]
    double origin_y = 0;         ///< [m]
  };

  /// Of a keyframe, which must be sound: see fault_of(). `changed` becomes the smallest rectangle of cells
  /// that differ from those of `before`, all cells if that is null or has another geometry.
  ElevationMap(ElevationGrid::ConstPtr keyframe, const ElevationMap* before, Rectangle& changed);

  const Info& info() const { return info_; }
  /// Whether both have the same frame, size, place and cells, so that cell (x, y) is the same piece of
  /// ground.
  bool same_geometry(const ElevationMap& other) const;

  /// Elevation of a cell [m], NaN if unknown. Throws std::out_of_range off the grid.
  float at(std::uint32_t x, std::uint32_t y) const;
  /// Height at (x, y) of the frame [m], bilinear between the centres of cells and level beyond the outermost
  /// ones. None off the grid or where a cell that it takes is unknown. So with the next two, which are of the
  /// same surface.
  std::optional<double> elevation(double x, double y) const;
  /// Unit vector, upwards.
  std::optional<geometry_msgs::Vector3> normal(double x, double y) const;
  /// Angle to the horizontal, 0 … π/2 [rad].
  std::optional<double> slope(double x, double y) const;

  /// A copy of all cells, row-major, x fastest, row 0 in the south [m].
  std::vector<float> elevations() const;
  /// A copy of some cells, ordered likewise. Throws std::out_of_range if they are not all on the grid.
  std::vector<float> elevations(const Rectangle& cells) const;

  /// The map after an update, which must be sound for this map: see fault_of().
  std::shared_ptr<const ElevationMap> after(const ElevationUpdate& update) const;

 private:
  static constexpr std::uint32_t side = 64;  ///< of a block [cells]
  using Block = std::array<float, side * side>;
  struct Gradient {
    double x, y;
  };
  struct Patch;

  ElevationMap() = default;
  std::uint32_t blocks_across() const { return (info_.width + side - 1) / side; }
  /// The cells from this one eastwards, as far as its block goes.
  const float* run(std::uint32_t x, std::uint32_t y) const {
    const Block* const block = blocks_[y / side * blocks_across() + x / side].get();
    return block ? block->data() + y % side * side + x % side
                 : keyframe_->elevation.data() + static_cast<std::size_t>(y) * info_.width + x;
  }
  /// How many these are, or as many as lie before `end`.
  static std::uint32_t run_length(std::uint32_t x, std::uint32_t end) {
    return std::min(end, (x / side + 1) * side) - x;
  }
  float cell(std::uint32_t x, std::uint32_t y) const { return *run(x, y); }
  void write(const ElevationTile& tile, TileReader& reader, const ElevationMap& before);
  Block& own_block(std::uint32_t x, std::uint32_t y, const ElevationMap& before);
  std::optional<Patch> patch(double x, double y) const;
  std::optional<Gradient> gradient(double x, double y) const;

  Info info_;
  ElevationGrid::ConstPtr keyframe_;
  std::vector<std::shared_ptr<const Block>> blocks_;  ///< row-major; null where all cells are the keyframe's
};

/// What makes a keyframe unfit to be held, with the value; empty if nothing does.
std::string fault_of(const ElevationGrid& keyframe);
/// What makes an update unfit, whatever it is written over.
std::string fault_of(const ElevationUpdate& update);
/// What makes it unfit to be written over this map.
std::string fault_of(const ElevationUpdate& update, const ElevationMap::Info& map);

}  // namespace desert_sim

#pragma once
/// What it costs to cross the cells of a terrain, as small integers in few buckets. On a desert every cell
/// creeps, but few change their bucket, and only those have to be planned anew.
///
///   bucket  b = min(floor((1 − t) n), n − 1)                t the traversability, n the number of buckets
///   cost    c = round(4 (1 + weight ((b + ½)/n)²))           4 … 255; 0: lethal
///
/// A cell is lethal where t ≤ `lethal_below` or t is unknown, or if such a cell, or one off the grid, is
/// within the radius of the rover, one cell at least: then no path squeezes diagonally between two of them.
///
/// The arrays have a border of one lethal cell around the grid, so that every cell has eight neighbours.

#include <cstdint>
#include <optional>
#include <vector>

namespace desert_sim {

struct CostParameters {
  int buckets = 16;         ///< 1 … 100
  double weight = 8;        ///< cost of ground that is barely passable, beyond that of the best: 0 … 60
  double lethal_below = 0;  ///< traversability up to which a cell is lethal, 0 … 0.99
  double radius = 0.5;      ///< of the rover [m]
};

/// Place and size of a grid in the terrain's frame. Cell (0, 0) is the south-west one.
struct GridFrame {
  int width = 0, height = 0;
  double cell_size = 1, origin_x = 0, origin_y = 0;  ///< [m]

  bool operator==(const GridFrame& o) const {
    return width == o.width && height == o.height && cell_size == o.cell_size && origin_x == o.origin_x &&
           origin_y == o.origin_y;
  }
};

struct GridPoint {
  double x = 0, y = 0;  ///< [m] in the terrain's frame
};

/// Number of a cell in the arrays with a border.
using CellIndex = std::uint32_t;

class CostGrid {
 public:
  static constexpr std::uint8_t lethal = 0, cheapest = 4;
  struct Box {
    int x = 0, y = 0, width = 0, height = 0;
  };

  /// All cells are unknown at first. Throws ConfigError for parameters or sizes out of range.
  CostGrid(const GridFrame& frame, const CostParameters& parameters);

  const GridFrame& frame() const { return frame_; }
  const CostParameters& parameters() const { return parameters_; }
  /// Cells from one row to the next in the arrays.
  int stride() const { return frame_.width + 2; }
  std::size_t size() const { return costs_.size(); }
  const std::vector<std::uint8_t>& costs() const { return costs_; }
  std::uint8_t cost(CellIndex cell) const { return costs_[cell]; }

  CellIndex cell(int x, int y) const { return static_cast<CellIndex>((y + 1) * stride() + x + 1); }
  int x_of(CellIndex cell) const { return static_cast<int>(cell % static_cast<CellIndex>(stride())) - 1; }
  int y_of(CellIndex cell) const { return static_cast<int>(cell / static_cast<CellIndex>(stride())) - 1; }
  /// The cell in which a point lies; none off the grid.
  std::optional<CellIndex> cell_at(const GridPoint& p) const;
  GridPoint centre(CellIndex cell) const;

  /// Takes the traversability of a box of cells, row by row from the south-west, and appends the cells whose
  /// cost changes to `changed`, some perhaps twice. Throws ConfigError for a box that exceeds the grid.
  void update(const Box& box, const float* traversability, std::vector<CellIndex>& changed);
  /// Makes the cells around a point lethal whatever their traversability is, or no longer, as `update` does.
  /// Marks add up.
  void mark(const GridPoint& p, double radius, bool set, std::vector<CellIndex>& changed);

  /// Whether the cell itself is lethal, not only too near to one.
  bool itself_lethal(CellIndex cell) const { return own_[cell] == lethal || marks_[cell] > 0; }
  /// The passable cell nearest to a point; none within `distance` [m].
  std::optional<CellIndex> nearest_passable(const GridPoint& p, double distance) const;

  /// The cost of a traversability in these buckets.
  std::uint8_t cost_of(float traversability) const;

 private:
  struct Offset {
    int x, y;
  };
  /// Offsets of the cells not further than a radius [m].
  std::vector<Offset> disc(double radius) const;
  /// Calls visit(cell) for the cells of a disc that are on the grid.
  /// The cells of the grid within a radius [m] of another one, row by row, however many cells that is.
  template <class Visit>
  void for_each_within(double radius, CellIndex cell, const Visit& visit) const;
  template <class Visit>
  void for_each_in(const std::vector<Offset>& disc, CellIndex cell, const Visit& visit) const;
  /// Brings the neighbourhood up to date after a cell has become lethal by itself, or has ceased to be.
  void spread(CellIndex cell, bool now_lethal, std::vector<CellIndex>& changed);
  void refresh(CellIndex cell, std::vector<CellIndex>& changed);

  GridFrame frame_;
  CostParameters parameters_;
  std::vector<std::uint8_t> by_bucket_;     ///< cost of each
  std::vector<Offset> near_;                ///< disc of the rover's radius
  std::vector<std::uint8_t> own_;           ///< cost of the cell alone
  std::vector<std::uint16_t> lethal_near_;  ///< how many lethal cells are nearer than the radius
  std::vector<std::uint16_t> marks_;        ///< by mark()
  std::vector<std::uint8_t> costs_;
};

}  // namespace desert_sim

#pragma once
/// Divides a grid of cells into blocks that are drawn, and built anew, one by one. Vertices of a mesh are
/// centres of cells, and neighbouring blocks share the vertices of their common edge.

#include <vector>

#include "src/render/cells.hpp"

namespace desert_sim::render {

class BlockLayout {
 public:
  static constexpr int max_level = 5;  ///< At level L, every 2^L-th vertex of a block is drawn.

  BlockLayout() = default;
  /// Blocks have 64 cells on a side, or 128 where that would be more than 256 blocks: fewer draw calls count
  /// for more than fewer cells in a block that changed.
  BlockLayout(int width, int height);
  /// All cells in one block, for a mesh of the whole terrain.
  static BlockLayout whole(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  int side() const { return side_; }
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// 0 for grids without an area: less than 2 cells wide or high.
  int count() const { return columns_ * rows_; }

  /// The cells whose centres are vertices of a block at level 0, its edges included.
  CellRectangle vertices(int block) const;
  /// The cells that a block's mesh at this level depends on: vertices, and what the normals at its edges
  /// need.
  CellRectangle needed_cells(int block, int level) const;
  /// Whether the neighbours in the west, east, south and north exist.
  struct Neighbours {
    bool west, east, south, north;
  };
  Neighbours neighbours(int block) const;
  /// The blocks whose mesh, at levels[block], depends on any of these cells.
  std::vector<int> touched(const CellRectangle& cells, const std::vector<int>& levels) const;

 private:
  int width_ = 0, height_ = 0, side_ = 64, columns_ = 0, rows_ = 0;
};

}  // namespace desert_sim::render

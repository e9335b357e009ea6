#include "src/render/block_layout.hpp"

#include <algorithm>

namespace desert_sim::render {

BlockLayout::BlockLayout(int width, int height) : width_(width), height_(height) {
  if (width < 2 || height < 2) return;
  constexpr int few = 256;
  const auto divide = [this] {
    columns_ = (width_ - 2) / side_ + 1;
    rows_ = (height_ - 2) / side_ + 1;
  };
  divide();
  if (count() <= few) return;
  side_ = 128;
  divide();
}

BlockLayout BlockLayout::whole(int width, int height) {
  BlockLayout layout;
  layout.width_ = width;
  layout.height_ = height;
  if (width < 2 || height < 2) return layout;
  layout.side_ = std::max(width, height) - 1;
  layout.columns_ = layout.rows_ = 1;
  return layout;
}

CellRectangle BlockLayout::vertices(int block) const {
  const int x = block % columns_ * side_, y = block / columns_ * side_;
  return CellRectangle{x, y, side_ + 1, side_ + 1}.clipped({0, 0, width_, height_});
}

CellRectangle BlockLayout::needed_cells(int block, int level) const {
  return vertices(block).grown(1 << level).clipped({0, 0, width_, height_});
}

BlockLayout::Neighbours BlockLayout::neighbours(int block) const {
  const int column = block % columns_, row = block / columns_;
  return {column > 0, column + 1 < columns_, row > 0, row + 1 < rows_};
}

std::vector<int> BlockLayout::touched(const CellRectangle& cells, const std::vector<int>& levels) const {
  std::vector<int> blocks;
  const CellRectangle near = cells.clipped({0, 0, width_, height_}).grown(1 << max_level);
  if (cells.empty() || count() == 0) return blocks;
  const int first_column = std::max(0, (near.x - 1) / side_), first_row = std::max(0, (near.y - 1) / side_);
  for (int row = first_row; row < rows_ && row * side_ < near.top(); ++row)
    for (int column = first_column; column < columns_ && column * side_ < near.right(); ++column) {
      const int block = row * columns_ + column;
      if (!needed_cells(block, levels[static_cast<std::size_t>(block)]).clipped(cells).empty())
        blocks.push_back(block);
    }
  return blocks;
}

}  // namespace desert_sim::render

#pragma once
/// Rectangles of cells and the values in them, for drawing. Cell (0, 0) is the south-west cell of a grid;
/// values are row-major, x fastest, and NaN where unknown.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace desert_sim::render {

/// Cells x … x + width - 1, y … y + height - 1.
struct CellRectangle {
  int x = 0, y = 0, width = 0, height = 0;

  bool empty() const { return width <= 0 || height <= 0; }
  int right() const { return x + width; }
  int top() const { return y + height; }
  bool contains(int cell_x, int cell_y) const {
    return cell_x >= x && cell_x < right() && cell_y >= y && cell_y < top();
  }
  /// The part of the rectangle inside `other`.
  CellRectangle clipped(const CellRectangle& other) const {
    const int west = std::max(x, other.x), south = std::max(y, other.y);
    return {west, south, std::min(right(), other.right()) - west, std::min(top(), other.top()) - south};
  }
  /// The rectangle with `margin` more cells on each side.
  CellRectangle grown(int margin) const {
    return {x - margin, y - margin, width + 2 * margin, height + 2 * margin};
  }
  /// Enlarges the rectangle so that it contains `other`.
  void include(const CellRectangle& other) {
    if (other.empty()) return;
    if (empty()) {
      *this = other;
      return;
    }
    const int east = std::max(right(), other.right()), north = std::max(top(), other.top());
    x = std::min(x, other.x);
    y = std::min(y, other.y);
    width = east - x;
    height = north - y;
  }
  bool operator==(const CellRectangle& o) const {
    return x == o.x && y == o.y && width == o.width && height == o.height;
  }
};

/// The values of one layer in a rectangle of cells.
class CellWindow {
 public:
  CellWindow() = default;
  /// `values` has one value for each cell of the rectangle.
  CellWindow(const CellRectangle& cells, std::vector<float> values)
      : cells_(cells), values_(std::move(values)) {}

  bool empty() const { return values_.empty(); }
  const CellRectangle& cells() const { return cells_; }
  const std::vector<float>& values() const { return values_; }
  /// The value of a cell; NaN outside the rectangle.
  float at(int x, int y) const {
    if (!cells_.contains(x, y)) return std::numeric_limits<float>::quiet_NaN();
    return values_[static_cast<std::size_t>(y - cells_.y) * static_cast<std::size_t>(cells_.width) +
                   static_cast<std::size_t>(x - cells_.x)];
  }

 private:
  CellRectangle cells_;
  std::vector<float> values_;
};

}  // namespace desert_sim::render

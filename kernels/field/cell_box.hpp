#pragma once
/// A rectangle of cells.

#include "kernels/base/macros.hpp"

namespace desert_sim {

/// Cells x0 … x1 − 1 and y0 … y1 − 1.
struct CellBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  DESERT_HD bool empty() const { return x0 >= x1 || y0 >= y1; }
  DESERT_HD bool contains_cell(int x, int y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
  bool contains(const CellBox& other) const {
    return other.x0 >= x0 && other.x1 <= x1 && other.y0 >= y0 && other.y1 <= y1;
  }
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// The smallest box that contains both.
  DESERT_HD CellBox united_with(const CellBox& other) const {
    if (empty()) return other;
    if (other.empty()) return *this;
    return {x0 < other.x0 ? x0 : other.x0, y0 < other.y0 ? y0 : other.y0, x1 > other.x1 ? x1 : other.x1,
            y1 > other.y1 ? y1 : other.y1};
  }
};

}  // namespace desert_sim

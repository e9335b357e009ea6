#pragma once
/// The rectangle of cells that changed.

#include <algorithm>

namespace desert_sim {

/// Cells x0 … x1 − 1 and y0 … y1 − 1.
struct CellBox {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// The smallest box that has both.
  CellBox with(const CellBox& other) const {
    if (empty()) return other;
    if (other.empty()) return *this;
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
  }
};

}  // namespace desert_sim

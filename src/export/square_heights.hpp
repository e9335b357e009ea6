#pragma once
/// Terrains in squares of 2^n + 1 points, as game engines and Gazebo take heights.

#include <vector>

#include "src/simulation/views/snapshot.hpp"

namespace desert_sim {

/// The points are a cell apart, and those of the terrain are the centres of its cells, so that heights there
/// are the terrain's own. The terrain lies in the middle; around it, a periodic one goes on, and an open one
/// keeps the values of its edge.
class Square {
 public:
  explicit Square(const Snapshot& snapshot);

  /// Points on a side: 2^n + 1.
  int side() const { return side_; }
  /// The length of a side [m].
  double length() const { return (side_ - 1) * cell_size_; }
  /// The middle of the square in the terrain's frame [m].
  double middle_x() const { return middle_x_; }
  double middle_y() const { return middle_y_; }

  /// The values of the cells at the points, row 0 = south.
  template <class Value>
  std::vector<Value> of(const std::vector<Value>& cells) const {
    std::vector<Value> points;
    points.reserve(columns_.size() * rows_.size());
    for (const std::size_t row : rows_)
      for (const std::size_t column : columns_) points.push_back(cells[row * width_ + column]);
    return points;
  }

 private:
  int side_;
  std::size_t width_;
  double cell_size_, middle_x_, middle_y_;
  std::vector<std::size_t> columns_, rows_;  ///< of the cells at the points
};

}  // namespace desert_sim

#pragma once
/// What subscribers to ~costmap and ~costmap_updates hold.

#include <cstdint>
#include <vector>

#include "desert_sim/ros/cell_box.hpp"

namespace desert_sim {

constexpr std::int8_t unknown_cost = -1, lethal_cost = 100;

/// Cost of a traversability: lethal at 0, else 0 … 99, falling; unknown for NaN.
std::int8_t cost_of(float traversability);

class HeldCosts {
 public:
  /// Costs may be off by `threshold`; lethal and unknown cells are always right.
  void configure(int threshold) { threshold_ = threshold; }
  /// A whole map, row-major.
  void hold(int width, std::vector<std::int8_t> costs);
  bool empty() const { return held_.empty(); }
  std::size_t size() const { return held_.size(); }
  int width() const { return width_; }
  /// The smallest box with all cells that have to be sent. `now` has as many as are held.
  CellBox changes(const std::vector<std::int8_t>& now) const;
  /// The costs of a box, row by row, which then are held.
  std::vector<std::int8_t> take(const std::vector<std::int8_t>& now, const CellBox& cells);

 private:
  bool differs(std::int8_t now, std::int8_t held) const;

  int threshold_ = 0, width_ = 0;
  std::vector<std::int8_t> held_;
};

}  // namespace desert_sim

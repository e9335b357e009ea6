#pragma once
/// How long cells stay passable, and since when, by the maps of costs at some moments. A cell is passable
/// where a rover has a way, at a cost of 0 … 99 (kernels/view/cell_cost.hpp); lethal and unknown ones are
/// not. Between two moments at which a cell differs it counts as not passable.

#include <cstdint>
#include <vector>

#include "kernels/view/cell_cost.hpp"

namespace desert_sim {

inline bool is_passable(std::int8_t cost) { return cost >= 0 && cost < cell_cost::lethal; }

class Passability {
 public:
  /// `costs` at time 0, row-major.
  explicit Passability(const std::vector<std::int8_t>& costs);
  /// The costs at a later moment [s]; as many as at time 0.
  void add(double time, const std::vector<std::int8_t>& costs);

  /// The last moment up to which a cell is passable from time 0 on: 0 if it is not at time 0, or not any more
  /// at the first moment; infinite if it is at all moments [s].
  const std::vector<float>& until() const { return until_; }
  /// The first moment from which on a cell is passable up to the last: 0 if it always is, infinite if it is
  /// not at the last moment [s].
  const std::vector<float>& from() const { return from_; }

 private:
  float last_time_ = 0;
  std::vector<float> until_, from_;
};

}  // namespace desert_sim

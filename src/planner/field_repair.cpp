/// The repair of a field: D* Lite.
#include <algorithm>
#include <cstdlib>

#include "src/planner/field_planner.hpp"

namespace desert_sim {

FieldPlanner::Value FieldPlanner::least_way(CellIndex cell) const {
  if (!rover_) return 0;
  const auto row = static_cast<CellIndex>(grid_.stride());
  const int dx = std::abs(static_cast<int>(cell % row) - static_cast<int>(*rover_ % row)),
            dy = std::abs(static_cast<int>(cell / row) - static_cast<int>(*rover_ / row));
  const auto longer = static_cast<Value>(std::max(dx, dy)), shorter = static_cast<Value>(std::min(dx, dy));
  return CostGrid::cheapest * (straight * longer + (diagonal - straight) * shorter);
}

void FieldPlanner::list(CellIndex cell) {
  if (listed_[cell]) return;
  listed_[cell] = 1;
  pending_.push_back(cell);
}

void FieldPlanner::note(const std::vector<CellIndex>& changed) {
  if (!goal_) return;
  for (const CellIndex cell : changed) {
    r_[cell] = equation(cell);
    if (r_[cell] != g_[cell]) list(cell);
  }
}

void FieldPlanner::set_equation(CellIndex cell, Value value) {
  r_[cell] = value;
  if (value != g_[cell]) queue_.push(place(cell), cell);
}

/// The value of the cell is too small: what it was is forgotten, and with it what it gave to neighbours.
void FieldPlanner::raise(CellIndex cell) {
  const Value before = g_[cell];
  g_[cell] = unreachable;
  for (int d = 0; d < neighbours; ++d) {
    const CellIndex to = cell + static_cast<CellIndex>(offset_[static_cast<std::size_t>(d)]);
    if (r_[to] < unreachable && r_[to] == before + step_cost(to, d)) set_equation(to, equation(to));
  }
  if (r_[cell] < unreachable) queue_.push(place(cell), cell);
}

/// The value of the cell is too large: it falls, and the neighbours may profit.
void FieldPlanner::lower(CellIndex cell) {
  const Value value = g_[cell] = r_[cell];
  for (int d = 0; d < neighbours; ++d) {
    const CellIndex to = cell + static_cast<CellIndex>(offset_[static_cast<std::size_t>(d)]);
    const Value through = value + step_cost(to, d);
    if (through < r_[to]) set_equation(to, through);
  }
}

void FieldPlanner::repair(std::optional<CellIndex> rover) {
  rover_ = rover;
  ++statistics_.repairs;
  const std::size_t most = grid_.size() / 3;
  if (pending_.size() > most) return compute(*goal_);
  for (const CellIndex cell : pending_) {
    listed_[cell] = 0;
    if (g_[cell] != r_[cell]) queue_.push(place(cell), cell);
  }
  pending_.clear();
  std::size_t expanded = 0;
  for (BucketQueue::Key now = queue_.least(); now != BucketQueue::no_key; now = queue_.least()) {
    if (rover_ && g_[*rover_] == r_[*rover_] && now / 2 > g_[*rover_]) break;
    const CellIndex cell = queue_.pop();
    if (g_[cell] == r_[cell] || place(cell) > now) continue;  // done, or listed again further on
    if (++expanded > most) break;
    if (g_[cell] > r_[cell])
      lower(cell);
    else
      raise(cell);
  }
  statistics_.expanded += expanded;
  queue_.drain([this](CellIndex cell) {
    if (g_[cell] != r_[cell]) list(cell);
  });
  if (expanded <= most) return;
  ++statistics_.abandoned;
  compute(*goal_);
}

}  // namespace desert_sim

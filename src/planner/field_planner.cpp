#include "src/planner/field_planner.hpp"

#include <algorithm>
#include <cstdlib>

namespace desert_sim {

namespace {

constexpr FieldPlanner::Value largest_step = FieldPlanner::diagonal * 255;
constexpr BucketQueue::Key span_of_repairs = 8192;

}  // namespace

FieldPlanner::FieldPlanner(const CostGrid& grid)
    : grid_(grid),
      straight_cost_(256, unreachable),
      diagonal_cost_(256, unreachable),
      g_(grid.size(), unreachable),
      r_(grid.size(), unreachable),
      listed_(grid.size(), 0),
      ring_(largest_step + 1),
      queue_(span_of_repairs) {
  const int row = grid.stride();
  offset_ = {1, -1, row, -row, row + 1, row - 1, -row + 1, -row - 1};
  for (Value c = 1; c < 256; ++c) {
    straight_cost_[c] = straight * c;
    diagonal_cost_[c] = diagonal * c;
  }
}

void FieldPlanner::compute(CellIndex goal) {
  std::fill(g_.begin(), g_.end(), unreachable);
  goal_ = goal;
  ring_.clear();
  if (grid_.cost(goal) != CostGrid::lethal) {
    g_[goal] = 0;
    ring_.push(0, goal);
  }
  const std::uint8_t* const costs = grid_.costs().data();
  Value* const values = g_.data();
  for (Value now = ring_.least(); now != BucketQueue::no_key; now = ring_.least()) {
    const CellIndex from = ring_.pop();
    if (values[from] != now) continue;  // a cheaper way was found since
    const auto reach = [&](int direction, const std::vector<Value>& step) {
      const CellIndex to = from + static_cast<CellIndex>(offset_[static_cast<std::size_t>(direction)]);
      const Value value = now + step[costs[to]];
      if (value >= values[to]) return;
      values[to] = value;
      ring_.push(value, to);
    };
    for (int d = 0; d < 4; ++d) reach(d, straight_cost_);
    for (int d = 4; d < neighbours; ++d) reach(d, diagonal_cost_);
  }
  r_ = g_;
  for (const CellIndex cell : pending_) listed_[cell] = 0;
  pending_.clear();
  ++statistics_.computed;
}

FieldPlanner::Value FieldPlanner::equation(CellIndex cell) const {
  const std::uint8_t cost = grid_.cost(cell);
  if (cost == CostGrid::lethal) return unreachable;
  if (cell == goal_) return 0;
  const auto least_of = [&](int first) {
    Value least = unreachable;
    for (int d = first; d < first + 4; ++d)
      least = std::min(least, g_[cell + static_cast<CellIndex>(offset_[static_cast<std::size_t>(d)])]);
    return least;
  };
  return std::min({unreachable, least_of(0) + straight_cost_[cost], least_of(4) + diagonal_cost_[cost]});
}

std::vector<CellIndex> FieldPlanner::path_from(CellIndex start) const {
  std::vector<CellIndex> path;
  if (!goal_ || g_[start] >= unreachable) return path;
  for (CellIndex cell = start;;) {
    path.push_back(cell);
    if (cell == *goal_) return path;
    CellIndex best = cell;
    Value least = unreachable;
    for (int d = 0; d < neighbours; ++d) {
      const CellIndex to = cell + static_cast<CellIndex>(offset_[static_cast<std::size_t>(d)]);
      const Value value = g_[to] + step_cost(cell, d);
      if (value < least) least = value, best = to;
    }
    if (best == cell || g_[best] >= g_[cell]) return {};  // the field is not in order here
    cell = best;
  }
}

std::size_t FieldPlanner::differences(FieldPlanner& reference) const {
  if (!goal_) return 0;
  reference.compute(*goal_);
  const Value bound = rover_ ? g_[*rover_] : unreachable;
  std::size_t count = 0;
  for (CellIndex cell = 0; cell < g_.size(); ++cell) {
    const bool must_agree = rover_ ? g_[cell] == r_[cell] && key(cell) <= bound : true;
    count += must_agree && g_[cell] != reference.g_[cell];
  }
  if (rover_) count += g_[*rover_] != reference.g_[*rover_];
  return count;
}

}  // namespace desert_sim

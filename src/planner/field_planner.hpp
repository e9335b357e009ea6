#pragma once
/// The cost to a goal from every cell, and its repair where costs have changed (D* Lite, Koenig and Likhachev
/// 2002, on integers). A step leaves a cell v of cost c(v):
///
///   w(v → u) = 5 c(v) straight, 7 c(v) diagonally
///   g(v)     = min over the neighbours u of w(v → u) + g(u),   g(goal) = 0
///
/// What a cell costs counts when it is left, so that a changed cost changes the equation of that cell alone.
/// A cell is *consistent* where its value g fulfils the equation with those of its neighbours; `r` is what
/// the equation gives. compute() is Dijkstra's algorithm with a ring of buckets. repair() brings inconsistent
/// cells in order, by the key
///
///   k(v) = min(g(v), r(v)) + h(v)
///
/// h ≥ 0 is what it costs at least from the rover to v, so that only what may matter to the rover's path is
/// brought in order; the others stay listed until they matter. Without a rover h = 0, and all are brought in
/// order. Values are integers and have no other solution: after a repair all cells (without a rover), or
/// those with k(v) ≤ g(rover), have those of compute() to the bit.

#include <cstdint>
#include <optional>
#include <vector>

#include "src/planner/bucket_queue.hpp"
#include "src/planner/cost_grid.hpp"

namespace desert_sim {

class FieldPlanner {
 public:
  using Value = std::uint32_t;
  static constexpr Value unreachable = 0x3fffffff;
  static constexpr Value straight = 5, diagonal = 7;
  /// What a metre on the cheapest ground costs.
  static double cost_of_metre(const CostGrid& grid) {
    return straight * CostGrid::cheapest / grid.frame().cell_size;
  }

  struct Statistics {
    std::uint64_t computed = 0;  ///< whole fields
    std::uint64_t repairs = 0;
    std::uint64_t expanded = 0;  ///< cells that repairs have given another value, counted each time
    std::uint64_t abandoned =
        0;  ///< repairs that became as long as computing the whole field, which was done
  };

  /// The grid has to outlive the planner, and keeps its size.
  explicit FieldPlanner(const CostGrid& grid);

  /// The whole field of a goal.
  void compute(CellIndex goal);
  std::optional<CellIndex> goal() const { return goal_; }
  /// Notes that the costs of these cells have changed.
  void note(const std::vector<CellIndex>& changed);
  /// Brings the field in order after changes, as far as paths from `rover` need it, or all of it. There must
  /// be a goal.
  void repair(std::optional<CellIndex> rover);

  /// Exact for the rover of the last repair and for its path to the goal.
  Value value(CellIndex cell) const { return g_[cell]; }
  const std::vector<Value>& values() const { return g_; }
  /// Cells that are not in order, because they did not matter.
  std::size_t pending() const { return pending_.size(); }
  const Statistics& statistics() const { return statistics_; }

  /// Computes the whole field in `reference`, and counts the cells that differ from it of those that must
  /// not.
  std::size_t differences(FieldPlanner& reference) const;

  /// From a cell to the goal by the steps that cost least; empty where there is no path. Steps that cost the
  /// same are taken in a fixed order.
  std::vector<CellIndex> path_from(CellIndex start) const;

 private:
  static constexpr int neighbours = 8;  ///< four straight ones, then four diagonal ones

  Value step_cost(CellIndex cell, int direction) const {
    return (direction < 4 ? straight_cost_ : diagonal_cost_)[grid_.cost(cell)];
  }
  Value equation(CellIndex cell) const;
  Value key(CellIndex cell) const { return std::min(g_[cell], r_[cell]) + least_way(cell); }
  Value least_way(CellIndex cell) const;
  /// Twice the key, and one more if the cell's value has to fall: those whose value has to rise come first.
  BucketQueue::Key place(CellIndex cell) const { return 2 * key(cell) + (g_[cell] > r_[cell] ? 1 : 0); }
  void list(CellIndex cell);
  void raise(CellIndex cell);
  void lower(CellIndex cell);
  void set_equation(CellIndex cell, Value value);

  const CostGrid& grid_;
  std::vector<int> offset_;                           ///< of the neighbours
  std::vector<Value> straight_cost_, diagonal_cost_;  ///< of a step, by the cost of the cell
  std::vector<Value> g_, r_;
  std::optional<CellIndex> goal_, rover_;
  std::vector<CellIndex> pending_;
  std::vector<std::uint8_t> listed_;  ///< whether a cell is in pending_
  BucketQueue ring_, queue_;
  Statistics statistics_;
};

}  // namespace desert_sim

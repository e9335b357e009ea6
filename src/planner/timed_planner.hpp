#pragma once
/// The earliest arrival at a goal over ground that changes as a forecast says: safe interval path planning
/// (Phillips and Likhachev 2011) with durations that depend on time.
///
/// The ground is known at moments. Between two of them a cell has the larger cost of both, and is lethal if
/// it is in either; after the last one nothing changes any more. What is known of the ground now is the first
/// moment. A step from a cell takes
///
///   (1 or √2) cell size / speed · (1 + slowing · (c − 4)/(worst c − 4)),   c the cost of the cell
///
/// and the rest of it goes on at the new cost where the cost changes on the way. So who departs later never
/// arrives earlier, and the earliest arrival in each safe interval of a cell (in which it is passable without
/// a break) is all that has to be known. A rover may wait anywhere for as long as the ground under it is
/// passable.

#include <memory>
#include <optional>
#include <vector>

#include "src/planner/grid_path.hpp"

namespace desert_sim {

struct TimedParameters {
  double speed = 0.2;  ///< that the rover makes on the best ground [m/s], > 0
  double slowing = 2;  ///< by which share a step takes longer on the worst passable ground, ≥ 0
};

/// Ground at moments; all of the same frame.
struct TimedCosts {
  std::vector<double> times;  ///< [s], rising; the first is now
  std::vector<std::shared_ptr<const CostGrid>> grids;
};

struct TimedPoint {
  GridPoint point;
  double arrival = 0, departure = 0;  ///< [s], as the times of the costs
};

class TimedPlanner {
 public:
  /// Throws ConfigError for parameters out of range, and for costs whose frames or times do not fit together.
  TimedPlanner(TimedCosts costs, const TimedParameters& parameters);

  /// From a cell, at the first moment, to another; empty where there is no way even with waiting. Ground
  /// about the start that is passable now and lethal at the next moment counts as the worst passable one till
  /// then, so that a rover can flee.
  /// `within`, if it is not empty, holds for each cell of the grid whether the path may cross it.
  std::vector<TimedPoint> plan(CellIndex start, CellIndex goal, const std::vector<bool>& within = {});
  /// Where the last plan() found no way: that to a shelter, the cell nearest to the goal of those that can be
  /// reached and are passable from then on. Its last departure is never (infinity). Empty if there is none.
  const std::vector<TimedPoint>& shelter() const { return shelter_; }
  /// Cells and intervals that the last plan() has looked at.
  std::size_t expanded() const { return expanded_; }

 private:
  struct Label;
  struct Search;
  std::uint8_t cost(CellIndex cell, std::size_t slot) const { return slots_[slot][cell]; }
  double end_of(std::size_t slot) const;
  std::size_t slot_at(double time) const;
  /// The first and the last slot of the safe interval in which a cell is at a slot.
  std::size_t first_of(CellIndex cell, std::size_t slot) const;
  std::size_t last_of(CellIndex cell, std::size_t slot) const;
  /// When a step that departs at `time` arrives; none if ground becomes lethal meanwhile.
  std::optional<double> arrival(CellIndex from, CellIndex to, double time, double length) const;
  void expand(Search& search, const Label& label) const;
  /// The way to an interval that has been reached, which the rover leaves at `departure`.
  std::vector<TimedPoint> path_to(const Search& search, std::size_t interval, double departure) const;
  void let_flee(CellIndex start);

  TimedCosts costs_;
  TimedParameters parameters_;
  const CostGrid& frame_;
  std::vector<std::vector<std::uint8_t>> slots_;  ///< costs from each moment to the next
  double worst_ = CostGrid::cheapest;
  std::vector<TimedPoint> shelter_;
  std::size_t expanded_ = 0;
};

}  // namespace desert_sim

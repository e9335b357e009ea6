#include "src/planner/ompl_planner.hpp"

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/PlannerTerminationCondition.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/SimpleSetup.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include "src/core/elementary.hpp"

namespace desert_sim {

namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

GridPoint point_of(const ob::State* state) {
  const auto* p = state->as<ob::RealVectorStateSpace::StateType>();
  return {p->values[0], p->values[1]};
}

/// Costs of motions by HeadingCosts; counts how many were computed.
class MotionCosts : public ob::OptimizationObjective {
 public:
  MotionCosts(const ob::SpaceInformationPtr& space, const HeadingCosts& costs)
      : OptimizationObjective(space), costs_(costs) {
    description_ = "slope, slip, sinkage, water and wind along the way";
  }
  ob::Cost stateCost(const ob::State*) const override { return identityCost(); }
  ob::Cost motionCost(const ob::State* from, const ob::State* to) const override {
    ++count_;
    return ob::Cost(
        costs_.line(point_of(from), point_of(to)).value_or(std::numeric_limits<double>::infinity()));
  }
  /// A metre costs 1 at least.
  ob::Cost motionCostHeuristic(const ob::State* from, const ob::State* to) const override {
    return ob::Cost(si_->distance(from, to));
  }
  bool isSymmetric() const override { return false; }
  int count() const { return count_; }

 private:
  const HeadingCosts& costs_;
  mutable int count_ = 0;
};

class PassableMotions : public ob::MotionValidator {
 public:
  PassableMotions(const ob::SpaceInformationPtr& space, const CostGrid& grid)
      : MotionValidator(space), grid_(grid) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return line_cost(grid_, point_of(from), point_of(to)).has_value();
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& last) const override {
    if (checkMotion(from, to)) return true;
    last.second = 0;
    if (last.first) si_->copyState(last.first, from);
    return false;
  }

 private:
  const CostGrid& grid_;
};

/// Leaves points out between which the straight line costs less, until none is left.
GridPath straightened(const HeadingCosts& costs, GridPath path) {
  for (std::size_t n = 1; n + 1 < path.size();) {
    const auto direct = costs.line(path[n - 1], path[n + 1]);
    const auto around = costs.path({path[n - 1], path[n], path[n + 1]});
    if (direct && around && *direct <= *around) {
      path.erase(path.begin() + static_cast<std::ptrdiff_t>(n));
      if (n > 1) --n;
    } else {
      ++n;
    }
  }
  return path;
}

/// Where a path can lie that costs less than `most`: the box of the ellipse about start and goal whose points
/// are as far from both together, since a metre costs 1 at least; on the terrain.
ob::RealVectorBounds bounds_of(const GridFrame& f, const GridPoint& start, const GridPoint& goal,
                               double most) {
  const double dx = goal.x - start.x, dy = goal.y - start.y, apart = elementary::hypot(dx, dy);
  const double a = most / 2, b = std::sqrt(std::max(a * a - apart * apart / 4, 0.0));
  const double c = apart > 0 ? dx / apart : 1, s = apart > 0 ? dy / apart : 0;
  const double half_x = elementary::hypot(a * c, b * s) + f.cell_size,
               half_y = elementary::hypot(a * s, b * c) + f.cell_size;
  const double x = (start.x + goal.x) / 2, y = (start.y + goal.y) / 2;
  ob::RealVectorBounds bounds(2);
  bounds.setLow(0, std::max(f.origin_x, x - half_x));
  bounds.setLow(1, std::max(f.origin_y, y - half_y));
  bounds.setHigh(0, std::min(f.origin_x + f.width * f.cell_size, x + half_x));
  bounds.setHigh(1, std::min(f.origin_y + f.height * f.cell_size, y + half_y));
  return bounds;
}

og::SimpleSetup setup_of(const HeadingCosts& costs, const ob::RealVectorBounds& bounds) {
  auto plane = std::make_shared<ob::RealVectorStateSpace>(2);
  plane->setBounds(bounds);
  og::SimpleSetup setup(plane);
  setup.setStateValidityChecker([&costs](const ob::State* state) {
    const auto cell = costs.grid().cell_at(point_of(state));
    return cell && costs.grid().cost(*cell) != CostGrid::lethal;
  });
  setup.getSpaceInformation()->setMotionValidator(
      std::make_shared<PassableMotions>(setup.getSpaceInformation(), costs.grid()));
  return setup;
}

void prepare_ompl(std::uint32_t seed) {
  static std::once_flag once;
  std::call_once(once, [seed] {
    ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
    ompl::RNG::setSeed(seed);
  });
}

}  // namespace

OmplResult plan_with_ompl(const HeadingCosts& costs, const GridPoint& start, const GridPoint& goal,
                          const GridPath& known, const OmplParameters& parameters) {
  prepare_ompl(parameters.seed);
  const double endless = 1e9;
  const double most = known.empty() ? endless : costs.path(known).value_or(endless);
  og::SimpleSetup setup = setup_of(costs, bounds_of(costs.grid().frame(), start, goal, most));
  const auto objective = std::make_shared<MotionCosts>(setup.getSpaceInformation(), costs);
  setup.setOptimizationObjective(objective);
  setup.setPlanner(std::make_shared<og::RRTstar>(setup.getSpaceInformation()));
  ob::ScopedState<ob::RealVectorStateSpace> from(setup.getStateSpace()), to(setup.getStateSpace());
  from[0] = start.x;
  from[1] = start.y;
  to[0] = goal.x;
  to[1] = goal.y;
  setup.setStartAndGoalStates(from, to);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(parameters.time_limit);
  const ob::PlannerTerminationCondition enough([&] {
    return objective->count() >= parameters.evaluations || std::chrono::steady_clock::now() >= end;
  });
  setup.solve(enough);

  OmplResult best;
  const auto take = [&](const GridPath& path) {
    const GridPath straight = straightened(costs, path);
    const auto cost = costs.path(straight);
    if (cost && (best.path.empty() || *cost < best.cost)) best = {straight, *cost, ""};
  };
  if (!known.empty()) take(known);
  if (setup.haveExactSolutionPath()) {
    GridPath path;
    for (const ob::State* state : setup.getSolutionPath().getStates()) path.push_back(point_of(state));
    take(path);
  }
  if (best.path.empty())
    best.problem = "OMPL has found no path with " + std::to_string(objective->count()) + " lines looked at";
  return best;
}

}  // namespace desert_sim

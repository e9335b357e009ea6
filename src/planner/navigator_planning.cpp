/// Where a navigator's paths come from, and when another is needed.
#include <algorithm>
#include <cmath>

#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/planner/navigator.hpp"

namespace desert_sim {

std::string Navigator::places(Place& start, Place& goal, bool later) const {
  const auto near = [&](double x, double y, double distance) {
    return grid_->nearest_passable({x, y}, std::max(distance, grid_->frame().cell_size / 2));
  };
  const auto why = [&](double x, double y) {
    const auto cell = grid_->cell_at({x, y});
    if (!cell) return std::string("it is off the terrain");
    return std::string(grid_->itself_lethal(*cell)
                           ? "the ground there is too steep, loose, wet or blocked"
                           : "it is too near to ground that is not passable, or to the edge");
  };
  const auto s = near(pose_.x, pose_.y, parameters_.escape);
  if (!s)
    return "the start " + point_text(pose_.x, pose_.y) + " is not passable, nor is any cell within " +
           number_text(parameters_.escape) + " m: " + why(pose_.x, pose_.y);
  auto g = near(goal_->x, goal_->y, parameters_.goal_tolerance);
  if (!g && later) g = grid_->cell_at({goal_->x, goal_->y});
  if (!g)
    return "the goal " + point_text(goal_->x, goal_->y) + " is not passable: " + why(goal_->x, goal_->y);
  start = {grid_->centre(*s), *s};
  goal = {grid_->centre(*g), *g};
  return "";
}

std::string Navigator::need_of_path() {
  const bool changed = ground_changed_;
  ground_changed_ = false;
  if (pursuit_.path().empty()) {
    if (no_path_since_ && last_attempt_ && now_ - *last_attempt_ < parameters_.replan_pause) return "";
    return status_.plans == 0 ? "a new goal" : "there was no path";
  }
  if (pursuit_.off_path() > parameters_.off_path)
    return "the rover is " + number_text(pursuit_.off_path()) + " m off the path";
  if (parameters_.planner == PlannerKind::forecast && new_forecast_) return renew_schedule();
  if (to_shelter_ && !believes_forecast()) return "the forecast that told of no way is too old";
  if (!changed) return "";
  const auto cost = path_cost(*grid_, pursuit_.remaining(), free_start());
  if (!cost) {
    // What is blocked now may be free when the rover comes there.
    if (schedule_.empty()) return "the path is blocked";
    GridPath near;  // no further than to where it waits
    for (const TimedPoint& p : schedule()) {
      near.push_back(p.point);
      if (path_length(near) > 5 || p.departure > std::max(now_, p.arrival + 1)) break;
    }
    return path_cost(*grid_, near, free_start()) ? "" : "the path is blocked";
  }
  status_.cost = *cost;
  if (!schedule_.empty()) return "";
  // What this way cost when it was planned: between two points as much as at the one before.
  const GridPath& path = pursuit_.path();
  double way = 0, planned = cost_left_.front();
  for (std::size_t n = 1; n < path.size(); ++n) {
    const double length = elementary::hypot(path[n].x - path[n - 1].x, path[n].y - path[n - 1].y);
    if (way + length >= pursuit_.done()) {
      const double share = length > 0 ? (pursuit_.done() - way) / length : 0;
      planned = cost_left_[n - 1] + (cost_left_[n] - cost_left_[n - 1]) * share;
      break;
    }
    way += length;
  }
  const double margin =
      1;  // [m of the best ground], so that the last metres are not planned anew for nothing
  if (*cost > planned * (1 + parameters_.replan_rise) + margin)
    return "the cost of the path has risen from " + number_text(planned) + " to " + number_text(*cost) + " m";
  if (parameters_.planner != PlannerKind::field) return "";
  Place start, goal;
  if (!places(start, goal).empty()) return "";
  prepare_field(start, goal);
  const double best = field_->value(start.cell) / FieldPlanner::cost_of_metre(*grid_);
  if (best < *cost * (1 - parameters_.replan_gain) - margin)
    return "another path costs " + number_text(best) + " m instead of " + number_text(*cost) + " m";
  return "";
}

void Navigator::prepare_field(const Place& start, const Place& goal) {
  if (!field_) {
    field_ = std::make_unique<FieldPlanner>(*grid_);
    changed_.clear();
  }
  if (field_->goal() != goal.cell) {
    field_->compute(goal.cell);
  } else {
    field_->note(changed_);
    field_->repair(start.cell);
    const auto every = static_cast<std::uint64_t>(parameters_.check_every);
    if (every > 0 && field_->statistics().repairs % every == 0) {
      if (!reference_) reference_ = std::make_unique<FieldPlanner>(*grid_);
      const std::size_t wrong = field_->differences(*reference_);
      status_.field_differences += wrong;
      if (wrong > 0) field_->compute(goal.cell);
    }
  }
  changed_.clear();
}

std::string Navigator::plan() {
  last_attempt_ = now_;
  new_forecast_ = false;
  schedule_.clear();
  to_shelter_ = false;
  Place start, goal;
  std::string problem =
      places(start, goal, parameters_.planner == PlannerKind::forecast && believes_forecast());
  if (!problem.empty()) return problem;
  GridPath path;
  switch (parameters_.planner) {
    case PlannerKind::field:
      problem = plan_by_field(start, goal, path);
      break;
    case PlannerKind::ompl:
      problem = plan_by_ompl(start, goal, path);
      break;
    case PlannerKind::forecast:
      problem = plan_by_forecast(start, goal, path);
      break;
  }
  if (!problem.empty()) return problem;
  take(std::move(path), goal);
  return "";
}

std::string Navigator::plan_by_field(const Place& start, const Place& goal, GridPath& path) {
  prepare_field(start, goal);
  path = shortened(*grid_, field_->path_from(start.cell));
  return path.empty() ? "no way leads from the start to the goal over ground that is passable now" : "";
}

std::string Navigator::plan_by_ompl(const Place& start, const Place& goal, GridPath& path) {
  GridPath known;
  const std::string problem = plan_by_field(start, goal, known);
  if (!problem.empty()) return problem;
  const HeadingCosts costs(std::make_shared<const CostGrid>(*grid_),
                           layer_source_ ? layer_source_(grid_->frame()) : HeadingLayers(),
                           parameters_.heading_weights());
  OmplResult result = plan_with_ompl(costs, start.point, goal.point, known, parameters_.ompl());
  path = std::move(result.path);
  return result.problem;
}

bool Navigator::believes_forecast() const {
  return !forecast_.empty() && now_ - forecast_.front().made <= parameters_.forecast_age;
}

TimedCosts Navigator::timed_costs() {
  TimedCosts costs{{now_}, {std::make_shared<const CostGrid>(*grid_)}};
  status_.forecast_age = -1;
  for (const ForecastMoment& moment : forecast_) {
    const double age = now_ - moment.made;
    if (age > parameters_.forecast_age) continue;
    if (status_.forecast_age < 0) status_.forecast_age = age;  // the newest comes first
    if (moment.time <= now_) continue;
    costs.times.push_back(moment.time);
    costs.grids.push_back(moment.grid);
  }
  return costs;
}

std::string Navigator::plan_by_forecast(const Place& start, const Place& goal, GridPath& path) {
  TimedPlanner planner(timed_costs(), {parameters_.forecast_speed, parameters_.forecast_slowing});
  schedule_ = planner.plan(start.cell, goal.cell);
  to_shelter_ = schedule_.empty() && believes_forecast() && !planner.shelter().empty();
  if (to_shelter_) schedule_ = planner.shelter();
  for (const TimedPoint& p : schedule_) path.push_back(p.point);
  if (!path.empty()) return "";
  // Who waits for a forecast that knows a way may be buried where it stands.
  Place start_now, goal_now;
  std::string problem = places(start_now, goal_now);
  if (problem.empty()) problem = plan_by_field(start_now, goal_now, path);
  return problem.empty() ? "" : problem + ", and none with waiting as the forecast tells";
}

std::vector<bool> Navigator::cells_of_path() const {
  std::vector<bool> cells(grid_->size(), false);
  for (const GridPoint& p : pursuit_.remaining())
    if (const auto cell = grid_->cell_at(p)) cells[*cell] = true;
  const int reach = static_cast<int>(std::ceil(parameters_.escape / grid_->frame().cell_size));
  const GridFrame& f = grid_->frame();
  if (const auto rover = grid_->cell_at({pose_.x, pose_.y})) {
    const int cx = grid_->x_of(*rover), cy = grid_->y_of(*rover);
    for (int y = std::max(cy - reach, 0); y <= std::min(cy + reach, f.height - 1); ++y)
      for (int x = std::max(cx - reach, 0); x <= std::min(cx + reach, f.width - 1); ++x)
        cells[grid_->cell(x, y)] = true;
  }
  return cells;
}

std::string Navigator::renew_schedule() {
  new_forecast_ = false;
  Place start, goal;
  if (!places(start, goal, believes_forecast()).empty())
    return "the start or the goal is not passable any more";
  TimedPlanner planner(timed_costs(), {parameters_.forecast_speed, parameters_.forecast_slowing});
  std::vector<TimedPoint> kept = planner.plan(start.cell, goal.cell, cells_of_path());
  if (to_shelter_ && kept.empty()) kept = planner.shelter();
  const std::vector<TimedPoint> best = planner.plan(start.cell, goal.cell);
  if (to_shelter_ && !best.empty()) return "a way leads to the goal again as the forecast tells";
  if (kept.empty()) return "the path is blocked by what the forecast tells";
  if (!to_shelter_) {
    const double gained = kept.back().arrival - best.back().arrival;
    if (gained > parameters_.replan_gain * (kept.back().arrival - now_) + 5)
      return "another path arrives " + number_text(gained) + " s earlier, as the forecast tells";
  }
  schedule_ = kept;
  GridPath path;
  for (const TimedPoint& p : kept) path.push_back(p.point);
  take(std::move(path), goal);
  return "";
}

void Navigator::take(GridPath path, const Place& goal) {
  if (!to_shelter_ && grid_->cell_at({goal_->x, goal_->y}) == goal.cell) path.back() = {goal_->x, goal_->y};
  cost_left_.assign(path.size(), 0);
  for (std::size_t n = path.size() - 1; n > 0; --n)
    cost_left_[n - 1] = cost_left_[n] + line_cost(*grid_, path[n - 1], path[n], free_start()).value_or(0);
  status_.cost = cost_left_.front();
  pursuit_.follow(std::move(path));
  pursuit_.locate(pose_);
  ++path_number_;
}

}  // namespace desert_sim

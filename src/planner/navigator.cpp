#include "src/planner/navigator.hpp"

#include <algorithm>
#include <cmath>

#include "src/core/constants.hpp"
#include "src/core/elementary.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"

namespace desert_sim {

namespace {

double distance(const PlanarPose& a, const PlanarPose& b) { return elementary::hypot(a.x - b.x, a.y - b.y); }

}  // namespace

Navigator::Navigator(const PlannerParameters& parameters)
    : parameters_(parameters), pursuit_(parameters.pursuit()) {}
Navigator::~Navigator() = default;

// ---- the ground

void Navigator::update(const GridFrame& frame, const CostGrid::Box& box, const float* traversability) {
  if (refused_frame_ && *refused_frame_ == frame) return;
  if (!grid_ || !(grid_->frame() == frame)) {
    if (box.x != 0 || box.y != 0 || box.width != frame.width || box.height != frame.height)
      throw ConfigError("the first traversability of a terrain must be that of the whole grid");
    begin_on(frame);
    if (!grid_) return;
  }
  const std::size_t before = changed_.size();
  grid_->update(box, traversability, changed_);
  ground_changed_ = ground_changed_ || changed_.size() > before;
  if (changed_.size() > grid_->size()) field_.reset();  // it has not been asked for long
  if (!field_) changed_.clear();
}

void Navigator::begin_on(const GridFrame& frame) {
  field_.reset();
  reference_.reset();
  grid_.reset();
  changed_.clear();
  avoided_.clear();
  forecast_.clear();
  pursuit_.follow({});
  schedule_.clear();
  ++path_number_;
  ground_refusal_.clear();
  refused_frame_.reset();
  try {
    grid_ = std::make_unique<CostGrid>(frame, parameters_.costs());
  } catch (const ConfigError& e) {
    ground_refusal_ = e.what();
    refused_frame_ = frame;
  }
}

void Navigator::set_forecast(const ForecastCosts& forecast) {
  if (!grid_ || !(grid_->frame() == forecast.frame))
    throw ConfigError("the forecast's grid has not the place and size of the terrain");
  if (forecast.times.size() != forecast.traversability.size())
    throw ConfigError("the forecast has not one grid of costs for each of its times");
  const GridFrame& f = forecast.frame;
  const std::size_t cells = static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height);
  std::vector<ForecastMoment> moments;
  for (std::size_t n = 0; n < forecast.times.size(); ++n) {
    if (forecast.traversability[n].size() != cells)
      throw ConfigError("costs of the forecast have another size than its grid");
    // Counted from its beginning: from one that is far off, numbers that rise may not.
    const double time = forecast.made + forecast.times[n];
    if (!std::isfinite(time) || (n > 0 && !(time > moments.back().time)))
      throw ConfigError("the times of the forecast do not rise: moment " + std::to_string(n) + " is at " +
                        number_text(time) + " s" +
                        (n > 0 ? ", the one before at " + number_text(moments.back().time) + " s" : ""));
    auto grid = std::make_shared<CostGrid>(f, parameters_.costs());
    std::vector<CellIndex> changed;
    grid->update({0, 0, f.width, f.height}, forecast.traversability[n].data(), changed);
    for (const GridPoint& p : avoided_) grid->mark(p, parameters_.avoid_radius, true, changed);
    moments.push_back({time, forecast.made, std::move(grid)});
  }
  for (ForecastMoment& before : forecast_) {  // of one that began later the time has been set back
    const bool beyond = moments.empty() || before.time > moments.back().time;
    if (beyond && before.made <= forecast.made) moments.push_back(std::move(before));
  }
  forecast_ = std::move(moments);
  new_forecast_ = true;
}

// ---- goals

void Navigator::set_goal(const PlanarPose& goal, double time) {
  if (!std::isfinite(goal.x) || !std::isfinite(goal.y) || !std::isfinite(goal.yaw))
    throw ConfigError("the goal is not of finite numbers");
  if (grid_) {
    const GridFrame& f = grid_->frame();
    if (!grid_->cell_at({goal.x, goal.y}))
      throw ConfigError("the goal " + point_text(goal.x, goal.y) + " is off the terrain, which is x " +
                        coordinate_text(f.origin_x) + " ... " +
                        coordinate_text(f.origin_x + f.width * f.cell_size) + ", y " +
                        coordinate_text(f.origin_y) + " ... " +
                        coordinate_text(f.origin_y + f.height * f.cell_size));
    for (const GridPoint& p : avoided_) grid_->mark(p, parameters_.avoid_radius, false, changed_);
  }
  avoided_.clear();
  goal_ = goal;
  goal_time_ = now_ = time;
  pursuit_.follow({});
  schedule_.clear();
  ++path_number_;
  no_path_since_.reset();
  last_attempt_.reset();
  buried_since_.reset();
  recovery_.reset();
  attempts_here_ = 0;
  const std::size_t differences = status_.field_differences;
  status_ = {};
  status_.field_differences = differences;
  status_.state = NavigatorState::waiting;
  status_.reason = "a path is being planned";
}

void Navigator::cancel(const std::string& reason) {
  if (goal_) finish(NavigatorState::cancelled, reason);
}

DriveCommand Navigator::finish(NavigatorState state, const std::string& reason) {
  status_.state = state;
  status_.reason = reason;
  goal_.reset();
  recovery_.reset();
  pursuit_.follow({});
  schedule_.clear();
  ++path_number_;
  return {};
}

DriveCommand Navigator::wait(const std::string& reason) {
  status_.state = NavigatorState::waiting;
  status_.reason = reason;
  return {};
}

// ---- one step

DriveCommand Navigator::act(double time, const PlanarPose& pose, RoverCondition condition,
                            const std::string& why) {
  now_ = time;
  pose_ = pose;
  if (!goal_) return {};
  status_.elapsed = now_ - goal_time_;
  status_.distance = distance(pose, *goal_);
  pursuit_.locate(pose);
  status_.remaining = pursuit_.left();
  if (const auto command = mind_limits()) return *command;
  if (const auto command = mind_condition(condition, why)) return *command;
  if (const auto command = mind_arrival()) return *command;
  const std::string need = need_of_path();
  if (!need.empty()) {
    const bool had_path = !pursuit_.path().empty();
    const std::string problem = plan();
    if (!problem.empty()) {
      pursuit_.follow({});
      if (!no_path_since_) no_path_since_ = now_;
      if (now_ - *no_path_since_ >= parameters_.no_path_patience)
        return finish(NavigatorState::no_path, problem);
      return wait("no path: " + problem);
    }
    no_path_since_.reset();
    ++status_.plans;
    if (had_path || status_.plans > 1) {
      ++status_.replans;
      status_.last_replan = need;
    }
  }
  return pursuit_.path().empty() ? wait(status_.reason) : follow();
}

std::optional<DriveCommand> Navigator::mind_limits() {
  if (parameters_.time_limit > 0 && status_.elapsed >= parameters_.time_limit)
    return finish(NavigatorState::timed_out, "the goal was not reached within " +
                                                 number_text(parameters_.time_limit) + " s; " +
                                                 number_text(status_.distance) + " m were left");
  if (!grid_)
    return wait(ground_refusal_.empty() ? "the terrain is not known yet"
                                        : "this terrain cannot be planned on: " + ground_refusal_);
  if (!grid_->cell_at({goal_->x, goal_->y}))
    return finish(NavigatorState::no_path, "the goal is off the terrain");
  return std::nullopt;
}

std::optional<DriveCommand> Navigator::mind_condition(RoverCondition condition, const std::string& why) {
  if (condition == RoverCondition::tipped) return finish(NavigatorState::tipped, why);
  if (condition == RoverCondition::no_terrain) return wait("the rover does not know the ground: " + why);
  if (condition == RoverCondition::buried) {
    if (!buried_since_) buried_since_ = now_;
    if (now_ - *buried_since_ >= parameters_.buried_patience) return finish(NavigatorState::buried, why);
    return wait("buried: " + why);
  }
  buried_since_.reset();
  if (recovery_) return recover();
  if (condition == RoverCondition::stuck || condition == RoverCondition::blocked ||
      condition == RoverCondition::off_grid) {
    if (status_.recoveries > 0 && distance(pose_, last_trouble_) > 5 * parameters_.recovery_way)
      attempts_here_ = 0;
    if (attempts_here_ >= parameters_.recoveries)
      return finish(NavigatorState::stuck,
                    "after " + std::to_string(attempts_here_) + " attempts to get free: " + why);
    begin_recovery(why);
    return recover();
  }
  return std::nullopt;
}

void Navigator::begin_recovery(const std::string& why) {
  ++status_.recoveries;
  recovery_ = {now_, attempts_here_ % 2 == 0 ? -1.0 : 1.0, pose_};
  ++attempts_here_;
  last_trouble_ = pose_;
  status_.state = NavigatorState::recovering;
  status_.reason = why;
  if (!(parameters_.avoid_radius > 0) || recovery_->direction > 0) return;
  // What is ahead is avoided; the ground on which the rover stands must stay passable.
  const double ahead = parameters_.radius + parameters_.avoid_radius;
  const elementary::UnitVector way = elementary::direction(pose_.yaw);
  const GridPoint p{pose_.x + ahead * way.x, pose_.y + ahead * way.y};
  if (elementary::hypot(p.x - goal_->x, p.y - goal_->y) <= parameters_.avoid_radius + parameters_.radius)
    return;
  grid_->mark(p, parameters_.avoid_radius, true, changed_);
  avoided_.push_back(p);
  ground_changed_ = true;
}

DriveCommand Navigator::recover() {
  const bool done = distance(pose_, recovery_->from) >= parameters_.recovery_way;
  if (!done && now_ - recovery_->since < parameters_.recovery_time)
    return {recovery_->direction * parameters_.recovery_speed, 0, 0};
  recovery_.reset();
  pursuit_.follow({});  // from where it is now
  return {};
}

std::optional<DriveCommand> Navigator::mind_arrival() {
  if (status_.distance > parameters_.goal_tolerance) return std::nullopt;
  const double angle = std::remainder(goal_->yaw - pose_.yaw, 2 * pi);
  if (parameters_.goal_yaw_tolerance_deg < 180 && parameters_.turns_on_the_spot &&
      std::abs(angle) > parameters_.goal_yaw_tolerance_deg * pi / 180) {
    status_.state = NavigatorState::driving;
    status_.reason = "it turns to the heading of the goal";
    return turn(angle, parameters_.yaw_rate);
  }
  return finish(NavigatorState::arrived, "");
}

std::vector<TimedPoint> Navigator::schedule() const {
  const GridPath ahead = pursuit_.remaining();
  if (schedule_.empty() || ahead.empty()) return {};
  // The rover's place, and the points that it has not passed.
  const auto last_passed = schedule_.end() - static_cast<std::ptrdiff_t>(ahead.size());
  std::vector<TimedPoint> times(last_passed, schedule_.end());
  times.front().point = ahead.front();
  return times;
}

DriveCommand Navigator::follow() {
  status_.remaining = pursuit_.left();
  // Not ahead of the forecast: the ground ahead may not be free yet. It waits in the cell in which it is to.
  const double near = grid_->frame().cell_size / 2;
  double way = 0;
  for (std::size_t n = 0; n < schedule_.size(); ++n) {
    if (n > 0)
      way += elementary::hypot(schedule_[n].point.x - schedule_[n - 1].point.x,
                               schedule_[n].point.y - schedule_[n - 1].point.y);
    if (way < pursuit_.done() - near) continue;
    if (way > pursuit_.done() + near) break;
    if (std::isinf(schedule_[n].departure)) return wait_in_shelter();
    if (schedule_[n].departure > now_ + 1e-9 && schedule_[n].departure > schedule_[n].arrival + 1)
      return wait("until the ground ahead is free, " + number_text(schedule_[n].departure - now_) + " s");
  }
  status_.state = NavigatorState::driving;
  status_.reason.clear();
  return pursuit_.command();
}

/// Until a forecast tells of a way, or there has been none over the present ground either for too long.
DriveCommand Navigator::wait_in_shelter() {
  if (now_ - last_attempt_.value_or(now_) >= parameters_.replan_pause) {
    last_attempt_ = now_;
    Place start, goal;
    GridPath path;
    std::string problem = places(start, goal);
    if (problem.empty()) problem = plan_by_field(start, goal, path);
    if (problem.empty()) no_path_since_.reset();
    if (!problem.empty() && !no_path_since_) no_path_since_ = now_;
    if (no_path_since_ && now_ - *no_path_since_ >= parameters_.no_path_patience)
      return finish(NavigatorState::no_path, problem + ", and none with waiting as the forecast tells");
  }
  return wait("no way leads to the goal as the forecast tells; the ground here stays passable");
}

}  // namespace desert_sim

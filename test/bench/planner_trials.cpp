/// Seeded trials of rovers that a planner leads over a living desert, without ROS: how many arrive, and why
/// the others end. doc/notebook/planner_trials.md has results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "src/command_line/program.hpp"
#include "src/core/constants.hpp"
#include "src/core/error.hpp"
#include "src/planner/navigator.hpp"
#include "src/rover/grid_ground.hpp"
#include "src/rover/rover.hpp"
#include "src/simulation/session.hpp"
#include "src/tools/rasters.hpp"

using namespace desert_sim;

namespace {

constexpr int moments = 10;  // of a forecast

Options options() {
  Options o("planner_trials",
            "Drives rovers from starts to goals on a desert that moves, with one planner or several.");
  o.positional("SCENARIO.yaml", "the desert")
      .option("set", "KEY=VALUE", "of the scenario; may be repeated")
      .option("seeds", "N", "rovers with a start and goal each (default 20)")
      .option("first", "N", "number of the first one (default 1)")
      .option("planner", "P", "field (default), ompl, forecast; may be repeated: the same trials for each")
      .option("seconds", "N", "of ROS time, that a rover has (default 900)")
      .option("distance", "N", "from start to goal, at least [m] (default 60)")
      .option("goals", "WHERE",
              "rock (default): any passable ground; lee: close behind dunes, where they will be")
      .option("horizon", "N",
              "of forecasts [s] (default 300), of which there is one every tenth of it, with 10 moments")
      .option("threads", "N", "of the simulation (default 1)")
      .footer(
          "All rovers drive at the same time on one desert, and do not meet each other.\n"
          "Forecasts are runs of the same desert ahead, and therefore right. A line for each\n"
          "rover, and sums.\n"
          "Exit status: 0; 2 for invalid input; 3 for a failure at run time.");
  return o;
}

struct Place {
  double x, y, yaw;
};

struct Course {
  Place start;
  Place goal;
};

/// The desert at one state after another.
class Desert {
 public:
  Desert(const Scenario& scenario, int threads)
      : scenario_(scenario), session_(scenario, raster_loader(), "cpu", threads) {
    layers_ = GridGround::layers_of_snapshot();
    layers_.push_back(Layer::traversability);
    look();
  }
  /// ROS time of a step [s].
  double step_time() const { return scenario_.run.time_step / scenario_.run.acceleration; }
  void step() {
    session_.step();
    look();
  }
  void skip() { session_.step(); }
  void look() {
    snapshot_ = session_.simulation().views().snapshot(layers_);
    ground_ = std::make_unique<GridGround>(*snapshot_, scenario_.get<ReposeParameters>().moisture_capacity,
                                           scenario_.get<ReposeParameters>().moisture_depth);
  }
  GridFrame frame() const {
    return {snapshot_->width, snapshot_->height, snapshot_->cell_size, snapshot_->origin_x,
            snapshot_->origin_y};
  }
  const std::vector<float>& traversability() const { return *snapshot_->find(Layer::traversability); }
  const GridGround& ground() const { return *ground_; }

 private:
  Scenario scenario_;
  Session session_;
  std::vector<Layer> layers_;
  std::shared_ptr<const Snapshot> snapshot_;
  std::unique_ptr<GridGround> ground_;
};

/// Traversability at every `every` seconds, of a run ahead.
class Future {
 public:
  Future(const Scenario& scenario, int threads, double every, double until) : every_(every) {
    Desert desert(scenario, threads);
    const int steps = static_cast<int>(std::lround(every / desert.step_time()));
    for (double t = 0; t <= until; t += every) {
      desert.look();
      frames_.push_back(desert.traversability());
      frame_ = desert.frame();
      for (int n = 0; n < steps; ++n) desert.skip();
    }
  }
  const std::vector<float>& at(double time) const {
    const auto n = static_cast<std::size_t>(std::lround(time / every_));
    return frames_[std::min(n, frames_.size() - 1)];
  }
  /// What a forecast tells that begins at `time`.
  ForecastCosts forecast(double time, double horizon) const {
    ForecastCosts f;
    f.made = time;
    f.frame = frame_;
    for (int n = 1; n <= moments; ++n) {
      f.times.push_back(std::round(horizon * n / moments / every_) * every_);
      f.traversability.push_back(at(time + f.times.back()));
    }
    return f;
  }
  const GridFrame& frame() const { return frame_; }

 private:
  double every_;
  GridFrame frame_;
  std::vector<std::vector<float>> frames_;
};

/// A start and a goal that are passable now; with `lee`, the goal is passable, and will not be for a while.
Course course_of(unsigned seed, const Future& future, double distance, double seconds, bool lee) {
  std::mt19937 dice(seed);
  const GridFrame& f = future.frame();
  CostGrid now(f, {});
  std::vector<CellIndex> changed;
  now.update({0, 0, f.width, f.height}, future.at(0).data(), changed);
  const auto any = [&] {
    const double margin = 6;
    std::uniform_real_distribution<double> x(margin, f.width * f.cell_size - margin),
        y(margin, f.height * f.cell_size - margin);
    return GridPoint{f.origin_x + x(dice), f.origin_y + y(dice)};
  };
  const auto free_at = [&](const GridPoint& p, double time) {
    const auto cell = now.cell_at(p);
    const int x = now.x_of(*cell), y = now.y_of(*cell);
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (!(future.at(time)[static_cast<std::size_t>((y + dy) * f.width + x + dx)] > 0)) return false;
    return true;
  };
  for (int n = 0; n < 100000; ++n) {
    const GridPoint a = any(), b = any();
    if (std::hypot(a.x - b.x, a.y - b.y) < distance || !free_at(a, 0) || !free_at(b, 0)) continue;
    bool buried = false;
    for (double t = 0; t < seconds; t += 30) buried = buried || !free_at(b, t);
    if (buried != lee || (lee && !free_at(b, seconds))) continue;
    FieldPlanner field(now);
    field.compute(*now.cell_at(b));
    if (field.value(*now.cell_at(a)) >= FieldPlanner::unreachable) continue;
    const double yaw = std::uniform_real_distribution<double>(-pi, pi)(dice);
    return {{a.x, a.y, yaw}, {b.x, b.y, 0}};
  }
  throw ConfigError("seed " + std::to_string(seed) + ": no start and goal were found");
}

/// One rover with its planner.
class Trial {
 public:
  Trial(unsigned seed, const Course& course, const PlannerParameters& parameters, const Desert& desert)
      : seed_(seed), course_(course), navigator_(parameters), rover_({}, {}) {
    rover_.place(course.start.x, course.start.y, course.start.yaw, desert.ground());
    take(desert);
    navigator_.set_goal({course.goal.x, course.goal.y, course.goal.yaw}, 0);
  }
  void take(const Desert& desert) {
    const GridFrame f = desert.frame();
    navigator_.update(f, {0, 0, f.width, f.height}, desert.traversability().data());
  }
  void set_forecast(const ForecastCosts& forecast) { navigator_.set_forecast(forecast); }
  bool active() const { return navigator_.active(); }
  /// The rover drives on for a while, with a command every 0.1 s.
  void drive(double time, double seconds, const Desert& desert) {
    for (double t = 0; t < seconds - 1e-9 && active(); t += 0.1) {
      const RoverState& s = rover_.state();
      const DriveCommand command =
          navigator_.act(time + t, {s.pose.x, s.pose.y, s.pose.yaw}, s.condition, s.reason);
      if (navigator_.status().replans > replans_) {
        replans_ = navigator_.status().replans;
        const std::string why = navigator_.status().last_replan.substr(0, 24);
        ++reasons_[why.substr(0, why.find_first_of("0123456789"))];
      }
      rover_.drive(command, 0.5);
      const RoverCondition before = s.condition;
      rover_.advance(0.1, &desert.ground());
      const RoverCondition after = rover_.state().condition;
      stuck_ += after == RoverCondition::stuck && before != after;
      blocked_ += after == RoverCondition::blocked && before != after;
      buried_ += after == RoverCondition::buried && before != after;
    }
  }
  const NavigatorStatus& status() const { return navigator_.status(); }
  /// Replans by the first words of their reason.
  const std::map<std::string, int>& reasons() const { return reasons_; }
  int stuck() const { return stuck_; }
  int blocked() const { return blocked_; }
  int buried() const { return buried_; }
  void print() const {
    const NavigatorStatus& s = status();
    const RoverState& r = rover_.state();
    std::printf(
        "  seed %u: %s after %.0f s, %d replans, %d stuck, %d blocked, %d buried; from (%.0f, %.0f) to "
        "(%.0f, "
        "%.0f), at (%.1f, %.1f): %s\n",
        seed_, navigator_states[static_cast<int>(s.state)], s.elapsed, s.replans, stuck_, blocked_, buried_,
        course_.start.x, course_.start.y, course_.goal.x, course_.goal.y, r.pose.x, r.pose.y,
        s.reason.c_str());
  }

 private:
  unsigned seed_;
  Course course_;
  Navigator navigator_;
  Rover rover_;
  int stuck_ = 0, blocked_ = 0, buried_ = 0, replans_ = 0;
  std::map<std::string, int> reasons_;
};

struct Sum {
  int arrived = 0, replans = 0, stuck = 0, blocked = 0, buried = 0, recoveries = 0, troubled = 0;
  double time = 0;
  std::size_t differences = 0;
  std::map<std::string, int> reasons;
};

PlannerParameters parameters_of(const std::string& planner, double seconds) {
  PlannerParameters p;
  const auto found = std::find(std::begin(planner_kinds), std::end(planner_kinds), planner);
  if (found == std::end(planner_kinds))
    throw ConfigError("--planner " + planner + ": not field, ompl or forecast");
  p.planner = static_cast<PlannerKind>(found - std::begin(planner_kinds));
  p.time_limit = seconds;
  p.no_path_patience = seconds;
  p.check_every = 50;
  return p;
}

void print(const std::string& planner, const std::vector<std::unique_ptr<Trial>>& trials) {
  Sum sum;
  for (const std::unique_ptr<Trial>& each : trials) {
    const Trial& t = *each;
    const NavigatorStatus& s = t.status();
    const bool arrived = s.state == NavigatorState::arrived;
    sum.arrived += arrived;
    sum.time += arrived ? s.elapsed : 0;
    sum.replans += s.replans;
    sum.stuck += t.stuck();
    sum.blocked += t.blocked();
    sum.buried += t.buried();
    sum.recoveries += s.recoveries;
    sum.troubled += t.stuck() > 0 || t.buried() > 0;
    sum.differences += s.field_differences;
    for (const auto& [why, count] : t.reasons()) sum.reasons[why] += count;
    t.print();
  }
  for (const auto& [why, count] : sum.reasons) std::printf("  %d replans: %s...\n", count, why.c_str());
  std::printf(
      "%s: %d of %zu arrived, in %.0f s on average; %d replans, %d times stuck, %d blocked, %d buried (%d "
      "rovers stuck "
      "or buried), %d recoveries; %zu cells of fields wrong\n",
      planner.c_str(), sum.arrived, trials.size(), sum.arrived > 0 ? sum.time / sum.arrived : 0, sum.replans,
      sum.stuck, sum.blocked, sum.buried, sum.troubled, sum.recoveries, sum.differences);
}

int run(const Options& o) {
  const Scenario scenario = load_scenario(o.positional().front(), o.values("set"));
  const auto threads = static_cast<int>(o.number("threads", 1, 0, 4096));
  const auto seconds = static_cast<double>(o.number("seconds", 900, 10, 100000)),
             distance = static_cast<double>(o.number("distance", 60, 1, 100000)),
             horizon = static_cast<double>(o.number("horizon", 300, 10, 100000));
  std::vector<std::string> planners = o.values("planner");
  if (planners.empty()) planners = {"field"};
  const double every = horizon / moments;
  const Future future(scenario, threads, every, seconds + horizon);
  Desert desert(scenario, threads);
  std::vector<std::vector<std::unique_ptr<Trial>>> trials(planners.size());
  const auto first = static_cast<unsigned>(o.number("first", 1, 0, 1000000));
  for (unsigned n = 0; n < o.number("seeds", 20, 1, 1000); ++n) {
    const Course course = course_of(first + n, future, distance, seconds, o.text("goals", "rock") == "lee");
    for (std::size_t k = 0; k < planners.size(); ++k)
      trials[k].push_back(
          std::make_unique<Trial>(first + n, course, parameters_of(planners[k], seconds), desert));
  }
  double next_forecast = 0;
  const double step = desert.step_time();
  for (double time = 0; time < seconds + 1; time += step) {
    const bool forecast_due = time >= next_forecast - 1e-6;
    for (std::size_t k = 0; k < planners.size(); ++k) {
      ForecastCosts forecast;
      if (forecast_due && planners[k] == "forecast") forecast = future.forecast(next_forecast, horizon);
      for (const std::unique_ptr<Trial>& t : trials[k]) {
        if (!t->active()) continue;
        t->take(desert);
        if (!forecast.times.empty()) t->set_forecast(forecast);
        t->drive(time, step, desert);
      }
    }
    if (forecast_due) next_forecast += every;
    desert.step();
  }
  for (std::size_t k = 0; k < planners.size(); ++k) print(planners[k], trials[k]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_main(options(), argc, argv, run); }

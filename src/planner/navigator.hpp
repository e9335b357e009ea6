#pragma once
/// Leads a rover to goals over changing ground: plans, follows, watches what remains of the path, gets free
/// where the rover is stuck, and says why it ends. Without ROS and without a clock of its own: who calls
/// act() tells the time. The same calls give the same commands.
///
/// Of the rover's conditions (rover_state.hpp) it heeds stuck and blocked (backs out, then goes ahead, in
/// turns, and avoids the place), buried (waits for the wind), tipped, off_grid and no_terrain.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/planner/field_planner.hpp"
#include "src/planner/planner_parameters.hpp"
#include "src/planner/pure_pursuit.hpp"

namespace desert_sim {

/// idle: no goal; driving, waiting and recovering: on the way; the others are ends, which last until the next
/// goal.
enum class NavigatorState : int {
  idle,
  driving,
  waiting,
  recovering,
  arrived,
  no_path,
  stuck,
  buried,
  tipped,
  timed_out,
  cancelled
};
constexpr const char* navigator_states[] = {"idle",    "driving",   "waiting",  "recovering",
                                            "arrived", "no_path",   "stuck",    "buried",
                                            "tipped",  "timed_out", "cancelled"};
constexpr bool is_end(NavigatorState s) { return s >= NavigatorState::arrived; }

struct NavigatorStatus {
  NavigatorState state = NavigatorState::idle;
  std::string reason;                 ///< why it waits, gets free or has ended
  double distance = 0;                ///< straight to the goal [m]
  double remaining = 0;               ///< along the path [m]
  double cost = 0;                    ///< of that way: metres of the best ground
  double elapsed = 0;                 ///< since the goal was set [s]
  int plans = 0;                      ///< paths for this goal
  int replans = 0;                    ///< of these, those that took the place of one before
  std::string last_replan;            ///< why
  int recoveries = 0;                 ///< attempts to get free
  double forecast_age = -1;           ///< of the forecast that the path was planned through [s]; −1: none
  std::size_t field_differences = 0;  ///< cells in which the field has differed from one computed anew; 0
};

/// Costs at moments, as a forecast tells them.
struct ForecastCosts {
  double made = 0;                                 ///< time at which it began [s]
  std::vector<double> times;                       ///< of the moments, after that [s]
  std::vector<std::vector<float>> traversability;  ///< of each, row by row from the south-west
  GridFrame frame;
};

class Navigator {
 public:
  explicit Navigator(const PlannerParameters& parameters);
  ~Navigator();

  // ---- the ground

  /// Traversability of a box of cells, or of the whole grid if the frame is a new one. What it cannot plan on
  /// (too many cells, or ones too small for the rover's radius) it waits on: ground_refusal() says why.
  void update(const GridFrame& frame, const CostGrid::Box& box, const float* traversability);
  const CostGrid* grid() const { return grid_.get(); }
  const std::string& ground_refusal() const { return ground_refusal_; }
  /// Takes the place of the one before up to its last moment. What that one tells of later times still holds
  /// until it is too old: a forecast that does not reach so far does not say that nothing will happen then.
  void set_forecast(const ForecastCosts& forecast);
  /// Whom it asks for the layers of costs by heading (planner ompl), when it plans: of the grid's size, or
  /// empty.
  using LayerSource = std::function<HeadingLayers(const GridFrame&)>;
  void set_layer_source(LayerSource source) { layer_source_ = std::move(source); }

  // ---- goals

  void set_goal(const PlanarPose& goal, double time);
  void cancel(const std::string& reason);
  bool active() const { return goal_.has_value(); }

  /// What the rover is to do now. Time [s] must not go back while there is a goal.
  DriveCommand act(double time, const PlanarPose& pose, RoverCondition condition, const std::string& why);

  const NavigatorStatus& status() const { return status_; }
  /// What lies ahead of the rover of the present path; empty without a goal.
  GridPath path() const { return pursuit_.remaining(); }
  /// Times of its points [s], where a forecast was planned through; else empty. The first is that at which
  /// the rover was to be at the last point that it has passed.
  std::vector<TimedPoint> schedule() const;
  /// How far the rover has come on the path [m].
  double path_done() const { return pursuit_.done(); }
  /// Changes whenever there is another path.
  std::uint64_t path_number() const { return path_number_; }
  const FieldPlanner* field() const { return field_.get(); }

 private:
  void begin_on(const GridFrame& frame);
  struct Place {
    GridPoint point;
    CellIndex cell;
  };
  DriveCommand finish(NavigatorState state, const std::string& reason);
  DriveCommand wait(const std::string& reason);
  /// A command if the rover's condition, time or place decide what is to be done.
  std::optional<DriveCommand> mind_limits();
  std::optional<DriveCommand> mind_condition(RoverCondition condition, const std::string& why);
  std::optional<DriveCommand> mind_arrival();
  DriveCommand recover();
  void begin_recovery(const std::string& why);
  DriveCommand follow();
  DriveCommand wait_in_shelter();

  // ---- planning
  /// Why another path is needed; empty if the present one will do.
  std::string need_of_path();
  /// Plans; what the reason is where there is no path.
  std::string plan();
  std::string plan_by_field(const Place& start, const Place& goal, GridPath& path);
  std::string plan_by_ompl(const Place& start, const Place& goal, GridPath& path);
  std::string plan_by_forecast(const Place& start, const Place& goal, GridPath& path);
  /// Times what remains of the path by the newest forecast. Why it is given up; empty if it is kept.
  std::string renew_schedule();
  /// The cells of what remains of the path, and those around the rover.
  std::vector<bool> cells_of_path() const;
  /// Where the path begins and ends; why there is none otherwise. With `later` a goal counts that is not
  /// passable now.
  std::string places(Place& start, Place& goal, bool later = false) const;
  bool believes_forecast() const;
  void prepare_field(const Place& start, const Place& goal);
  TimedCosts timed_costs();
  void take(GridPath path, const Place& goal);
  double free_start() const { return parameters_.escape; }

  const PlannerParameters parameters_;
  std::unique_ptr<CostGrid> grid_;
  std::string ground_refusal_;  ///< why there is no grid for refused_frame_; else empty
  std::optional<GridFrame> refused_frame_;
  std::unique_ptr<FieldPlanner> field_, reference_;
  std::vector<CellIndex> changed_;  ///< costs that the field does not know of yet
  bool ground_changed_ = false;     ///< since the path was looked at
  struct ForecastMoment {
    double time, made;  ///< of the moment, and at which its forecast began [s]
    std::shared_ptr<const CostGrid> grid;
  };
  std::vector<ForecastMoment> forecast_;  ///< by time
  bool new_forecast_ = false;
  LayerSource layer_source_;

  std::optional<PlanarPose> goal_;
  double goal_time_ = 0, now_ = 0;
  PlanarPose pose_;
  PurePursuit pursuit_;
  std::vector<double> cost_left_;  ///< of the path from each of its points on, when it was planned
  std::vector<TimedPoint> schedule_;
  bool to_shelter_ = false;  ///< the path does not lead to the goal, but to a shelter (TimedPlanner)
  std::uint64_t path_number_ = 0;
  std::optional<double> no_path_since_, last_attempt_, buried_since_;
  std::vector<GridPoint> avoided_;

  struct Recovery {
    double since = 0, direction = -1;
    PlanarPose from;
  };
  std::optional<Recovery> recovery_;
  PlanarPose last_trouble_;
  int attempts_here_ = 0;
  NavigatorStatus status_;
};

}  // namespace desert_sim

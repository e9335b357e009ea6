#pragma once
/// Parameters of a planner and follower.

#include <string>

#include "src/core/parameter_table.hpp"
#include "src/planner/ompl_planner.hpp"
#include "src/planner/pure_pursuit.hpp"
#include "src/planner/timed_planner.hpp"

namespace desert_sim {

/// field: the cost to the goal from every cell, repaired as costs change; ompl: a free path by OMPL, with
/// costs by heading; forecast: the earliest arrival over ground that changes as forecasts say.
enum class PlannerKind : int { field, ompl, forecast };
constexpr const char* planner_kinds[] = {"field", "ompl", "forecast"};

struct PlannerParameters {
  PlannerKind planner = PlannerKind::field;
  // ---- costs
  double radius = 0.5;
  int buckets = 16;
  double cost_weight = 8;
  double lethal_below = 0;
  // ---- goals
  double goal_tolerance = 0.5;
  double goal_yaw_tolerance_deg = 180;
  double time_limit = 0;
  double escape = 2;
  // ---- replanning
  double replan_rise = 0.15;
  double replan_gain = 0.15;
  double off_path = 2;
  double no_path_patience = 60;
  double replan_pause = 1;
  int check_every = 100;
  // ---- the forecast
  double forecast_speed = 0.2;
  double forecast_slowing = 2;
  double forecast_age = 300;
  // ---- following
  double speed = 0.3;
  double yaw_rate = 0.5;
  double lookahead = 1;
  double turn_angle_deg = 45;
  bool turns_on_the_spot = true;
  double narrowest_arc = 1.5;
  // ---- trouble
  int recoveries = 6;
  double recovery_way = 1;
  double recovery_time = 20;
  double recovery_speed = 0.15;
  double avoid_radius = 1;
  double buried_patience = 120;
  // ---- OMPL
  int ompl_evaluations = 20000;
  double ompl_time = 2;
  int ompl_seed = 1;
  double slip_weight = 4;
  double drift_weight = 4;
  double sinkage_weight = 20;
  double water_weight = 10;
  double flow_weight = 15;
  double wind_weight = 0.02;

  CostParameters costs() const { return {buckets, cost_weight, lethal_below, radius}; }
  PursuitParameters pursuit() const {
    return {speed, yaw_rate, lookahead, turn_angle_deg, turns_on_the_spot, narrowest_arc};
  }
  OmplParameters ompl() const { return {ompl_evaluations, ompl_time, static_cast<std::uint32_t>(ompl_seed)}; }
  HeadingWeights heading_weights() const {
    return {slip_weight, drift_weight, sinkage_weight, water_weight, flow_weight, wind_weight};
  }
};

constexpr auto parameter_table(const PlannerParameters*) {
  using P = PlannerParameters;
  return std::make_tuple(
      parameter(
          "planner", &P::planner, planner_kinds,
          "field: costs to the goal from every cell, repaired as they change; ompl: a free path with costs "
          "by heading; forecast: the earliest arrival over ground that changes as forecasts say."),
      parameter("radius", &P::radius, 0, 20, "m",
                "Of the rover: so far it stays from lethal cells, one cell at least."),
      parameter("buckets", &P::buckets, 1, 100, "1",
                "Classes of traversability; within one, nothing is planned anew."),
      parameter("cost_weight", &P::cost_weight, 0, 60, "1",
                "What ground that is barely passable costs beyond the best; it rises with the square of 1 - "
                "traversability."),
      parameter("lethal_below", &P::lethal_below, 0, 0.99, "1",
                "Traversability up to which a cell is lethal."),
      parameter("goal_tolerance", &P::goal_tolerance, 0.01, 100, "m",
                "Distance to the goal at which it has arrived."),
      parameter("goal_yaw_tolerance_deg", &P::goal_yaw_tolerance_deg, 1, 180, "deg",
                "Of the heading at the goal; 180: any. Below, it turns on the spot at the end."),
      parameter("time_limit", &P::time_limit, 0, 1e9, "s", "For a goal, from when it was set; 0: none."),
      parameter("escape", &P::escape, 0, 20, "m",
                "How far a passable cell may be from the rover where it stands on none."),
      parameter("replan_rise", &P::replan_rise, 0, 100, "1",
                "Share by which the cost of what remains of the path rises until another is planned."),
      parameter("replan_gain", &P::replan_gain, 0, 1, "1",
                "Share by which another path has to cost less to be taken (field)."),
      parameter("off_path", &P::off_path, 0.1, 100, "m",
                "Distance from the path at which another is planned."),
      parameter("no_path_patience", &P::no_path_patience, 0, 1e9, "s",
                "How long it waits for a path on ground that changes."),
      parameter("replan_pause", &P::replan_pause, 0, 1e6, "s",
                "Shortest time between two attempts that found no path."),
      parameter("check_every", &P::check_every, 0, 1e9, "1",
                "After so many repairs the field is compared with one that is computed anew; 0: never."),
      parameter("forecast_speed", &P::forecast_speed, 0.001, 20, "m/s",
                "Speed over ground that the forecast's path counts on, on the best ground."),
      parameter("forecast_slowing", &P::forecast_slowing, 0, 100, "1",
                "Share by which it takes longer on ground that is barely passable."),
      parameter("forecast_age", &P::forecast_age, 0, 1e9, "s", "Age up to which a forecast is believed."),
      parameter("speed", &P::speed, 0.001, 20, "m/s", "On straight ways."),
      parameter("yaw_rate", &P::yaw_rate, 0.001, 20, "rad/s", "At most."),
      parameter("lookahead", &P::lookahead, 0.05, 100, "m",
                "How far ahead on the path the point is that it pursues."),
      parameter("turn_angle_deg", &P::turn_angle_deg, 10, 180, "deg",
                "Angle to that point from which on it turns on the spot."),
      parameter("turns_on_the_spot", &P::turns_on_the_spot,
                "Whether it can (skid, per_wheel); false for ackermann."),
      parameter("narrowest_arc", &P::narrowest_arc, 0.05, 1000, "m",
                "Radius of the arcs of a rover that cannot."),
      parameter("recoveries", &P::recoveries, 0, 1000, "1",
                "Attempts to get free, by turns backwards and ahead, before it gives up as stuck."),
      parameter("recovery_way", &P::recovery_way, 0.05, 100, "m", "Way of an attempt."),
      parameter("recovery_time", &P::recovery_time, 0.1, 1e6, "s", "Longest time of an attempt."),
      parameter("recovery_speed", &P::recovery_speed, 0.001, 20, "m/s", "Of the rims meanwhile."),
      parameter("avoid_radius", &P::avoid_radius, 0, 20, "m",
                "Around where it was stuck or blocked, ground that counts as lethal until the next goal."),
      parameter("buried_patience", &P::buried_patience, 0, 1e9, "s",
                "How long it waits, buried, for the wind to uncover it."),
      parameter("ompl_evaluations", &P::ompl_evaluations, 100, 1e8, "1",
                "Lines whose cost is computed for a path; the same number gives the same path."),
      parameter("ompl_time", &P::ompl_time, 0.001, 1e6, "s", "Of wall time for a path at most."),
      parameter("ompl_seed", &P::ompl_seed, 1, 1e9, "1", "Of OMPL's random numbers."),
      parameter("slip_weight", &P::slip_weight, 0, 1000, "1", "ompl: cost of a metre by its slip."),
      parameter("drift_weight", &P::drift_weight, 0, 1000, "1", "ompl: by its drift downhill."),
      parameter("sinkage_weight", &P::sinkage_weight, 0, 1e5, "1/m", "ompl: by its sinkage."),
      parameter("water_weight", &P::water_weight, 0, 1e5, "1/m", "ompl: by its depth of water."),
      parameter("flow_weight", &P::flow_weight, 0, 1e5, "s/m^2", "ompl: by depth x speed of its water."),
      parameter("wind_weight", &P::wind_weight, 0, 100, "s/m", "ompl: by its headwind."));
}
static_assert(table_is_complete<PlannerParameters>());

}  // namespace desert_sim

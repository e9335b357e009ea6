#pragma once
/// Messages of a planner.

#include <desert_sim/Forecast.h>
#include <desert_sim/PlannerStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <tf2/buffer_core.h>

#include <optional>

#include "include/desert_sim/client/layer_map.hpp"
#include "src/planner/navigator.hpp"

namespace desert_sim {

geometry_msgs::Quaternion yaw_quaternion(double yaw);
/// Of a quaternion whose length is 1 [rad].
double yaw_of(const geometry_msgs::Quaternion& q);
/// A pose seen from above. Throws ConfigError, naming `what`, for places that are not finite and quaternions
/// whose length is not 1.
PlanarPose planar_pose(const geometry_msgs::Pose& pose, const std::string& what);

/// A goal in the terrain's frame, by the latest transform: a goal is a place, whenever it was said. Goals
/// without a frame are there already, and so are all while the name of that frame is not known (empty).
/// Throws ConfigError for one that planar_pose() refuses, or whose frame has no transform.
geometry_msgs::PoseStamped goal_in_terrain(const geometry_msgs::PoseStamped& goal, const std::string& terrain,
                                           const tf2::BufferCore& transforms);

/// The condition of this name; that of a rover that knows no ground for names that are none.
RoverCondition condition_named(const std::string& name);

GridFrame grid_frame_of(const MapInfo& info);

/// The path draped on the elevation: a pose at least every cell, at the height of the surface (0 where it is
/// unknown), x along the path and up or down with it. Stamps are those of the schedule, if there is one, else
/// `stamp`.
nav_msgs::Path path_message(const GridPath& path, const std::vector<TimedPoint>& schedule,
                            const LayerMap* elevation, const std::string& frame, const ros::Time& stamp);

/// What follows from the navigator's status; the rest is left empty.
PlannerStatus planner_status_message(const NavigatorStatus& status);

/// Costs of a forecast as traversability. `begin`: the time of its start in the navigator's time [s]; `pace`:
/// seconds of that for each of its own. Of an ensemble, cells that a smaller share than `probability` of the
/// members can pass are lethal. Throws ConfigError for messages whose grids, times or sizes do not fit
/// together.
ForecastCosts forecast_costs(const Forecast& forecast, double begin, double pace, double probability);

}  // namespace desert_sim

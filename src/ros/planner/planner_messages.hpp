#pragma once
/// Messages of a planner.

#include <desert_sim/Forecast.h>
#include <desert_sim/PlannerStatus.h>
#include <geometry_msgs/Quaternion.h>
#include <nav_msgs/Path.h>

#include <optional>

#include "src/client/layer_map.hpp"
#include "src/planner/navigator.hpp"

namespace desert_sim {

geometry_msgs::Quaternion yaw_quaternion(double yaw);
/// The heading of a quaternion. Throws ConfigError, naming `what`, for one that is none.
double yaw_of(const geometry_msgs::Quaternion& q, const std::string& what);

GridFrame grid_frame_of(const MapInfo& info);

/// The path draped on the elevation: a pose at least every cell, at the height of the surface (0 where it is
/// unknown), x along the path and up or down with it. Stamps are those of the schedule, if there is one, else
/// `stamp`.
nav_msgs::Path path_message(const GridPath& path, const std::vector<TimedPoint>& schedule,
                            const LayerMap* elevation, const std::string& frame, const ros::Time& stamp);

/// What follows from the navigator's status; the rest is left empty.
PlannerStatus planner_status_message(const NavigatorStatus& status);

/// Costs of a forecast as traversability. `begin`: the time of its start in the navigator's time [s]. Of an
/// ensemble, cells that a smaller share than `probability` of the members can pass are lethal. Throws
/// ConfigError for messages whose grids, times or sizes do not fit together.
ForecastCosts forecast_costs(const Forecast& forecast, double begin, double probability);

}  // namespace desert_sim

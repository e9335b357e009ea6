#include "src/ros/planner/planner_messages.hpp"

#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/client/ros_time.hpp"
#include "src/core/error.hpp"
#include "src/core/number_text.hpp"
#include "src/core/rotation.hpp"
#include "src/ros/conversion/terrain_transforms.hpp"

namespace desert_sim {

namespace {

geometry_msgs::Quaternion quaternion(double pitch, double yaw) {
  const Eigen::Quaterniond q =
      turn_of_halves({1, 0}, elementary::direction(pitch / 2), elementary::direction(yaw / 2));
  geometry_msgs::Quaternion m;
  m.x = q.x();
  m.y = q.y();
  m.z = q.z();
  m.w = q.w();
  return m;
}

GridFrame grid_frame_of(const nav_msgs::MapMetaData& info) {
  return {static_cast<int>(info.width), static_cast<int>(info.height), info.resolution,
          info.origin.position.x, info.origin.position.y};
}

/// 0 … 99 is a cost, 100 lethal, all else unknown.
float traversability_of(std::int8_t cost) {
  if (cost < 0 || cost > 100) return std::numeric_limits<float>::quiet_NaN();
  return cost == 100 ? 0.0F : std::max(1.0F - static_cast<float>(cost) / 99.0F, 0.001F);
}

}  // namespace

geometry_msgs::Quaternion yaw_quaternion(double yaw) { return quaternion(0, yaw); }

double yaw_of(const geometry_msgs::Quaternion& q) {
  return elementary::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
}

PlanarPose planar_pose(const geometry_msgs::Pose& pose, const std::string& what) {
  const geometry_msgs::Point& p = pose.position;
  if (!std::isfinite(p.x) || !std::isfinite(p.y))
    throw ConfigError(what + ": the place " + point_text(p.x, p.y) + " is not of finite numbers");
  const geometry_msgs::Quaternion& q = pose.orientation;
  const double norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  if (!(std::abs(norm - 1) < 0.01))
    throw ConfigError(what + ": the length of the quaternion is " + std::to_string(norm) + " (allowed: 1)");
  return {p.x, p.y, yaw_of(q)};
}

geometry_msgs::PoseStamped goal_in_terrain(const geometry_msgs::PoseStamped& goal, const std::string& terrain,
                                           const tf2::BufferCore& transforms) {
  planar_pose(goal.pose, "the goal");
  geometry_msgs::PoseStamped in_terrain = goal;
  const std::string given = frame_name(goal.header.frame_id);
  if (!terrain.empty() && !given.empty() && given != terrain) {
    try {
      tf2::doTransform(goal, in_terrain, transforms.lookupTransform(terrain, given, ros::Time(0)));
    } catch (const tf2::TransformException& e) {
      throw ConfigError("the goal's frame '" + goal.header.frame_id + "' has no transform to '" + terrain +
                        "': " + e.what());
    }
    planar_pose(in_terrain.pose, "the goal in the frame '" + terrain + "'");
  }
  in_terrain.header.frame_id = terrain;
  return in_terrain;
}

RoverCondition condition_named(const std::string& name) {
  const auto found = std::find(std::begin(rover_conditions), std::end(rover_conditions), name);
  return found == std::end(rover_conditions)
             ? RoverCondition::no_terrain
             : static_cast<RoverCondition>(found - std::begin(rover_conditions));
}

GridFrame grid_frame_of(const MapInfo& info) {
  return {static_cast<int>(info.width), static_cast<int>(info.height), info.cell_size, info.origin_x,
          info.origin_y};
}

nav_msgs::Path path_message(const GridPath& path, const std::vector<TimedPoint>& schedule,
                            const LayerMap* elevation, const std::string& frame, const ros::Time& stamp) {
  nav_msgs::Path message;
  message.header.frame_id = frame;
  message.header.stamp = stamp;
  const GridPath points = elevation && schedule.empty() ? resampled(path, elevation->info().cell_size) : path;
  for (std::size_t n = 0; n < points.size(); ++n) {
    geometry_msgs::PoseStamped pose;
    pose.header = message.header;
    if (!schedule.empty()) pose.header.stamp = nearest_time(schedule[n].arrival);
    pose.pose.position.x = points[n].x;
    pose.pose.position.y = points[n].y;
    if (elevation) pose.pose.position.z = elevation->value(points[n].x, points[n].y).value_or(0);
    message.poses.push_back(pose);
  }
  for (std::size_t n = 0; n < points.size(); ++n) {
    const std::size_t a = n + 1 < points.size() || n == 0 ? n : n - 1, b = std::min(a + 1, points.size() - 1);
    const auto &p = message.poses[a].pose.position, &q = message.poses[b].pose.position;
    const double run = elementary::hypot(q.x - p.x, q.y - p.y);
    message.poses[n].pose.orientation =
        run > 0 ? quaternion(-elementary::atan2(q.z - p.z, run), elementary::atan2(q.y - p.y, q.x - p.x))
                : quaternion(0, 0);
  }
  return message;
}

PlannerStatus planner_status_message(const NavigatorStatus& s) {
  PlannerStatus m;
  m.state = navigator_states[static_cast<int>(s.state)];
  m.reason = s.reason;
  m.distance = s.distance;
  m.remaining = s.remaining;
  m.cost = s.cost;
  m.elapsed = s.elapsed;
  m.plans = static_cast<std::uint32_t>(s.plans);
  m.replans = static_cast<std::uint32_t>(s.replans);
  m.last_replan = s.last_replan;
  m.recoveries = static_cast<std::uint32_t>(s.recoveries);
  m.forecast_age = s.forecast_age;
  m.field_differences = s.field_differences;
  return m;
}

ForecastCosts forecast_costs(const Forecast& forecast, double begin, double pace, double probability) {
  const std::size_t moments = forecast.times.size();
  if (moments == 0 || forecast.costs.size() != moments)
    throw ConfigError("forecast: " + std::to_string(forecast.costs.size()) + " maps of costs for " +
                      std::to_string(moments) + " moments");
  const bool ensemble = forecast.members > 1;
  if (ensemble && forecast.probability.size() != moments)
    throw ConfigError("forecast: " + std::to_string(forecast.probability.size()) +
                      " maps of probability for " + std::to_string(moments) + " moments");
  ForecastCosts costs;
  costs.made = begin;
  for (const double time : forecast.times) costs.times.push_back(time * pace);
  costs.frame = grid_frame_of(forecast.costs.front().info);
  for (std::size_t n = 0; n < moments; ++n) {
    const nav_msgs::OccupancyGrid& map = forecast.costs[n];
    if (!(grid_frame_of(map.info) == costs.frame) ||
        map.data.size() != static_cast<std::size_t>(map.info.width) * map.info.height)
      throw ConfigError("forecast: the map of costs of moment " + std::to_string(n) +
                        " has another size or place");
    std::vector<float> values(map.data.size());
    std::transform(map.data.begin(), map.data.end(), values.begin(), traversability_of);
    if (ensemble) {
      const std::vector<float>& share = forecast.probability[n].data;
      if (share.size() != values.size())
        throw ConfigError("forecast: the map of probability of moment " + std::to_string(n) +
                          " has another size");
      for (std::size_t i = 0; i < values.size(); ++i)
        if (!(share[i] >= probability)) values[i] = 0;
    }
    costs.traversability.push_back(std::move(values));
  }
  return costs;
}

}  // namespace desert_sim

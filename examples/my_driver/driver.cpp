/// driver.py in C++: drives to the point ~goal_x, ~goal_y [m], and stops before ground without a way.
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>

#include <algorithm>
#include <cmath>
#include <desert_sim/client/terrain_client.hpp>
#include <optional>

int main(int argc, char** argv) {
  ros::init(argc, argv, "driver");
  ros::NodeHandle node, parameters("~");
  const double goal_x = parameters.param("goal_x", 14.0), goal_y = parameters.param("goal_y", 64.0);
  desert_sim::TerrainClient::Options options;
  options.layers = {"traversability"};
  const desert_sim::TerrainClient terrain(node, options);  // processes messages on a thread of its own
  if (!terrain.wait_for_terrain(60)) return 1;             // wall seconds
  const ros::Publisher drive = node.advertise<geometry_msgs::Twist>("/rover/cmd_vel", 1);
  const auto steer = [&](const nav_msgs::Odometry::ConstPtr& odometry) {
    const auto& [p, q] = odometry->pose.pose;  // place [m] and attitude in the terrain's frame
    const double dx = goal_x - p.x, dy = goal_y - p.y, yaw = 2 * std::atan2(q.z, q.w);
    const double turn = std::remainder(std::atan2(dy, dx) - yaw, 2 * M_PI);
    const std::optional<double> ahead =
        terrain.value("traversability", p.x + std::cos(yaw), p.y + std::sin(yaw));
    geometry_msgs::Twist command;
    if (std::hypot(dx, dy) > 0.4) {
      command.linear.x = 0.3 * ahead.value_or(0) * std::max(0.0, std::cos(turn));
      command.angular.z = turn;
    }
    drive.publish(command);
  };
  const ros::Subscriber poses = node.subscribe<nav_msgs::Odometry>("/rover/ground_truth", 1, steer);
  ros::spin();
}

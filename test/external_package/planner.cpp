/// Plans over the live traversability by Dijkstra's algorithm, and drives it. Parameters: ~goal_x, ~goal_y.
/// What cannot be traversed costs a hundred times as much, so that there is a way out of it for a rover that
/// has cut a corner.
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>

#include <cmath>
#include <desert_sim/client/terrain_client.hpp>
#include <queue>

nav_msgs::Path plan(const desert_sim::LayerMap& ground, double x, double y, double goal_x, double goal_y) {
  const auto begin = ground.cell_of(x, y), end = ground.cell_of(goal_x, goal_y);
  nav_msgs::Path path;
  if (!begin || !end) return path;  // without points: there is no way
  const int width = ground.info().width, height = ground.info().height, start = begin->y * width + begin->x,
            goal = end->y * width + end->x;
  std::vector<double> length(width * height, INFINITY);
  std::vector<int> next(length.size(), -1);
  std::priority_queue<std::pair<double, int>> queue;  // of -length
  queue.push({-(length[goal] = 0), goal});
  for (; !queue.empty() && queue.top().second != start;) {
    const int n = queue.top().second, column = n % width, row = n / width;
    queue.pop();
    for (int v = std::max(0, row - 1); v <= std::min(height - 1, row + 1); ++v)
      for (int u = std::max(0, column - 1), m = v * width + u; u <= std::min(width - 1, column + 1); ++u, ++m)
        if (const double l = length[n] + std::hypot(u - column, v - row) / std::max(0.01f, ground.at(u, v));
            l < length[m])
          next[m] = n, queue.push({-(length[m] = l), m});
  }
  for (int n = start; n >= 0 && length[start] < INFINITY; n = next[n]) {
    path.poses.emplace_back();
    path.poses.back().pose.position = ground.center_of({std::uint32_t(n % width), std::uint32_t(n / width)});
  }
  return path;
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "planner");
  ros::NodeHandle node, parameters("~");
  desert_sim::TerrainClient::Options options;
  options.layers = {"traversability"};
  const desert_sim::TerrainClient terrain(node, options);
  const double goal_x = parameters.param("goal_x", 0.0), goal_y = parameters.param("goal_y", 0.0);
  const auto paths = node.advertise<nav_msgs::Path>("/planner/plan", 1, true);
  const auto commands = node.advertise<geometry_msgs::Twist>("/rover/cmd_vel", 1);
  const auto drive = [&](const nav_msgs::Odometry::ConstPtr& odometry) {
    const auto& [p, q] = odometry->pose.pose;
    const auto ground = terrain.layer_map("traversability");
    const nav_msgs::Path path = ground ? plan(*ground, p.x, p.y, goal_x, goal_y) : nav_msgs::Path();
    paths.publish(path);
    if (path.poses.size() < 2) return;  // there, or no way
    const auto& ahead = path.poses[std::min<std::size_t>(2, path.poses.size() - 1)].pose.position;
    geometry_msgs::Twist command;
    command.angular.z =
        2 * std::remainder(std::atan2(ahead.y - p.y, ahead.x - p.x) - 2 * std::atan2(q.z, q.w), 2 * M_PI);
    command.linear.x = 0.3 * std::pow(std::max(0.0, std::cos(command.angular.z / 2)), 2);
    commands.publish(command);
  };
  const ros::Subscriber poses = node.subscribe<nav_msgs::Odometry>("/rover/ground_truth", 1, drive);
  ros::spin();
}

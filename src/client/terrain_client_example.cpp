/// Example of TerrainClient: prints the elevation at a point whenever the terrain there changes.
///
///     rosrun desert_sim terrain_client_example _x:=40 _y:=25
///
/// Parameters: ~x, ~y [m, in the terrain's frame; default: the middle of the terrain], ~node (desert_sim).
/// A geometry_msgs/PointStamped on ~point, in the terrain's frame, moves the point, for instance to a robot's
/// position. Exit status: 0, or 1 if there is no terrain within ten seconds.
#include <geometry_msgs/PointStamped.h>
#include <ros/ros.h>

#include <cmath>

#include "include/desert_sim/client/terrain_client.hpp"

namespace {

constexpr double degrees = 180 / M_PI;

void print(const desert_sim::ElevationMap& map, double x, double y) {
  const std::optional<double> z = map.elevation(x, y), slope = map.slope(x, y);
  if (z && slope) {
    ROS_INFO("Step %lu: the elevation at (%.2f, %.2f) is %.3f m, the slope is %.1f deg.",
             static_cast<unsigned long>(map.info().step), x, y, *z, *slope * degrees);
  } else {
    ROS_WARN("The point (%.2f, %.2f) is outside the terrain, or its elevation is unknown.", x, y);
  }
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "terrain_client_example");
  ros::NodeHandle node, parameters("~");

  desert_sim::TerrainClient::Options options;
  parameters.param("node", options.node, options.node);
  desert_sim::TerrainClient terrain(node, options);
  if (!terrain.wait_for_terrain(10)) {
    if (!ros::ok()) return 0;
    ROS_ERROR("The node %s sent no terrain within 10 s.", options.node.c_str());
    return 1;
  }

  const desert_sim::ElevationMap::Info first = terrain.map()->info();
  double x = 0, y = 0;
  parameters.param("x", x, first.origin_x + first.width * first.cell_size / 2);
  parameters.param("y", y, first.origin_y + first.height * first.cell_size / 2);
  const ros::Subscriber follow = parameters.subscribe<geometry_msgs::PointStamped>(
      "point", 1, [&](const geometry_msgs::PointStamped::ConstPtr& robot) {
        if (robot->header.frame_id != terrain.map()->info().frame) {
          ROS_WARN(
              "The message on ~point is in the frame '%s', but the terrain is in '%s': transform the point "
              "first.",
              robot->header.frame_id.c_str(), terrain.map()->info().frame.c_str());
          return;
        }
        x = robot->point.x;
        y = robot->point.y;
      });

  std::optional<double> printed;
  for (ros::WallRate rate(10); ros::ok(); rate.sleep()) {
    ros::spinOnce();
    const auto map = terrain.map();  // all queries use the map of one moment
    const std::optional<double> z = map->elevation(x, y);
    if (z && printed && std::abs(*z - *printed) < 1e-3) continue;
    if (z || printed) print(*map, x, y);
    printed = z;
  }
  return 0;
}

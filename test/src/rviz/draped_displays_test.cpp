// The displays that lie on the terrain, and the scale bar, on a screen of Xvfb: seen from above, so that a
// place has one pixel.

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <rviz/properties/status_property.h>
#include <rviz/view_controller.h>
#include <rviz/view_manager.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cmath>
#include <limits>

#include "test/src/rviz/terrain_fixture.hpp"

namespace rviz_test {
namespace {

using rviz::StatusProperty;

constexpr int side = 64;
constexpr double scale = 6;  // [pixels/m]
constexpr float unknown = std::numeric_limits<float>::quiet_NaN();

class DrapedDisplays : public TerrainDisplay {
 protected:
  /// A terrain of 64 x 64 m from above, and an enabled display of `topic` over it.
  rviz::Display* drape(const char* type, const std::string& topic, const Height& height = dunes) {
    terrain_ = show(node_, "/draped", side, height);
    window_->look_from_above(0.5 * side, 0.5 * side, scale);
    rviz::Display* const display = window_->manager().createDisplay(type, "tested", false);
    if (!topic.empty()) display->setTopic(QString::fromStdString(topic), "");
    if (property(display, {"Node"})) set(display, {"Node"}, "/draped");
    display->setEnabled(true);
    EXPECT_TRUE(settles(terrain_));
    window_->run_frames(1);
    return display;
  }
  std::uint32_t pixel(double x, double y) {
    return window_->pixel(static_cast<int>(std::lround(320 + scale * (x - 0.5 * side))),
                          static_cast<int>(std::lround(240 - scale * (y - 0.5 * side))));
  }
  static int red(std::uint32_t pixel) { return static_cast<int>(pixel >> 16); }
  static int green(std::uint32_t pixel) { return static_cast<int>(pixel >> 8 & 255); }
  static int blue(std::uint32_t pixel) { return static_cast<int>(pixel & 255); }
  static bool is_lethal(std::uint32_t pixel) {
    return blue(pixel) > green(pixel) && red(pixel) > green(pixel);
  }

  MadeUpNode node_{"/draped"};
  rviz::Display* terrain_ = nullptr;
  ros::NodeHandle handle_;
};

nav_msgs::OccupancyGrid map_of(int width, int height, std::int8_t cost, const std::string& frame = "map") {
  nav_msgs::OccupancyGrid map;
  map.header.frame_id = frame;
  map.info.resolution = 1;
  map.info.width = static_cast<std::uint32_t>(width);
  map.info.height = static_cast<std::uint32_t>(height);
  map.info.origin.orientation.w = 1;
  map.data.assign(static_cast<std::size_t>(width * height), cost);
  return map;
}

/// The cells of these columns and rows have another cost.
void fill(nav_msgs::OccupancyGrid& map, int x0, int x1, int y0, int y1, std::int8_t cost) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x)
      map.data[static_cast<std::size_t>(y) * map.info.width + static_cast<std::size_t>(x)] = cost;
}

TEST_F(DrapedDisplays, AMapLiesOnTheGroundWhereItsCellsAre) {
  rviz::Display* const display = drape("desert_sim/DrapedMap", "/draped/costmap");
  const std::uint32_t south_west = pixel(10, 10), north_west = pixel(10, 54), east = pixel(50, 20);
  ros::Publisher maps = handle_.advertise<nav_msgs::OccupancyGrid>("/draped/costmap", 1, true);
  ros::Publisher updates = handle_.advertise<map_msgs::OccupancyGridUpdate>("/draped/costmap_updates", 10);
  nav_msgs::OccupancyGrid map = map_of(side, side, 0);
  fill(map, 0, 32, 0, 32, 100);
  maps.publish(map);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "maps") == 1; }));
  window_->run_frames(2);
  EXPECT_TRUE(is_lethal(pixel(10, 10))) << std::hex << pixel(10, 10) << ", without " << south_west;
  EXPECT_TRUE(is_lethal(pixel(30.5, 30.5)));
  EXPECT_EQ(pixel(10, 54), north_west) << "free ground stays as it is";
  EXPECT_EQ(pixel(50, 20), east);
  EXPECT_FALSE(is_lethal(pixel(33.5, 30.5)));

  map_msgs::OccupancyGridUpdate update;
  update.x = 40;
  update.y = 16;
  update.width = 20;
  update.height = 8;
  update.data.assign(160, 100);
  ASSERT_TRUE(window_->run_until([&] { return updates.getNumSubscribers() > 0; }));
  updates.publish(update);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "updates") == 1; }));
  window_->run_frames(2);
  EXPECT_TRUE(is_lethal(pixel(50, 20)));
  EXPECT_FALSE(is_lethal(pixel(50, 26)));

  // The ground moves, and the map with it: no map is sent again.
  const double built = number(terrain_, "built_blocks");
  node_.update(0, 0, side, side, [](int x, int y) { return 5 - dunes(x, y); });
  ASSERT_TRUE(settles(terrain_, [&] { return number(terrain_, "built_blocks") > built; }));
  window_->run_frames(2);
  for (const double x : {42.5, 46.5, 50.5, 54.5, 58.5}) EXPECT_TRUE(is_lethal(pixel(x, 20))) << x;

  display->setEnabled(false);
  window_->run_frames(2);
  EXPECT_FALSE(is_lethal(pixel(10, 10)));
  display->setEnabled(true);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "maps") == 1; }));
  window_->remove(terrain_);
  window_->run_frames(3);
  EXPECT_EQ(status(display, "Ground").level, StatusProperty::Error) << status(display, "Ground").text;
  terrain_ = show(node_, "/draped", side);
  window_->look_from_above(0.5 * side, 0.5 * side, scale);
  window_->run_frames(3);
  EXPECT_TRUE(is_lethal(pixel(10, 10))) << "it lies on the ground that came back";
}

TEST_F(DrapedDisplays, AMapIsPlacedByItsFrameAndSaysWhatIsMissing) {
  rviz::Display* const display = window_->manager().createDisplay("desert_sim/DrapedMap", "tested", false);
  display->setTopic("/draped/moved", "");
  display->setEnabled(true);
  EXPECT_TRUE(window_->run_until([&] { return status(display, "Ground").level == StatusProperty::Error; }));
  EXPECT_NE(status(display, "Ground").text.find("add one"), std::string::npos);
  window_->remove(display);
  rviz::Display* const again = drape("desert_sim/DrapedMap", "/draped/moved");
  EXPECT_EQ(status(again, "Ground").level, StatusProperty::Ok);
  EXPECT_NE(status(again, "Topic").text.find("Nobody publishes /draped/moved"), std::string::npos)
      << status(again, "Topic").text;
  ros::Publisher maps = handle_.advertise<nav_msgs::OccupancyGrid>("/draped/moved", 1, true);
  maps.publish(map_of(12, 12, 100, "costs"));
  EXPECT_TRUE(window_->run_until([&] { return status(again, "Transform").level == StatusProperty::Error; }));
  EXPECT_NE(status(again, "Transform").text.find("the map's frame [costs]"), std::string::npos);
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped t;
  t.header.frame_id = "map";
  t.header.stamp = ros::Time::now();
  t.child_frame_id = "costs";
  t.transform.rotation.z = t.transform.rotation.w = std::sqrt(0.5);  // its east is the north
  t.transform.translation.x = 40;
  t.transform.translation.y = 30;
  broadcaster.sendTransform(t);
  EXPECT_TRUE(window_->run_until([&] { return status(again, "Transform").level == StatusProperty::Ok; }));
  window_->run_frames(2);
  EXPECT_TRUE(is_lethal(pixel(34, 36)));
  EXPECT_FALSE(is_lethal(pixel(46, 36)));
  EXPECT_FALSE(is_lethal(pixel(34, 24)));
}

TEST_F(DrapedDisplays, MapsThatAreNoneAreRefused) {
  rviz::Display* const display = drape("desert_sim/DrapedMap", "/draped/bad");
  ros::Publisher maps = handle_.advertise<nav_msgs::OccupancyGrid>("/draped/bad", 1, true);
  ros::Publisher updates = handle_.advertise<map_msgs::OccupancyGridUpdate>("/draped/bad_updates", 10);
  const auto refused = [&](const std::string& why) {
    return window_->run_until([&] { return status(display, "Topic").text.find(why) != std::string::npos; });
  };
  nav_msgs::OccupancyGrid map = map_of(8, 8, 100);
  map.data.pop_back();
  maps.publish(map);
  EXPECT_TRUE(refused("8 x 8 cells has 63 costs")) << status(display, "Topic").text;
  map = map_of(8, 0, 100);
  maps.publish(map);
  EXPECT_TRUE(refused("8 x 0 cells cannot be drawn")) << status(display, "Topic").text;
  for (const float resolution : {0.0F, -1.0F, unknown, 3e38F}) {
    map = map_of(8, 8, 100);
    map.info.resolution = resolution;
    maps.publish(map);
    EXPECT_TRUE(refused("resolution")) << resolution;
    maps.publish(map_of(8, 8, 100));
    EXPECT_TRUE(window_->run_until([&] { return status(display, "Topic").level == StatusProperty::Ok; }));
  }
  map = map_of(8, 8, 100);
  map.info.origin.position.x = static_cast<double>(unknown);
  maps.publish(map);
  EXPECT_TRUE(refused("is no place")) << status(display, "Topic").text;
  map = map_of(8, 8, 100);
  map.info.origin.orientation.w = 0;
  maps.publish(map);
  EXPECT_TRUE(refused("quaternion")) << status(display, "Topic").text;
  maps.publish(map_of(8, 8, -1));
  ASSERT_TRUE(window_->run_until([&] {
    return status(display, "Topic").level == StatusProperty::Ok && updates.getNumSubscribers() > 0;
  }));
  map_msgs::OccupancyGridUpdate update;
  update.x = 2147483647;
  update.width = update.height = 1;
  update.data.assign(1, 0);
  updates.publish(update);
  EXPECT_TRUE(refused("is not one of a map of 8 x 8 cells")) << status(display, "Topic").text;
  window_->run_frames(2);
}

nav_msgs::Path path_of(const std::vector<std::pair<double, double>>& places) {
  nav_msgs::Path path;
  path.header.frame_id = "map";
  for (const auto& [x, y] : places) {
    geometry_msgs::PoseStamped pose;
    pose.pose.position.x = x;
    pose.pose.position.y = y;
    path.poses.push_back(pose);
  }
  return path;
}

TEST_F(DrapedDisplays, APathLiesOnTheGroundAndFollowsIt) {
  rviz::Display* const display = drape("desert_sim/DrapedPath", "/draped/path");
  set(display, {"Colour"}, QColor(0, 0, 255));
  ros::Publisher paths = handle_.advertise<nav_msgs::Path>("/draped/path", 1, true);
  paths.publish(path_of({{5, 32}, {59, 32}}));
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 2; }));
  window_->run_frames(2);
  for (double x = 6; x < 59; x += 3) EXPECT_EQ(pixel(x, 32), 0x0000ffu) << x << ": over hills and hollows";
  EXPECT_NE(pixel(32, 36), 0x0000ffu);
  const double built = number(display, "built_lines");
  window_->run_frames(5);
  EXPECT_EQ(number(display, "built_lines"), built) << "nothing has changed";
  node_.update(0, 0, side, side, [](int x, int y) { return 20 - dunes(x, y); });
  ASSERT_TRUE(settles(terrain_, [&] { return number(display, "built_lines") > built; }));
  window_->run_frames(2);
  for (double x = 6; x < 59; x += 3) EXPECT_EQ(pixel(x, 32), 0x0000ffu) << x << ": the ground has risen";
  paths.publish(path_of({}));
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 0; }));
  window_->run_frames(2);
  EXPECT_NE(pixel(30, 32), 0x0000ffu) << "an empty path is none";
}

TEST_F(DrapedDisplays, PathsThatNoDesertHasEndNothing) {
  rviz::Display* const display = drape("desert_sim/DrapedPath", "/draped/hostile",
                                       [](int x, int y) { return x > 40 ? unknown : dunes(x, y); });
  set(display, {"Colour"}, QColor(0, 0, 255));
  ros::Publisher paths = handle_.advertise<nav_msgs::Path>("/draped/hostile", 1, true);
  const auto nothing = static_cast<double>(unknown);
  paths.publish(path_of({{5, 32}, {nothing, 3}, {1e300, 4}, {20, 32}, {60, 32}}));
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 5; }));
  window_->run_frames(3);
  EXPECT_EQ(pixel(12, 32), 0x0000ffu);
  EXPECT_NE(pixel(50, 32), 0x0000ffu) << "where the ground is not known there is no line";
  paths.publish(path_of({{5, 32}, {-1e7, 3e6}, {5e6, 32}, {60, 32}, {60, 32}, {-1e6, 32}, {6, 7}}));
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 7; }));
  window_->run_frames(3);
}

TEST_F(DrapedDisplays, AnOdometryLeavesItsWayAndBeginsAnewElsewhere) {
  rviz::Display* const display = drape("desert_sim/DrapedOdometry", "/draped/odom");
  set(display, {"Colour"}, QColor(255, 255, 0));
  set(display, {"Position Tolerance"}, 0.5);
  ros::Publisher odometry = handle_.advertise<nav_msgs::Odometry>("/draped/odom", 1000);
  ASSERT_TRUE(window_->run_until([&] { return odometry.getNumSubscribers() > 0; }));
  const ros::Time begin(100);
  const auto go = [&](double x, double y, double seconds) {
    nav_msgs::Odometry message;
    message.header.frame_id = "map";
    message.header.stamp = begin + ros::Duration(seconds);
    message.pose.pose.position.x = x;
    message.pose.pose.position.y = y;
    odometry.publish(message);
  };
  for (int n = 0; n <= 80; ++n) go(10 + 0.25 * n, 20, n);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 41; })) << "every other one";
  window_->run_frames(2);
  EXPECT_EQ(pixel(20, 20), 0xffff00u);
  for (int n = 0; n <= 10; ++n) go(50, 40 + n, 200 + n);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 11; })) << "it was put elsewhere";
  for (int n = 0; n <= 5; ++n) go(50, 50 + n, n);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 6; })) << "the time went back";
  set(display, {"Keep"}, 3);
  go(50, 56, 300);
  ASSERT_TRUE(window_->run_until([&] { return number(display, "points") == 3; }));
}

TEST_F(DrapedDisplays, TheScaleBarFollowsTheCamera) {
  rviz::Display* const display = window_->manager().createDisplay("desert_sim/ScaleBar", "Scale", true);
  const auto says = [&](const std::string& length, double pixels, double north) {
    return window_->run_until([&] {
      window_->manager().queueRender();
      return display->property("length").toString().toStdString() == length &&
             std::abs(number(display, "bar_pixels") - pixels) < 0.02 * pixels &&
             std::abs(number(display, "north_degrees") - north) < 1.5;
    });
  };
  const auto said = [&] {
    return display->property("length").toString().toStdString() + ", " +
           std::to_string(number(display, "bar_pixels")) + " pixels, north at " +
           std::to_string(number(display, "north_degrees"));
  };
  window_->look_from_above(0, 0, 7.9);
  EXPECT_TRUE(says("20 m", 158, 0)) << said();
  window_->look_from_above(1000, 500, 0.3);
  EXPECT_TRUE(says("500 m", 150, 0)) << said();
  window_->look_at(100);  // rviz's cameras see 45 degrees of height
  const double pixels_per_metre = 240 / std::tan(3.14159265 / 8) / 110;
  rviz::ViewController* const view = window_->manager().getViewManager()->getCurrent();
  view->subProp("Yaw")->setValue(3.14159265);  // it stands in the west
  EXPECT_TRUE(says("20 m", 20 * pixels_per_metre, -90)) << said();
  view->subProp("Yaw")->setValue(-1.5707963);
  EXPECT_TRUE(says("20 m", 20 * pixels_per_metre, 0)) << said();
  view->subProp("Distance")->setValue(11);
  EXPECT_TRUE(says("2 m", 20 * pixels_per_metre, 0)) << said();
  set(display, {"North Frame"}, "no_frame");
  EXPECT_TRUE(window_->run_until([&] {
    window_->manager().queueRender();
    return status(display, "Transform").level == StatusProperty::Error;
  }));
}

}  // namespace
}  // namespace rviz_test

int main(int argc, char** argv) { return rviz_test::run_terrain_tests(argc, argv, "draped_displays_test"); }

/// Programs that others wrote on our GridMaps: grid_map's converter and its visualiser say of the terrain
/// what ~query_terrain and ~elevation say. The node is paused on corner.yaml: a marker of sand near the
/// south-east corner.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/QueryTerrain.h>
#include <grid_map_msgs/GetGridMap.h>
#include <nav_msgs/GridCells.h>
#include <nav_msgs/OccupancyGrid.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/Marker.h>

#include <cmath>
#include <grid_map_ros/grid_map_ros.hpp>
#include <set>
#include <utility>

#include "test/support/ros/client.hpp"

namespace {

using namespace desert_sim;
using grid_map::Position;
using node_test::call;
using node_test::Listener;
using Place = std::pair<double, double>;

constexpr double flat = 1.5, top = 7.5;             // heights [m]
constexpr double west = 10, south = -20, cell = 2;  // of the terrain [m]
const Position marker_centre(126, -9),
    beside(122.6, -7);  // `beside`: between the marker and its surroundings

bool in_marker(double x, double y) { return x > 122 && x < 130 && y > -12 && y < -6; }
double height(double x, double y) { return in_marker(x, y) ? top : flat; }

/// What grid_map makes of the last message of a topic of GridMaps.
grid_map::GridMap converted(const grid_map_msgs::GridMap& message) {
  grid_map::GridMap map;
  EXPECT_TRUE(grid_map::GridMapRosConverter::fromMessage(message, map));
  return map;
}
grid_map::GridMap whole_map() { return converted(Listener<grid_map_msgs::GridMap>("grid_map").last()); }

QueryTerrain::Response query(const std::vector<Position>& places) {
  QueryTerrain::Request request;
  for (const Position& place : places) {
    request.points.emplace_back();
    request.points.back().x = place.x();
    request.points.back().y = place.y();
  }
  const QueryTerrain::Response response = call<QueryTerrain>("query_terrain", request);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.samples.size(), places.size());
  return response;
}

void expect_geometry(const grid_map::GridMap& map, int along_x, int along_y, double x, double y) {
  EXPECT_EQ(map.getFrameId(), "terrain");
  EXPECT_GT(map.getTimestamp(), 0u);
  EXPECT_EQ(map.getResolution(), cell);
  EXPECT_EQ(map.getSize()(0), along_x);
  EXPECT_EQ(map.getSize()(1), along_y);
  EXPECT_EQ(map.getLength().x(), along_x * cell);
  EXPECT_EQ(map.getLength().y(), along_y * cell);
  EXPECT_NEAR(map.getPosition().x(), x, 1e-9);
  EXPECT_NEAR(map.getPosition().y(), y, 1e-9);
  EXPECT_TRUE(map.getStartIndex().isZero());
  EXPECT_EQ(map.getBasicLayers(), std::vector<std::string>{"elevation"});
}

/// Elevations by place, as the simulator's own keyframe has them.
std::map<Place, double> own_elevation() {
  const ElevationGrid grid = Listener<ElevationGrid>("elevation").last();
  std::map<Place, double> found;
  for (std::size_t i = 0; i < grid.elevation.size(); ++i)
    found[{grid.origin.position.x + (static_cast<double>(i % grid.width) + 0.5) * grid.cell_size,
           grid.origin.position.y + (static_cast<double>(i / grid.width) + 0.5) * grid.cell_size}] =
        grid.elevation[i];
  EXPECT_EQ(found.size(), 64u * 48u);
  return found;
}

/// What a visualiser shows, once.
template <class Message>
Message shown(const std::string& topic) {
  return Listener<Message>(topic).last();
}

std::map<Place, double> points_of(const sensor_msgs::PointCloud2& cloud) {
  EXPECT_EQ(cloud.header.frame_id, "terrain");
  std::map<Place, double> found;
  for (sensor_msgs::PointCloud2ConstIterator<float> at(cloud, "x"); at != at.end(); ++at)
    found[{at[0], at[1]}] = at[2];
  return found;
}

// ---- grid_map's own classes

TEST(GridMapConverter, ReadsEveryCellOfTheWholeTerrain) {
  const grid_map::GridMap map = whole_map();
  expect_geometry(map, 64, 48, west + 64, south + 48);
  EXPECT_EQ(map.getLayers(),
            (std::vector<std::string>{"elevation", "sand_depth", "wind_x", "wind_y", "slope",
                                      "traversability", "normal_x", "normal_y", "normal_z"}));
  std::size_t cells = 0;
  for (grid_map::GridMapIterator at(map); !at.isPastEnd(); ++at, ++cells) {
    Position place;
    ASSERT_TRUE(map.getPosition(*at, place));
    ASSERT_TRUE(map.isValid(*at));
    ASSERT_FLOAT_EQ(map.at("elevation", *at), static_cast<float>(height(place.x(), place.y())))
        << place.transpose();
  }
  EXPECT_EQ(cells, 64u * 48u);
}

TEST(GridMapConverter, SaysWhatQueryTerrainSays) {
  const grid_map::GridMap map = whole_map();
  const std::vector<Position> centres = {
      {127, -9},                                     // in the marker
      {121, -9}, {131, -9},  {125, -13}, {125, -5},  // at its four feet
      {11, -19}, {137, -19}, {11, 75},   {137, 75},  // the terrain's corners
      {51, 41}};
  const QueryTerrain::Response answer = query(centres);
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const TerrainSample& sample = answer.samples[i];
    SCOPED_TRACE(centres[i].transpose());
    EXPECT_NEAR(map.atPosition("elevation", centres[i]), sample.elevation, 1e-5);
    EXPECT_NEAR(map.atPosition("sand_depth", centres[i]), sample.sand, 1e-5);
    EXPECT_NEAR(map.atPosition("wind_x", centres[i]), sample.wind.x, 1e-5);
    EXPECT_NEAR(map.atPosition("wind_y", centres[i]), sample.wind.y, 1e-5);
  }
}

TEST(GridMapConverter, ReadsVectorsThatFitTheSlope) {
  const grid_map::GridMap map = whole_map();
  for (grid_map::GridMapIterator at(map); !at.isPastEnd(); ++at) {
    Eigen::Vector3d normal;
    ASSERT_TRUE(map.getVector("normal_", *at, normal));
    ASSERT_NEAR(normal.norm(), 1, 1e-5);
    ASSERT_NEAR(map.at("slope", *at), std::atan2(normal.head(2).norm(), normal.z()), 1e-5);
  }
}

TEST(GridMapConverter, InterpolatesAsQueryTerrainDoes) {
  const grid_map::GridMap map = whole_map();
  // All but the last on the marker's flanks.
  const std::vector<Position> places = {beside,         {121.7, -8.1}, {130.4, -11.2},
                                        {124.3, -12.4}, {127.9, -5.3}, {60.3, 11.8}};
  const QueryTerrain::Response answer = query(places);
  std::size_t slanting = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double z = answer.samples[i].elevation;
    EXPECT_NEAR(map.atPosition("elevation", places[i], grid_map::InterpolationMethods::INTER_LINEAR), z, 1e-4)
        << places[i].transpose();
    slanting += z > flat + 0.1 && z < top - 0.1;
  }
  EXPECT_EQ(slanting, 5u) << "places where the order of the cells matters";
}

TEST(GridMapConverter, ASubmapIsTheOneThatItCutsItself) {
  const Position centre(124, -8);
  const grid_map::Length length(15.8, 11.8);  // a little less than 8 x 6 cells: no edge of a cell is in doubt
  bool cut = false;
  const grid_map::GridMap expected = whole_map().getSubmap(centre, length, cut);
  ASSERT_TRUE(cut);
  grid_map_msgs::GetGridMap::Request request;
  request.position_x = centre.x();
  request.position_y = centre.y();
  request.length_x = length.x();
  request.length_y = length.y();
  request.layers = {"elevation", "traversability"};
  const grid_map::GridMap map = converted(call<grid_map_msgs::GetGridMap>("get_grid_map", request).map);
  expect_geometry(map, 8, 6, expected.getPosition().x(), expected.getPosition().y());
  ASSERT_EQ((map.getSize() - expected.getSize()).matrix().norm(), 0);
  EXPECT_EQ(map.getLayers(), request.layers);
  for (const std::string& layer : request.layers) EXPECT_EQ(map.get(layer), expected.get(layer)) << layer;
  EXPECT_FLOAT_EQ(map.atPosition("elevation", marker_centre), static_cast<float>(top));
}

/// Gives the robot a place; it overhangs the south-east corner of the terrain.
class LocalMap : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    static tf2_ros::StaticTransformBroadcaster frames;
    geometry_msgs::TransformStamped robot;
    robot.header.stamp = ros::Time::now();
    robot.header.frame_id = "terrain";
    robot.child_frame_id = "robot";
    robot.transform.translation.x = 132.2;
    robot.transform.translation.y = -15.9;
    robot.transform.rotation.w = 1;
    frames.sendTransform(robot);
  }
  static bool on_terrain(double x, double y) { return x < west + 64 * cell && y > south; }
};

TEST_F(LocalMap, HasNoValidCellsBeyondTheEdge) {
  const grid_map::GridMap map = converted(Listener<grid_map_msgs::GridMap>("local_map").last());
  expect_geometry(map, 10, 6, 132, -16);
  EXPECT_EQ(map.getLayers(), (std::vector<std::string>{"traversability", "elevation"}));
  std::size_t beyond = 0;
  for (grid_map::GridMapIterator at(map); !at.isPastEnd(); ++at) {
    Position place;
    map.getPosition(*at, place);
    EXPECT_EQ(map.isValid(*at), on_terrain(place.x(), place.y())) << place.transpose();
    if (map.isValid(*at)) {
      EXPECT_FLOAT_EQ(map.at("elevation", *at), static_cast<float>(height(place.x(), place.y())));
    } else {
      ++beyond;
    }
  }
  EXPECT_EQ(beyond, 2u * 6u + 1u * 8u);
}

TEST_F(LocalMap, IsShownWithoutWhatIsUnknown) {
  const std::map<Place, double> points = points_of(shown<sensor_msgs::PointCloud2>("/local/surface"));
  EXPECT_EQ(points.size(), 8u * 5u);
  for (const auto& [place, z] : points) {
    EXPECT_TRUE(on_terrain(place.first, place.second));
    EXPECT_FLOAT_EQ(static_cast<float>(z), static_cast<float>(height(place.first, place.second)));
  }
  const nav_msgs::OccupancyGrid grid = shown<nav_msgs::OccupancyGrid>("/local/height");
  ASSERT_EQ(grid.data.size(), 10u * 6u);
  for (std::size_t i = 0; i < grid.data.size(); ++i) {
    const double x = grid.info.origin.position.x + (static_cast<double>(i % 10) + 0.5) * cell,
                 y = grid.info.origin.position.y + (static_cast<double>(i / 10) + 0.5) * cell;
    EXPECT_EQ(grid.data[i], on_terrain(x, y) ? static_cast<int>(10 * height(x, y)) : -1) << x << ' ' << y;
  }
}

// ---- grid_map's visualiser

TEST(GridMapVisualization, ItsPointsAreOurElevation) {
  const std::map<Place, double> points = points_of(shown<sensor_msgs::PointCloud2>("/whole/surface"));
  EXPECT_EQ(points, own_elevation());
}

TEST(GridMapVisualization, ItsOccupancyGridLiesAsOurElevationDoes) {
  const ElevationGrid own = Listener<ElevationGrid>("elevation").last();
  const nav_msgs::OccupancyGrid grid = shown<nav_msgs::OccupancyGrid>("/whole/height");
  ASSERT_EQ(grid.info.width, own.width);
  ASSERT_EQ(grid.info.height, own.height);
  EXPECT_EQ(grid.info.resolution, static_cast<float>(own.cell_size));
  EXPECT_EQ(grid.info.origin.position.x, own.origin.position.x);
  EXPECT_EQ(grid.info.origin.position.y, own.origin.position.y);
  ASSERT_EQ(grid.data.size(), own.elevation.size());
  for (std::size_t i = 0; i < grid.data.size(); ++i)
    ASSERT_EQ(grid.data[i], static_cast<int>(10 * own.elevation[i])) << i;
}

TEST(GridMapVisualization, NormalsLeanAwayFromTheMarker) {
  const visualization_msgs::Marker marker = shown<visualization_msgs::Marker>("/whole/normals");
  ASSERT_EQ(marker.points.size(), 2u * 64u * 48u);
  std::map<Place, Position> leaning;
  for (std::size_t i = 0; i < marker.points.size(); i += 2)
    leaning[{marker.points[i].x, marker.points[i].y}] = {marker.points[i + 1].x - marker.points[i].x,
                                                         marker.points[i + 1].y - marker.points[i].y};
  const double most = 2 * std::sin(std::atan(6.0 / 4));  // scale 2; 6 m over two cells
  EXPECT_NEAR((leaning.at({121, -9}) - Position(-most, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((leaning.at({131, -9}) - Position(most, 0)).norm(), 0, 1e-5);
  EXPECT_NEAR((leaning.at({125, -13}) - Position(0, -most)).norm(), 0, 1e-5);
  EXPECT_NEAR((leaning.at({125, -5}) - Position(0, most)).norm(), 0, 1e-5);
  EXPECT_NEAR(leaning.at({51, 41}).norm(), 0, 1e-5);
}

TEST(GridMapVisualization, CellsWithoutAWayAreThoseAtTheMarker) {
  const nav_msgs::GridCells shown_cells = shown<nav_msgs::GridCells>("/whole/no_way");
  EXPECT_EQ(shown_cells.cell_width, static_cast<float>(cell));
  ASSERT_GT(shown_cells.cells.size(), 4u * 3u);
  for (const geometry_msgs::Point& at : shown_cells.cells)  // the rover's radius and a cell around the marker
    EXPECT_TRUE(at.x > 116 && at.x < 136 && at.y > -18 && at.y < 0) << at.x << ' ' << at.y;
}

TEST(GridMapVisualization, ItsRegionIsTheTerrain) {
  const visualization_msgs::Marker region = shown<visualization_msgs::Marker>("/whole/region");
  std::set<Place> corners;
  for (const geometry_msgs::Point& at : region.points) corners.insert({at.x, at.y});
  EXPECT_EQ(corners, (std::set<Place>{{10, -20}, {138, -20}, {10, 76}, {138, 76}}));
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "grid_map_clients"); }

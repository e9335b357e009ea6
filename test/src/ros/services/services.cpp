/// ~edit_terrain and ~query_terrain, on a paused node with the scenario corner.yaml. A refused request
/// changes nothing: the state hash stays, and the message names the value and what is allowed.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/QueryTerrain.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <cmath>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

QueryTerrain::Response query(double x, double y, const std::string& frame = "") {
  QueryTerrain::Request request;
  request.header.frame_id = frame;
  request.points.resize(1);
  request.points[0].x = x;
  request.points[0].y = y;
  return call<QueryTerrain>("query_terrain", request);
}

/// A circle of 5 m on the sand at (50, 30), a metre high.
EditTerrain::Request a_brush() {
  EditTerrain::Request request;
  request.layer = "sand";
  request.shape = "circle";
  request.merge = "add";
  request.center.x = 50;
  request.center.y = 30;
  request.radius = 5;
  request.inner = 1;
  request.value = 1;
  return request;
}

TEST_F(Services, ACircleAddsItsVolume) {
  const EditTerrain::Response response = call<EditTerrain>("edit_terrain", a_brush());
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_NEAR(response.volume, 3.14159 * 25, 16);  // in cells of 4 m²
  EXPECT_LE(response.x, 17u);                      // (50 − 10) / 2 = 20 cells, ± 2.5
  EXPECT_GE(response.x + response.width, 22u);
  EXPECT_LE(response.width, 8u);
  EXPECT_LE(response.y, 22u);  // (30 + 20) / 2 = 25
  EXPECT_GE(response.y + response.height, 27u);
  EXPECT_LE(response.height, 8u);
  EXPECT_NEAR(query(51, 31).samples.at(0).sand, 1.5, 1e-5);
  EXPECT_NEAR(query(51, 41).samples.at(0).sand, 0.5, 1e-5);
}

TEST_F(Services, EveryMergeDoesWhatItSays) {
  const struct {
    const char* merge;
    double value, sand;
  } cases[] = {{"add", 1, 1.5}, {"sub", 0.2, 0.3}, {"sub", 9, 0},     {"replace", 3, 3}, {"min", 0.1, 0.1},
               {"min", 2, 0.5}, {"max", 2, 2},     {"max", 0.1, 0.5}, {"avg", 1.5, 1}};
  for (const auto& c : cases) {
    ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
    EditTerrain::Request request = a_brush();
    request.merge = c.merge;
    request.value = c.value;
    const EditTerrain::Response response = call<EditTerrain>("edit_terrain", request);
    EXPECT_TRUE(response.success) << response.message;
    EXPECT_NEAR(query(51, 31).samples.at(0).sand, c.sand, 1e-5) << c.merge << " " << c.value;
    EXPECT_EQ(response.volume > 0, c.sand > 0.5) << c.merge << " " << c.value;
  }
}

TEST_F(Services, BedrockIsAnElevation) {
  EditTerrain::Request request = a_brush();
  request.layer = "bedrock";
  request.merge = "replace";
  request.value = 4;
  EXPECT_TRUE(call<EditTerrain>("edit_terrain", request).success);
  const TerrainSample sample = query(51, 31).samples.at(0);
  EXPECT_NEAR(sample.bedrock, 4, 1e-5);
  EXPECT_NEAR(sample.elevation, 4.5, 1e-5);
}

TEST_F(Services, AnEllipseLiesAlongItsAngle) {
  EditTerrain::Request request = a_brush();
  request.shape = "ellipse";
  request.radius = 20;
  request.radius_y = 5;
  request.angle_deg = 90;
  EXPECT_TRUE(call<EditTerrain>("edit_terrain", request).success);
  EXPECT_GT(query(51, 45).samples.at(0).sand, 0.6) << "north of the centre";
  EXPECT_NEAR(query(65, 31).samples.at(0).sand, 0.5, 1e-5) << "east of it";
}

TEST_F(Services, EditTerrainRefuses) {
  const auto refused = [](const std::function<void(EditTerrain::Request&)>& spoil, const std::string& what,
                          const std::string& allowed) {
    EditTerrain::Request request = a_brush();
    spoil(request);
    expect_refused<EditTerrain>("edit_terrain", request, what, allowed);
  };
  refused([](auto& r) { r.layer = "lava"; }, "'lava'", "sand, bedrock");
  refused([](auto& r) { r.shape = "star"; }, "'star'", "circle, ellipse");
  refused([](auto& r) { r.merge = "xor"; }, "'xor'", "add, sub, replace, min, max, avg");
  refused([](auto& r) { r.merge = ""; }, "merge: ''", "add, sub");
  refused([](auto& r) { r.radius = -5; }, "radius: -5", "m");
  refused([](auto& r) { r.radius = 0; }, "radius: 0", "m");
  refused([](auto& r) { r.radius = not_a_number; }, "radius: nan", "m");
  refused([](auto& r) { r.radius = infinity; }, "radius: inf", "m");
  refused([](auto& r) { r.center.x = not_a_number; }, "center.x: nan", "finite");
  refused([](auto& r) { r.center.z = infinity; }, "center.z: inf", "finite");
  refused([](auto& r) { r.inner = 2; }, "inner: 2", "[0, 1]");
  refused([](auto& r) { r.value = not_a_number; }, "value: nan", "m");
  refused([](auto& r) { r.value = -1; }, "value", "depth");
  refused(
      [](auto& r) {
        r.shape = "ellipse";
        r.radius_y = 1;
        r.angle_deg = not_a_number;
      },
      "angle_deg: nan", "finite");
  refused([](auto& r) { r.angle_deg = 30; }, "angle_deg: is set", "shape 'circle'");
  refused([](auto& r) { r.center.x = 5000; }, "5000", "no cell");
  refused([](auto& r) { r.header.frame_id = "nowhere"; }, "'nowhere'", "'terrain'");
  refused([](auto& r) { r.shape = "ellipse"; }, "radius_y: 0", "m");
  refused([](auto& r) { r.value = 90000; }, "value", "allowed");
}

TEST_F(Services, QueryTerrainTellsWhatIsThere) {
  QueryTerrain::Request request;
  request.points.resize(3);
  request.points[0].x = 126;  // on the marker
  request.points[0].y = -9;
  request.points[1].x = 40;
  request.points[1].y = 40;
  request.points[2].x = 9;  // west of the grid
  request.points[2].y = 0;
  const QueryTerrain::Response response = call<QueryTerrain>("query_terrain", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.header.frame_id, "terrain");
  ASSERT_EQ(response.samples.size(), 3u);
  const TerrainSample &marker = response.samples[0], &plain = response.samples[1], &off = response.samples[2];
  EXPECT_TRUE(marker.in_bounds);
  EXPECT_NEAR(marker.elevation, 7.5, 1e-5);
  EXPECT_NEAR(marker.sand, 6.5, 1e-5);
  EXPECT_NEAR(plain.elevation, 1.5, 1e-5);
  EXPECT_NEAR(plain.bedrock, 1, 1e-5);
  EXPECT_NEAR(plain.normal.z, 1, 1e-6);
  EXPECT_NEAR(plain.slope, 0, 1e-6);
  EXPECT_EQ(plain.position.z, plain.elevation);
  EXPECT_FALSE(off.in_bounds);
  EXPECT_TRUE(std::isnan(off.elevation));
}

TEST_F(Services, SlopesAndNormalsPointTheRightWay) {
  // Between the marker's western edge (7.5 m) and the plain (1.5 m): centres at x = 123 and 121.
  const TerrainSample sample = query(122, -9).samples.at(0);
  EXPECT_NEAR(sample.elevation, 4.5, 1e-4);
  EXPECT_NEAR(sample.slope, std::atan(3.0), 1e-4);
  EXPECT_LT(sample.normal.x, -0.9) << "it faces west";
  EXPECT_NEAR(sample.normal.y, 0, 1e-6);
}

TEST_F(Services, QueriesAndEditsComeFromOtherFrames) {
  static tf2_ros::StaticTransformBroadcaster broadcaster;
  broadcaster.sendTransform(rover_frame());
  ASSERT_TRUE(wait_until([] { return query(0, 0, "rover").success != 0; }));

  EditTerrain::Request request = a_brush();
  request.header.frame_id = "rover";
  request.shape = "ellipse";
  request.center.x = 10;  // ahead, which is north
  request.center.y = 0;
  request.radius = 12;
  request.radius_y = 4;
  request.angle_deg = 0;  // along the rover's view
  const EditTerrain::Response response = call<EditTerrain>("edit_terrain", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_GT(query(51, 47).samples.at(0).sand, 0.9);
  EXPECT_NEAR(query(59, 41).samples.at(0).sand, 0.5, 1e-5);
  const TerrainSample ahead = query(17, -1, "rover").samples.at(0);
  EXPECT_NEAR(ahead.position.x, 51, 1e-6);
  EXPECT_NEAR(ahead.position.y, 47, 1e-6);
  EXPECT_EQ(ahead.sand, query(51, 47).samples.at(0).sand);
}

TEST_F(Services, QueryTerrainRefuses) {
  QueryTerrain::Request request;
  request.points.resize(2);
  request.points[1].y = not_a_number;
  expect_refused<QueryTerrain>("query_terrain", request, "points[1].y: nan", "finite");
  request.points[1].y = 0;
  request.header.frame_id = "nowhere";
  // An answer at all: this frame never comes. How long the node waits for it, services_timing.cpp says.
  expect_refused<QueryTerrain>("query_terrain", request, "'nowhere'", "'terrain'");
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "services"); }

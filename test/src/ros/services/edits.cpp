/// ~edit_terrain's shapes, merges, rings, frames and refusals, and ~terrain_diff, on a paused node with the
/// scenario corner.yaml (64 × 48 cells of 2 m, corner at (10, −20), half a metre of sand, open edges).
#include <desert_sim/EditTerrain.h>
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/TerrainDiff.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;
using Edits = Services;

double sand(double x, double y) {
  QueryTerrain::Request request;
  request.points.resize(1);
  request.points[0].x = x;
  request.points[0].y = y;
  return call<QueryTerrain>("query_terrain", request).samples.at(0).sand;
}

EditTerrain::Response edit(const EditTerrain::Request& request) {
  const auto response = call<EditTerrain>("edit_terrain", request);
  EXPECT_TRUE(response.success) << response.message;
  return response;
}

geometry_msgs::Point point(double x, double y) {
  geometry_msgs::Point p;
  p.x = x;
  p.y = y;
  return p;
}

/// A metre of sand around (50, 30).
EditTerrain::Request a_shape(const std::string& shape) {
  EditTerrain::Request request;
  request.layer = "sand";
  request.shape = shape;
  request.merge = "add";
  request.value = 1;
  const bool by_points = shape == "polygon" || shape == "capsule";
  if (!by_points) {
    request.center = point(50, 30);
    request.radius = 10;
  }
  if (!by_points && shape != "circle") request.radius_y = 4;
  if (shape != "polygon" && shape != "patch") request.inner = 1;
  return request;
}

sensor_msgs::Image an_image(const std::string& encoding, std::uint32_t width, std::uint32_t height,
                            std::uint32_t bytes) {
  sensor_msgs::Image image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.step = width * bytes;
  image.data.resize(std::size_t{image.step} * height);
  return image;
}

EditTerrain::Request a_patch() {
  EditTerrain::Request request = a_shape("patch");
  request.radius_y = 10;
  request.value = 0;
  request.image = an_image("mono8", 2, 2, 1);
  request.image.data = {255, 0, 0, 51};  // top left white, bottom right a fifth
  request.image_scale = 5;
  return request;
}

TEST_F(Edits, ARectangleIsTurned) {
  EditTerrain::Request request = a_shape("rectangle");
  request.angle_deg = 90;
  const auto response = edit(request);
  EXPECT_NEAR(response.volume, 20 * 8, 1e-3);
  EXPECT_NEAR(sand(51, 37), 1.5, 1e-5);
  EXPECT_NEAR(sand(51, 43), 0.5, 1e-5);
  EXPECT_NEAR(sand(57, 31), 0.5, 1e-5);
}

TEST_F(Edits, APolygonAndACapsuleLieWhereTheirPointsAre) {
  EditTerrain::Request request = a_shape("polygon");
  request.points = {point(20, 0), point(60, 0), point(20, 40)};
  EXPECT_NEAR(edit(request).volume, 800, 45);
  EXPECT_NEAR(sand(25, 5), 1.5, 1e-5);
  EXPECT_NEAR(sand(55, 35), 0.5, 1e-5);
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  request = a_shape("capsule");
  request.points = {point(30, 30), point(80, 50)};
  request.radius = 4;
  EXPECT_NEAR(edit(request).volume, std::hypot(50, 20) * 8 + 3.14159 * 16, 40);
  EXPECT_NEAR(sand(55, 40), 1.5, 1e-5);
  EXPECT_NEAR(sand(80, 30), 0.5, 1e-5);
}

TEST_F(Edits, ARasterIsAPatch) {
  std::string folder;
  ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder));
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/stamp.asc")
      << "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 3\n25 0\n0 5\n";
  EditTerrain::Request request = a_patch();
  request.image = {};
  request.image_file = "stamp.asc";
  request.image_scale = 0.2;
  edit(request);
  EXPECT_NEAR(sand(43, 37), 5.5, 1e-4) << "25 in the north-west";
  EXPECT_NEAR(sand(57, 23), 1.5, 1e-4);
  EXPECT_NEAR(sand(57, 37), 0.5, 1e-4);
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  request.image_use = "mask";
  request.image_scale = 0;
  request.value = 5;
  edit(request);
  EXPECT_NEAR(sand(43, 37), 5.5, 1e-4) << "1 at the highest";
  EXPECT_NEAR(sand(57, 23), 1.5, 1e-4);
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  request.image_file = "../stamp.asc";
  expect_refused<EditTerrain>("edit_terrain", request, "../stamp.asc", "~data_dir");
  request.image_file = "stamp.asc";
  request.image = an_image("mono8", 2, 2, 1);
  expect_refused<EditTerrain>("edit_terrain", request, "image_file: is set", "image is given");
  request = a_shape("circle");
  request.image_file = "stamp.asc";
  expect_refused<EditTerrain>("edit_terrain", request, "image_file", "does not use it");
}

TEST_F(Edits, APatchIsAPictureSeenFromAbove) {
  const auto check = [](const EditTerrain::Request& request) {
    edit(request);
    EXPECT_NEAR(sand(43, 37), 5.5, 1e-4) << "white in the north-west";
    EXPECT_NEAR(sand(57, 37), 0.5, 1e-4);
    EXPECT_NEAR(sand(57, 23), 1.5, 1e-4) << "a fifth in the south-east";
    ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  };
  EditTerrain::Request request = a_patch();
  check(request);
  for (const bool big_endian : {false, true}) {
    request.image = an_image("mono16", 2, 2, 2);
    request.image.is_bigendian = big_endian;
    request.image.data = {255, 255, 0, 0, 0, 0, 0x34, 0x33};  // a fifth is 0x3333
    if (big_endian) std::swap(request.image.data[6], request.image.data[7]);
    check(request);
    request.image = an_image("32FC1", 2, 2, 4);
    request.image.is_bigendian = big_endian;
    request.image.step = 11;  // padded rows
    request.image.data.assign(22, 99);
    const float values[] = {1, 0, 0, 0.2f};
    for (std::size_t n = 0; n < 4; ++n) {
      std::uint8_t* to = &request.image.data[n / 2 * 11 + n % 2 * 4];
      std::memcpy(to, &values[n], 4);
      if (big_endian) std::reverse(to, to + 4);
    }
    check(request);
  }
  request = a_patch();
  request.image_use = "mask";
  request.image_scale = 0;
  request.value = 5;
  check(request);
}

TEST_F(Edits, ConserveKeepsTheSand) {
  EditTerrain::Request request = a_shape("circle");
  request.conserve = true;
  request.ring_width = 20;
  request.merge = "sub";
  request.value = 0.3;
  const auto response = edit(request);
  EXPECT_EQ(response.volume, 0);
  EXPECT_NEAR(response.moved, -0.3 * 3.14159 * 100, 5);
  EXPECT_NEAR(sand(51, 31), 0.2, 1e-5);
  EXPECT_GT(sand(67, 31), 0.5) << "on the ring";
  EXPECT_EQ(sand(91, 31), 0.5) << "beyond it";
  request.merge = "add";
  request.value = 100;
  expect_refused<EditTerrain>("edit_terrain", request, "m^3 of sand", "needs");
}

TEST_F(Edits, SmoothLevelsThePlateausEdge) {
  EXPECT_NEAR(sand(121, -9), 0.5, 1e-5);
  EditTerrain::Request request = a_shape("circle");
  request.center = point(122, -10);
  request.merge = "smooth";
  request.value = 0;
  request.smooth_radius = 4;
  request.smooth_passes = 2;
  edit(request);
  EXPECT_GT(sand(121, -9), 1.5);
  EXPECT_LT(sand(123, -9), 5.5);
}

TEST_F(Edits, ShapesTurnAndMoveWithTheirFrame) {
  // "camera" is at the rover's place and looks along the ground.
  static tf2_ros::StaticTransformBroadcaster broadcaster;
  const geometry_msgs::TransformStamped rover = rover_frame();
  geometry_msgs::TransformStamped camera = rover;
  camera.child_frame_id = "camera";
  camera.transform.rotation.z = 0;
  camera.transform.rotation.x = std::sqrt(0.5);
  broadcaster.sendTransform({rover, camera});
  EditTerrain::Request request = a_shape("rectangle");
  request.header.frame_id = "rover";
  request.center = point(10, 0);  // ahead, which is north
  ASSERT_TRUE(wait_until([&] { return call<EditTerrain>("edit_terrain", request).success != 0; }));
  EXPECT_NEAR(sand(51, 47), 1.5, 1e-5);
  EXPECT_NEAR(sand(57, 41), 0.5, 1e-5);

  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  request = a_shape("polygon");
  request.header.frame_id = "rover";
  request.points = {point(0, 0), point(20, 0), point(20, -10), point(0, -10)};  // ahead and to the right
  edit(request);
  EXPECT_NEAR(sand(55, 45), 1.5, 1e-5);
  EXPECT_NEAR(sand(45, 45), 0.5, 1e-5);
  EXPECT_NEAR(sand(65, 35), 0.5, 1e-5);

  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  request = a_patch();
  request.header.frame_id = "rover";
  request.center = point(0, 0);
  edit(request);
  EXPECT_NEAR(sand(43, 23), 5.5, 1e-4) << "the top left corner, behind the left of its first axis";
  EXPECT_NEAR(sand(57, 37), 1.5, 1e-4);

  request.header.frame_id = "camera";
  expect_refused<EditTerrain>("edit_terrain", request, "'camera' is tilted by 90", "45");
}

/// An edit that changes nothing, of the layer of which no test is told otherwise.
EditTerrain::Request of_rock() {
  EditTerrain::Request nothing = a_shape("circle");
  nothing.layer = "bedrock";
  nothing.value = 0;
  return nothing;
}

/// Edits that change nothing, until the node knows of the listener; and one of rock, so that all those before
/// it have come in.
void connect(const Listener<TerrainDiff>& diffs) {
  EditTerrain::Request nothing = a_shape("circle");
  nothing.value = 0;
  ASSERT_TRUE(wait_until([&] {
    edit(nothing);
    return diffs.count() > 0;
  }));
  edit(of_rock());
  ASSERT_TRUE(diffs.wait_for([](const TerrainDiff& diff) { return diff.layer == "bedrock"; }));
}

TEST_F(Edits, AreToldOnceToWhoeverListens) {
  Listener<TerrainDiff> diffs("terrain_diff");
  connect(diffs);
  const std::size_t before = diffs.count();
  EditTerrain::Request request = a_shape("rectangle");
  request.conserve = true;
  request.ring_width = 6;
  request.merge = "sub";
  request.value = 0.25;
  const double was = sand(51, 31);
  const auto response = edit(request);
  ASSERT_TRUE(diffs.wait_for_count(before + 1));
  const TerrainDiff diff = diffs.last();
  EXPECT_EQ(diff.header.frame_id, "terrain");
  EXPECT_FALSE(diff.header.stamp.isZero());
  EXPECT_EQ(diff.step, response.step);
  EXPECT_EQ(diff.layer, "sand");
  EXPECT_EQ(diff.x, response.x);
  EXPECT_EQ(diff.y, response.y);
  EXPECT_EQ(diff.width, response.width);
  EXPECT_EQ(diff.height, response.height);
  EXPECT_EQ(diff.cell_size, 2);
  EXPECT_EQ(diff.origin.position.x, 10 + 2 * diff.x);
  EXPECT_EQ(diff.origin.position.y, -20 + 2 * diff.y);
  ASSERT_EQ(diff.change.size(), std::size_t{diff.width} * diff.height);
  EXPECT_NEAR(std::accumulate(diff.change.begin(), diff.change.end(), 0.0), 0, 1e-4);
  const float there = diff.change[(25 - diff.y) * diff.width + (20 - diff.x)];  // the cell around (51, 31)
  EXPECT_NEAR(there, -0.25, 1e-6);
  EXPECT_NEAR(sand(51, 31), was + there, 1e-5);
  // Nobody is told of a refused edit or of a step: what comes next is the next edit.
  request.radius = -1;
  expect_refused<EditTerrain>("edit_terrain", request, "radius: -1", "m");
  step(1);
  edit(of_rock());
  ASSERT_TRUE(diffs.wait_for_count(before + 2));
  EXPECT_EQ(diffs.all().at(before + 1).layer, "bedrock");
}

TEST_F(Edits, AreNotToldToWhoComesLater) {
  edit(of_rock());
  Listener<TerrainDiff> diffs("terrain_diff");
  EditTerrain::Request later = a_shape("circle");
  ASSERT_TRUE(wait_until([&] {
    edit(later);
    return diffs.count() > 0;
  }));
  EXPECT_EQ(diffs.all().front().layer, "sand");
}

/// Good and bad ones at once from several callers: each good one counts, no bad one does, all are told.
TEST_F(Edits, ComeFromSeveralCallersAtOnce) {
  Listener<TerrainDiff> diffs("terrain_diff");
  connect(diffs);
  const std::size_t before = diffs.count();
  constexpr int callers = 4, calls = 15;
  // Over connections that are there before: roscpp loses a call now and then when threads of one process open
  // new ones at once.
  std::vector<ros::ServiceClient> clients;
  for (int caller = 0; caller < callers; ++caller)
    clients.push_back(ros::NodeHandle().serviceClient<EditTerrain>("/desert_sim/edit_terrain", true));
  std::vector<std::thread> threads;
  for (int caller = 0; caller < callers; ++caller)
    threads.emplace_back([caller, client = clients.at(static_cast<std::size_t>(caller))]() mutable {
      EditTerrain exchange;
      for (int n = 0; n < calls; ++n) {
        exchange.request = a_shape((caller + n) % 2 ? "circle" : "rectangle");
        exchange.request.value = 0.125;
        EXPECT_TRUE(client.call(exchange) && exchange.response.success) << exchange.response.message;
        exchange.request.radius = -1;
        EXPECT_TRUE(client.call(exchange) && !exchange.response.success);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_NEAR(sand(51, 31), 0.5 + callers * calls * 0.125, 1e-5);
  edit(of_rock());
  ASSERT_TRUE(wait_until([&] { return diffs.last().layer == "bedrock" && diffs.count() > before; }));
  EXPECT_EQ(diffs.count(), before + callers * calls + 1);
}

TEST_F(Edits, RefusesShapesThatAreNone) {
  const auto refused = [](EditTerrain::Request request,
                          const std::function<void(EditTerrain::Request&)>& spoil, const std::string& what,
                          const std::string& allowed) {
    spoil(request);
    expect_refused<EditTerrain>("edit_terrain", request, what, allowed);
  };
  EditTerrain::Request polygon = a_shape("polygon");
  polygon.points = {point(20, 0), point(60, 0), point(20, 40)};
  refused(
      polygon, [](auto& r) { r.points.clear(); }, "points: 0", "3 to 512");
  refused(
      polygon, [](auto& r) { r.points.resize(100000, point(3, 4)); }, "points: 100000", "512");
  refused(
      polygon, [](auto& r) { r.points[1].x = not_a_number; }, "points[1].x: nan", "finite");
  refused(
      polygon, [](auto& r) { r.points[2] = point(80, 0); }, "points", "one line");
  refused(
      polygon, [](auto& r) { r.points[2].y = 1e300; }, "points[2]: 1e+300", "1e+07");
  refused(
      polygon, [](auto& r) { r.falloff = -3; }, "falloff: -3", "[0");
  refused(
      polygon,
      [](auto& r) {
        r.shape = "capsule";
        r.radius = 1;
      },
      "points: 3", "2");
  refused(
      polygon, [](auto& r) { r.header.frame_id = "nowhere"; }, "'nowhere'", "'terrain'");
  const EditTerrain::Request circle = a_shape("circle");
  refused(
      circle, [](auto& r) { r.layer = "soil"; }, "soil", "this terrain has no layer soil");
  refused(
      circle, [](auto& r) { r.layer = "water"; }, "water", "this terrain has no layer water");
  refused(
      circle, [](auto& r) { r.layer = "snow"; }, "'snow'", "sand, bedrock, soil, water");
  refused(
      circle, [](auto& r) { r.conserve = true; }, "ring_width: 0", "m");
  refused(
      circle, [](auto& r) { r.conserve = true, r.ring_width = infinity; }, "ring_width: inf", "m");
  refused(
      circle, [](auto& r) { r.merge = "smooth", r.value = 0; }, "smooth_radius: 0", "m");
  refused(
      circle, [](auto& r) { r.merge = "smooth", r.value = 0, r.smooth_radius = 200, r.smooth_passes = 1; },
      "smooth_radius: 200", "64 cells");
  refused(
      circle, [](auto& r) { r.merge = "smooth", r.value = 0, r.smooth_radius = 2, r.smooth_passes = 17; },
      "smooth_passes: 17", "[1, 16]");
}

TEST_F(Edits, RefusesMegabytesOfTextInFewWords) {
  for (const auto field :
       {&EditTerrain::Request::layer, &EditTerrain::Request::shape, &EditTerrain::Request::merge}) {
    EditTerrain::Request request = a_shape("circle");
    request.*field = std::string(10000000, 'x');
    const auto response = call<EditTerrain>("edit_terrain", request);
    EXPECT_FALSE(response.success);
    EXPECT_LT(response.message.size(), 400u);
    EXPECT_NE(response.message.find("xxx...' is not one of"), std::string::npos) << response.message;
  }
}

TEST_F(Edits, RefusesImagesThatDoNotFit) {
  const auto refused = [](const std::function<void(EditTerrain::Request&)>& spoil, const std::string& what,
                          const std::string& allowed) {
    EditTerrain::Request request = a_patch();
    spoil(request);
    expect_refused<EditTerrain>("edit_terrain", request, what, allowed);
  };
  refused([](auto& r) { r.image.encoding = "rgb8"; }, "'rgb8'", "mono8, mono16, 32FC1");
  refused([](auto& r) { r.image.encoding = ""; }, "encoding: ''", "mono8");
  refused([](auto& r) { r.image = {}; }, "image", "mono8");
  refused([](auto& r) { r.image.width = 0; }, "0 x 2", "1 to 1048576");
  refused([](auto& r) { r.image.width = r.image.height = 0xffffffffu; }, "4294967295", "1048576");
  refused([](auto& r) { r.image.data.pop_back(); }, "3 bytes", "4");
  refused([](auto& r) { r.image.data.push_back(0); }, "5 bytes", "4");
  refused([](auto& r) { r.image.step = 1; }, "image.step: 1", "at least 2");
  refused([](auto& r) { r.image.encoding = "mono16"; }, "image.step: 2", "at least 4");
  refused([](auto& r) { r.image_use = "stamp"; }, "'stamp'", "heights, mask");
  refused([](auto& r) { r.image_scale = not_a_number; }, "image_scale: nan", "finite");
  refused([](auto& r) { r.image_scale = 1e300; }, "column 0, row 0: inf", "100000");
  refused([](auto& r) { r.merge = "replace", r.value = -1; }, "value", "depth");
  refused(
      [](auto& r) {
        r.image = an_image("32FC1", 1, 1, 4);
        r.image.data = {0, 0, 0xc0, 0x7f};  // NaN
      },
      "column 0, row 0: nan", "100000");
  refused(
      [](auto& r) {
        r.image = an_image("32FC1", 1, 1, 4);
        r.image.data = {0, 0, 0, 0x40};  // 2
        r.image_use = "mask";
        r.image_scale = 0;
      },
      ": 2 is not in", "[0, 1]");
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "edits");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) std::filesystem::remove_all(folder);
  return status;
}

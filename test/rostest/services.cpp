/// Every service's good and bad path, on a paused node with the scenario corner.yaml. A refused request changes nothing:
/// the state hash stays, and the message names the value and what is allowed.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/QueryTerrain.h>
#include <desert_sim/SaveCheckpoint.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/Step.h>
#include <desert_sim/WindField.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "rostest/client.hpp"

namespace {

namespace fs = std::filesystem;
using namespace desert_sim;
using node_test::call;
using node_test::Listener;
using node_test::wait_until;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

std::string hash() { return call<Step>("step").state_hash; }

Step::Response step(std::uint32_t steps) {
  Step::Request request;
  request.steps = steps;
  return call<Step>("step", request);
}

/// The wind high above, as the status has it after the change that `fits`.
bool wind_becomes(double x, double y) {
  Listener<SimulationStatus> statuses("status");
  return statuses.wait_for([&](const SimulationStatus& s) { return std::hypot(s.wind_above.x - x, s.wind_above.y - y) < 1e-4; });
}

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

/// Refused, the hash stays, and the message has both texts in it.
template <class Service>
void expect_refused(const std::string& name, const typename Service::Request& request, const std::string& what, const std::string& allowed) {
  const std::string before = hash();
  const auto response = call<Service>(name, request);
  EXPECT_FALSE(response.success) << name << " took " << what;
  EXPECT_NE(response.message.find(what), std::string::npos) << "'" << what << "' is not named by: " << response.message;
  EXPECT_NE(response.message.find(allowed), std::string::npos) << "'" << allowed << "' is not named by: " << response.message;
  EXPECT_EQ(hash(), before) << name << ": " << response.message;
}

class Services : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(call<std_srvs::Trigger>("reset").success); }
};

// ---- wind ----------------------------------------------------------------------------------------------------------

TEST_F(Services, SetWindTurnsTheWindAboveAndThenTheWindAtTheSurface) {
  SetWind::Request request;
  request.speed = 8;
  request.direction_deg = 90;
  EXPECT_TRUE(call<SetWind>("set_wind", request).success);
  EXPECT_TRUE(wind_becomes(0, 8));
  step(1);
  const WindField wind = Listener<WindField>("wind").last();
  const std::size_t somewhere = 20 * wind.width + 10;
  EXPECT_NEAR(wind.u.at(somewhere), 0, 1);
  EXPECT_GT(wind.v.at(somewhere), 5) << "it blows to the north";
  EXPECT_EQ(wind.above.y, 8);
}

TEST_F(Services, SetWindTakesAVectorAndARamp) {
  SetWind::Request request;
  request.use_vector = true;
  request.vector.x = -3;
  request.vector.y = -4;
  request.ramp = 10;
  EXPECT_TRUE(call<SetWind>("set_wind", request).success);
  EXPECT_TRUE(wind_becomes(5, 0)) << "the ramp begins with the wind of before";
  step(10);
  EXPECT_TRUE(wind_becomes(-3, -4));
}

TEST_F(Services, SetWindRefuses) {
  SetWind::Request request;
  request.speed = nan;
  expect_refused<SetWind>("set_wind", request, "speed: = nan", "[0, 100] m/s");
  request.speed = infinity;
  expect_refused<SetWind>("set_wind", request, "speed: = inf", "[0, 100] m/s");
  request.speed = -1;
  expect_refused<SetWind>("set_wind", request, "speed: = -1", "[0, 100] m/s");
  request.speed = 1e300;
  expect_refused<SetWind>("set_wind", request, "speed", "[0, 100] m/s");
  request.speed = 5;
  request.direction_deg = 1000;
  expect_refused<SetWind>("set_wind", request, "direction_deg: = 1000", "[-360, 360] deg");
  request.direction_deg = 0;
  request.ramp = -1;
  expect_refused<SetWind>("set_wind", request, "ramp: = -1", "s");
  request.ramp = 0;
  request.use_vector = true;
  request.vector.x = nan;
  expect_refused<SetWind>("set_wind", request, "vector.x: = nan", "finite");
  request.vector.x = 1;
  request.vector.z = 2;
  expect_refused<SetWind>("set_wind", request, "vector.z", "must be 0");
}

TEST_F(Services, SetWindScheduleRunsATimeline) {
  SetWindSchedule::Request request;
  request.kind = SetWindSchedule::Request::TIMELINE;
  request.segments.resize(2);
  request.segments[0].speed = 4;
  request.segments[0].duration = 5;
  request.segments[1].speed = 6;
  request.segments[1].direction_deg = 180;
  request.segments[1].duration = 5;
  const auto response = call<SetWindSchedule>("set_wind_schedule", request);
  EXPECT_TRUE(response.success) << response.message;
  step(1);
  EXPECT_TRUE(wind_becomes(4, 0));
  step(6);
  EXPECT_TRUE(wind_becomes(-6, 0));
  step(20);
  EXPECT_TRUE(wind_becomes(-6, 0)) << "the last segment holds";
}

TEST_F(Services, SetWindScheduleDrawsFromARose) {
  SetWindSchedule::Request request;
  request.kind = SetWindSchedule::Request::ROSE;
  request.segments.resize(2);
  request.segments[0].speed = 4;
  request.segments[0].probability = 0;
  request.segments[1].speed = 7;
  request.segments[1].direction_deg = -90;
  request.segments[1].probability = 1;
  request.hold_time = 3;
  const auto response = call<SetWindSchedule>("set_wind_schedule", request);
  EXPECT_TRUE(response.success) << response.message;
  step(4);
  EXPECT_TRUE(wind_becomes(0, -7));
}

TEST_F(Services, SetWindScheduleRefuses) {
  SetWindSchedule::Request request;
  request.kind = "gusts";
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "kind: 'gusts'", "timeline, rose");
  request.kind = "rose";
  request.hold_time = 10;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "segments", "at least one");
  request.segments.resize(1);
  request.segments[0].speed = 5;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "segments", "probabilities");
  request.segments[0].probability = 1;
  request.hold_time = -3;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "hold_time", "-3");
  request.kind = "timeline";
  request.segments[0].duration = 10;
  request.segments[0].speed = nan;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "speed: = nan", "[0, 100] m/s");
  request.segments[0].speed = 5;
  request.segments[0].ramp = 20;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "ramp", "duration");
  request.segments.resize(5000);
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "5000", "4096");
}

// ---- edits and queries ---------------------------------------------------------------------------------------------

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
  } cases[] = {{"add", 1, 1.5}, {"sub", 0.2, 0.3}, {"sub", 9, 0}, {"replace", 3, 3}, {"min", 0.1, 0.1}, {"min", 2, 0.5},
               {"max", 2, 2},   {"max", 0.1, 0.5}, {"avg", 1.5, 1}};
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
  const auto refused = [](const std::function<void(EditTerrain::Request&)>& spoil, const std::string& what, const std::string& allowed) {
    EditTerrain::Request request = a_brush();
    spoil(request);
    expect_refused<EditTerrain>("edit_terrain", request, what, allowed);
  };
  refused([](auto& r) { r.layer = "lava"; }, "'lava'", "sand, bedrock");
  refused([](auto& r) { r.shape = "star"; }, "'star'", "circle, ellipse");
  refused([](auto& r) { r.merge = "xor"; }, "'xor'", "add, sub, replace, min, max, avg");
  refused([](auto& r) { r.merge = ""; }, "merge: ''", "add, sub");
  refused([](auto& r) { r.radius = -5; }, "radius: = -5", "m");
  refused([](auto& r) { r.radius = 0; }, "radius: = 0", "m");
  refused([](auto& r) { r.radius = nan; }, "radius: = nan", "m");
  refused([](auto& r) { r.radius = infinity; }, "radius: = inf", "m");
  refused([](auto& r) { r.center.x = nan; }, "center.x: = nan", "finite");
  refused([](auto& r) { r.center.z = infinity; }, "center.z: = inf", "finite");
  refused([](auto& r) { r.inner = 2; }, "inner: = 2", "[0, 1]");
  refused([](auto& r) { r.value = nan; }, "value: = nan", "m");
  refused([](auto& r) { r.value = -1; }, "value", "depth");
  refused([](auto& r) { r.angle_deg = nan; }, "angle_deg: = nan", "finite");
  refused([](auto& r) { r.center.x = 5000; }, "5000", "no cell");
  refused([](auto& r) { r.header.frame_id = "nowhere"; }, "'nowhere'", "'terrain'");
  refused([](auto& r) { r.shape = "ellipse"; }, "radius_y: = 0", "m");
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
  // "rover" stands at (50, 30) of the terrain and looks north.
  static tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped rover;
  rover.header.stamp = ros::Time::now();
  rover.header.frame_id = "terrain";
  rover.child_frame_id = "rover";
  rover.transform.translation.x = 50;
  rover.transform.translation.y = 30;
  rover.transform.rotation.z = rover.transform.rotation.w = std::sqrt(0.5);
  broadcaster.sendTransform(rover);
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
  request.points[1].y = nan;
  expect_refused<QueryTerrain>("query_terrain", request, "points[1].y: = nan", "finite");
  request.points[1].y = 0;
  request.header.frame_id = "nowhere";
  expect_refused<QueryTerrain>("query_terrain", request, "'nowhere'", "'terrain'");
  const auto start = std::chrono::steady_clock::now();
  call<QueryTerrain>("query_terrain", request);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1)) << "a missing frame does not hang";
}

// ---- checkpoints ---------------------------------------------------------------------------------------------------

class Checkpoints : public Services {
 protected:
  void SetUp() override {
    Services::SetUp();
    ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder_));
  }
  SaveCheckpoint::Response save(const std::string& name) {
    SaveCheckpoint::Request request;
    request.name = name;
    return call<SaveCheckpoint>("save_checkpoint", request);
  }
  LoadCheckpoint::Response load(const std::string& name) {
    LoadCheckpoint::Request request;
    request.name = name;
    return call<LoadCheckpoint>("load_checkpoint", request);
  }
  std::string folder_;
};

TEST_F(Checkpoints, LoadingGoesOnAsIfNothingHadBeen) {
  step(5);
  const SaveCheckpoint::Response saved = save("runs/five.ckpt");
  ASSERT_TRUE(saved.success) << saved.message;
  EXPECT_EQ(saved.step, 5u);
  EXPECT_EQ(saved.state_hash, hash());
  EXPECT_TRUE(fs::exists(folder_ + "/runs/five.ckpt"));
  const std::string later = step(5).state_hash;
  Listener<ElevationGrid> keyframes("elevation");
  keyframes.last();
  const LoadCheckpoint::Response loaded = load("runs/five.ckpt");
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_EQ(loaded.step, 5u);
  EXPECT_EQ(loaded.sim_time, 5);
  EXPECT_EQ(loaded.state_hash, saved.state_hash);
  EXPECT_TRUE(wait_until([&] { return keyframes.last().step == 5; })) << "a new keyframe after loading";
  EXPECT_EQ(step(5).state_hash, later);
}

TEST_F(Checkpoints, StayBelowTheDataFolder) {
  ASSERT_TRUE(save("here.ckpt").success);
  const fs::path outside = folder_ + "_outside";
  fs::create_directories(outside);
  fs::remove(folder_ + "/leads_out");
  fs::create_symlink(outside, folder_ + "/leads_out");
  fs::remove(folder_ + "/file_out");
  fs::create_symlink(outside / "x.ckpt", folder_ + "/file_out");
  for (const std::string& name : {std::string(""), folder_ + "/here.ckpt", std::string("../x.ckpt"), std::string("a/../../x.ckpt"),
                                  std::string("leads_out/x.ckpt"), std::string("leads_out/deeper/x.ckpt"), std::string("file_out"),
                                  std::string("folder/"), std::string("."), std::string("..")}) {
    SaveCheckpoint::Request request;
    request.name = name;
    expect_refused<SaveCheckpoint>("save_checkpoint", request, "'" + name + "'", "");
    LoadCheckpoint::Request load_request;
    load_request.name = name;
    expect_refused<LoadCheckpoint>("load_checkpoint", load_request, "'" + name + "'", "");
  }
  EXPECT_TRUE(fs::is_empty(outside));
  fs::remove_all(outside);
}

TEST_F(Checkpoints, LinksThatStayInsideAreFollowed) {
  ASSERT_TRUE(save("real/a.ckpt").success);
  fs::remove(folder_ + "/alias");
  fs::create_symlink(folder_ + "/real", folder_ + "/alias");
  EXPECT_TRUE(load("alias/a.ckpt").success);
}

TEST_F(Checkpoints, BrokenFilesAreRefused) {
  LoadCheckpoint::Request request;
  request.name = "missing.ckpt";
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "missing.ckpt", "no such file");
  ASSERT_TRUE(save("short.ckpt").success);
  fs::resize_file(folder_ + "/short.ckpt", fs::file_size(folder_ + "/short.ckpt") / 2);
  request.name = "short.ckpt";
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "short.ckpt", "cut off");
  request.name = "real";
  fs::create_directories(folder_ + "/real");
  expect_refused<LoadCheckpoint>("load_checkpoint", request, "'real'", "not a file");
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "services");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) fs::remove_all(folder);
  return status;
}

/// ~set_wind, ~set_wind_schedule and ~edit_wind, on a paused node with the scenario corner.yaml.
#include <desert_sim/EditWind.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/WindField.h>

#include <cmath>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

/// The wind high above, as the status has it after the change that `fits`.
bool wind_becomes(double x, double y) {
  Listener<SimulationStatus> statuses("status");
  return statuses.wait_for(
      [&](const SimulationStatus& s) { return std::hypot(s.wind_above.x - x, s.wind_above.y - y) < 1e-4; });
}

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
  request.speed = not_a_number;
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
  request.vector.x = not_a_number;
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
  request.segments[0].speed = not_a_number;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "speed: = nan", "[0, 100] m/s");
  request.segments[0].speed = 5;
  request.segments[0].ramp = 20;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "ramp", "duration");
  request.segments.resize(5000);
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "5000", "4096");
}

EditWind::Request jet(const std::string& operation) {
  EditWind::Request request;
  request.operation = operation;
  request.id = 5;
  request.kind = EditWind::Request::JET;
  request.radius = 6;
  request.length = 30;
  request.speed = 4;
  request.direction_deg = 90;
  const WindField wind = Listener<WindField>("wind").last();
  request.center.x = wind.origin.position.x + 0.5 * wind.width * wind.cell_size;
  request.center.y = wind.origin.position.y + 0.5 * wind.height * wind.cell_size;
  return request;
}

double northward_in_the_middle() {
  const WindField wind = Listener<WindField>("wind").last();
  return wind.v.at(wind.height / 2 * wind.width + wind.width / 2);
}

TEST_F(Services, EditWindAddsAJetAndTakesItAway) {
  step(1);
  const double before = northward_in_the_middle();
  EXPECT_TRUE(call<EditWind>("edit_wind", jet("add")).success);
  step(1);
  EXPECT_NEAR(northward_in_the_middle() - before, 4, 0.5);
  EXPECT_TRUE(call<EditWind>("edit_wind", jet("remove")).success);
  step(1);
  EXPECT_NEAR(northward_in_the_middle(), before, 0.5);
}

TEST_F(Services, EditWindRefuses) {
  expect_refused<EditWind>("edit_wind", jet("blow"), "operation: 'blow'", "add, change, remove, clear");
  expect_refused<EditWind>("edit_wind", jet("change"), "id: = 5", "not the id of any feature");
  EditWind::Request request = jet("add");
  request.kind = "tornado";
  expect_refused<EditWind>("edit_wind", request, "kind: 'tornado'", "vortex, jet, turbulence");
  request = jet("add");
  request.speed = infinity;
  expect_refused<EditWind>("edit_wind", request, "speed: = inf", "[-100, 100] m/s");
  request = jet("add");
  request.center.x = not_a_number;
  expect_refused<EditWind>("edit_wind", request, "center.x: = nan", "finite");
  request = jet("add");
  request.header.frame_id = "nowhere";
  expect_refused<EditWind>("edit_wind", request, "nowhere", "");
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "wind_services"); }

/// ~set_wind, ~set_wind_schedule and ~edit_wind, on a paused node with the scenario corner.yaml.
#include <desert_sim/EditWind.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SetWindSchedule.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/WindFeatureList.h>
#include <desert_sim/WindField.h>

#include <cmath>
#include <memory>

#include "test/support/ros/request_fields.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

class WindServices : public Services {
 protected:
  static void SetUpTestSuite() {
    statuses_ = std::make_unique<Listener<SimulationStatus>>("status");
    winds_ = std::make_unique<Listener<WindField>>("wind");
    statuses_->last();
    winds_->last();
  }
  static void TearDownTestSuite() {
    statuses_.reset();
    winds_.reset();
  }

  /// The first message of a state that was reached at this time or later.
  template <class Message>
  static Message since(const ros::Time& time, const Listener<Message>& listener) {
    EXPECT_TRUE(wait_until([&] { return listener.last().header.stamp >= time; }));
    return listener.last();
  }
  static void set(const SetWind::Request& request, double x, double y) {
    const ros::Time before = ros::Time::now();
    EXPECT_TRUE(call<SetWind>("set_wind", request).success);
    expect_wind_since(before, x, y);
  }
  static void expect_wind_after(std::uint32_t steps, double x, double y) {
    const ros::Time before = ros::Time::now();
    step(steps);
    expect_wind_since(before, x, y);
  }
  /// The wind at the surface after another step.
  static WindField field_after_a_step() {
    const ros::Time before = ros::Time::now();
    step(1);
    return since(before, *winds_);
  }
  static EditWind::Request jet(const std::string& operation) {
    EditWind::Request request;
    request.operation = operation;
    request.id = 5;
    request.kind = EditWind::Request::JET;
    request.radius = 6;
    request.length = 30;
    request.speed = 4;
    request.direction_deg = 90;
    const WindField wind = winds_->last();
    request.center.x = wind.origin.position.x + 0.5 * wind.width * wind.cell_size;
    request.center.y = wind.origin.position.y + 0.5 * wind.height * wind.cell_size;
    return request;
  }
  static double northward_in_the_middle() {
    const WindField wind = field_after_a_step();
    return wind.v.at(wind.height / 2 * wind.width + wind.width / 2);
  }

 private:
  /// High above the ground.
  static void expect_wind_since(const ros::Time& time, double x, double y) {
    const geometry_msgs::Vector3 wind = since(time, *statuses_).wind_above;
    EXPECT_NEAR(wind.x, x, 1e-4);
    EXPECT_NEAR(wind.y, y, 1e-4);
  }

  // Of all tests: roscpp takes a fifth of a second for each subscription.
  static inline std::unique_ptr<Listener<SimulationStatus>> statuses_;
  static inline std::unique_ptr<Listener<WindField>> winds_;
};

TEST_F(WindServices, SetWindTurnsTheWindAboveAndThenTheWindAtTheSurface) {
  SetWind::Request request;
  request.speed = 8;
  request.direction_deg = 90;
  set(request, 0, 8);
  const WindField wind = field_after_a_step();
  const std::size_t somewhere = 20 * wind.width + 10;
  EXPECT_NEAR(wind.u.at(somewhere), 0, 1);
  EXPECT_GT(wind.v.at(somewhere), 5) << "it blows to the north";
  EXPECT_EQ(wind.above.y, 8);
}

TEST_F(WindServices, SetWindTakesAVectorAndARamp) {
  SetWind::Request request;
  request.use_vector = true;
  request.vector.x = -3;
  request.vector.y = -4;
  request.ramp = 10;
  set(request, 5, 0);  // the ramp begins with the wind of before
  expect_wind_after(10, -3, -4);
}

TEST_F(WindServices, SetWindRefuses) {
  SetWind::Request request;
  request.speed = not_a_number;
  expect_refused<SetWind>("set_wind", request, "speed: nan", "[0, 100] m/s");
  request.speed = infinity;
  expect_refused<SetWind>("set_wind", request, "speed: inf", "[0, 100] m/s");
  request.speed = -1;
  expect_refused<SetWind>("set_wind", request, "speed: -1", "[0, 100] m/s");
  request.speed = 1e300;
  expect_refused<SetWind>("set_wind", request, "speed", "[0, 100] m/s");
  request.speed = 5;
  request.direction_deg = 1000;
  expect_refused<SetWind>("set_wind", request, "direction_deg: 1000", "[-360, 360] deg");
  request.direction_deg = 0;
  request.ramp = -1;
  expect_refused<SetWind>("set_wind", request, "ramp: -1", "s");
  request.ramp = 0;
  request = SetWind::Request();
  request.use_vector = true;
  request.vector.x = not_a_number;
  expect_refused<SetWind>("set_wind", request, "vector.x: nan", "finite");
  request.vector.x = 1;
  request.vector.z = 2;
  expect_refused<SetWind>("set_wind", request, "vector.z", "must be 0");
}

TEST_F(WindServices, SetWindScheduleRunsATimeline) {
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
  expect_wind_after(1, 4, 0);
  expect_wind_after(6, -6, 0);
  expect_wind_after(20, -6, 0);  // the last segment holds
}

TEST_F(WindServices, SetWindScheduleDrawsFromARose) {
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
  expect_wind_after(4, 0, -7);
}

TEST_F(WindServices, SetWindScheduleRefuses) {
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
  request.hold_time = 0;
  request.segments[0].probability = 0;
  request.segments[0].duration = 10;
  request.segments[0].speed = not_a_number;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "speed: nan", "[0, 100] m/s");
  request.segments[0].speed = 5;
  request.segments[0].ramp = 20;
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "ramp", "duration");
  request.segments.resize(5000);
  expect_refused<SetWindSchedule>("set_wind_schedule", request, "5000", "4096");
}

TEST_F(WindServices, EditWindAddsAJetAndTakesItAway) {
  const double before = northward_in_the_middle();
  EXPECT_TRUE(call<EditWind>("edit_wind", jet("add")).success);
  EXPECT_NEAR(northward_in_the_middle() - before, 4, 0.5);
  EditWind::Request removed;
  removed.operation = EditWind::Request::REMOVE;
  removed.id = jet("add").id;
  EXPECT_TRUE(call<EditWind>("edit_wind", removed).success);
  EXPECT_NEAR(northward_in_the_middle(), before, 0.5);
}

/// Each with its id, so that another program can change or remove it.
TEST_F(WindServices, WindFeaturesAreListedWithTheirIds) {
  const Listener<WindFeatureList> list("wind_features");
  const auto listed_after = [&](const EditWind::Request& request) {
    const ros::Time before = ros::Time::now();
    EXPECT_TRUE(call<EditWind>("edit_wind", request).success);
    return since(before, list).features;
  };
  EXPECT_TRUE(list.last().features.empty());
  const EditWind::Request added = jet("add");
  EditWind::Request vortex;
  vortex.operation = EditWind::Request::ADD;
  vortex.id = 9;
  vortex.kind = EditWind::Request::VORTEX;
  vortex.center.x = 40, vortex.center.y = 12, vortex.radius = 7, vortex.speed = -2;
  vortex.begin = 1, vortex.end = 1e9, vortex.velocity.x = 3;
  listed_after(added);
  const auto both = listed_after(vortex);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0].id, 5);
  EXPECT_EQ(both[0].kind, EditWind::Request::JET);
  EXPECT_EQ(both[0].center.x, added.center.x);
  EXPECT_EQ(both[0].direction_deg, 90);
  EXPECT_EQ(both[0].length, 30);
  EXPECT_EQ(both[1].id, 9);
  EXPECT_EQ(both[1].kind, EditWind::Request::VORTEX);
  EXPECT_EQ(both[1].speed, -2);
  EXPECT_EQ(both[1].begin, 1);
  EXPECT_EQ(both[1].end, 1e9);
  EXPECT_EQ(both[1].velocity.x, 3);
  EXPECT_EQ(both[1].length, 0) << "a vortex has none, as ~edit_wind wants it";
  vortex.operation = EditWind::Request::CHANGE;
  vortex.center = {}, vortex.velocity = {};
  vortex.path = {node_test::path_point(1, 40, 12), node_test::path_point(5, 50, -2)};
  const auto moved = listed_after(vortex);
  ASSERT_EQ(moved.at(1).path.size(), 2u);
  EXPECT_EQ(moved[1].path[1].time, 5);
  EXPECT_EQ(moved[1].path[1].x, 50);
  EXPECT_EQ(moved[1].path[1].y, -2);
  EXPECT_TRUE(moved[0].path.empty());
  EditWind::Request cleared;
  cleared.operation = EditWind::Request::CLEAR;
  EXPECT_TRUE(listed_after(cleared).empty());
}

TEST_F(WindServices, EditWindRefuses) {
  expect_refused<EditWind>("edit_wind", jet("blow"), "operation: 'blow'", "add, change, remove, clear");
  expect_refused<EditWind>("edit_wind", jet("change"), "id: 5", "not the id of any feature");
  EditWind::Request request = jet("add");
  request.kind = "tornado";
  expect_refused<EditWind>("edit_wind", request, "kind: 'tornado'", "vortex, jet, turbulence");
  request = jet("add");
  request.speed = infinity;
  expect_refused<EditWind>("edit_wind", request, "speed: inf", "[-100, 100] m/s");
  request = jet("add");
  request.center.x = not_a_number;
  expect_refused<EditWind>("edit_wind", request, "center.x: nan", "finite");
  request = jet("add");
  request.velocity.z = 1;
  expect_refused<EditWind>("edit_wind", request, "velocity.z", "must be 0");
  request = jet("add");
  request.begin = 4, request.end = 3;
  expect_refused<EditWind>("edit_wind", request, "end", "above `begin`");
  request = jet("add");
  request.center = {};
  request.path = {node_test::path_point(4, 1, 1), node_test::path_point(3, 1, 1)};
  expect_refused<EditWind>("edit_wind", request, "path.1.time", "not after the 4 s");
  request.path[1].y = not_a_number;
  expect_refused<EditWind>("edit_wind", request, "path[1].y: nan", "finite");
  request = jet("add");
  request.header.frame_id = "nowhere";
  expect_refused<EditWind>("edit_wind", request, "nowhere", "");
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "wind_services"); }

// Driving: limits, slip by the law, odometry that believes in the wheels, and what the inertial sensors
// feel.

#include "kernels/rover/wheel_ground.hpp"
#include "src/rover/rover_class.hpp"
#include "test/src/rover/field.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

using namespace test;

void drive(Rover& rover, const DriveCommand& command, double seconds, const GroundSource& ground) {
  rover.drive(command, seconds);
  rover.advance(seconds, &ground);
}

TEST(RoverDrive, OnFlatFirmGroundItGoesWhereItIsTold) {
  RoverParameters p;
  p.wheel_law = WheelLaw::light;
  WheelGroundParameters firm;
  firm.light_packed = 0;
  Rover r(p, firm);
  const SmoothGround ground(flat());
  r.place(0, 0, 0, ground);
  drive(r, {0.2, 0, 0}, 10, ground);
  // It speeds up at 0.5 m/s² in steps of 0.02 s: 0.2 m/s · 10 s less the area above the ramp.
  double expected = 0, speed = 0;
  for (int n = 0; n < 500; ++n) expected += 0.02 * (speed = std::min(speed + 0.5 * 0.02, 0.2));
  EXPECT_NEAR(r.state().pose.x, expected, 1e-12);
  EXPECT_EQ(r.state().pose.y, 0);
  EXPECT_NEAR(r.state().odometry.x, expected, 1e-12);
  EXPECT_NEAR(r.state().wheels[0].angle, std::remainder(expected / 0.1, 2 * pi), 1e-9);
  EXPECT_EQ(r.state().condition, RoverCondition::driving);
  r.advance(5, &ground);
  EXPECT_EQ(r.state().condition, RoverCondition::idle);
}

TEST(RoverDrive, ACommandEndsWithItsTime) {
  Rover r = rover_of();
  const SmoothGround ground(flat());
  r.place(0, 0, 0, ground);
  r.drive({0.2, 0, 0}, 0.5);
  r.advance(0.5, &ground);
  EXPECT_GT(r.state().rims.forward, 0.19);
  r.advance(1, &ground);
  EXPECT_EQ(r.state().rims.forward, 0);
}

TEST(RoverDrive, TimeThatIsNoWholeStepWaits) {
  const SmoothGround ground(flat());
  Rover once = rover_of(), often = rover_of();
  for (Rover* r : {&once, &often}) r->place(0, 0, 0, ground), r->drive({0.2, 0, 0.1}, 100);
  once.advance(3, &ground);
  for (int n = 0; n < 300; ++n) often.advance(0.01, &ground);
  EXPECT_EQ(once.state().ticks, 150u);
  EXPECT_EQ(often.state().ticks, 150u);
  EXPECT_EQ(once.state().pose.x, often.state().pose.x);
}

TEST(RoverDrive, CommandsAreCutToTheLimits) {
  const Suspension suspension{RoverParameters()};
  RoverParameters p;
  const auto limited = [&](const DriveCommand& c) { return Drive(p, suspension).limited(c); };
  EXPECT_EQ(limited({9, 0, 0}).forward, 0.3);
  EXPECT_EQ(limited({-9, 5, 0}).sideways, 0);
  EXPECT_EQ(limited({0, 0, -7}).yaw_rate, -0.6);
  // The outer rims would need 0.3 + 0.6 · 0.3 = 0.48 m/s.
  EXPECT_EQ(limited({0.3, 0, 0.6}).forward, 0.3);
  p.max_wheel_speed = 0.24;
  EXPECT_NEAR(limited({0.3, 0, 0.6}).forward, 0.15, 1e-12);
  EXPECT_NEAR(limited({0.3, 0, 0.6}).yaw_rate, 0.3, 1e-12);
  p.steering = Steering::ackermann;
  EXPECT_EQ(limited({0, 0, 1}).yaw_rate, 0);
  const double tightest = 0.3 + 0.3 / std::tan(40 * degree);
  EXPECT_NEAR(limited({0.1, 0, 9}).yaw_rate, 0.1 / tightest, 1e-12);
  p.steering = Steering::per_wheel;
  EXPECT_NEAR(limited({0, 9, 0}).sideways, 0.24, 1e-12);
}

TEST(RoverDrive, WheelsThatSteerRollWithoutBeingDragged) {
  RoverParameters p;
  p.steering = Steering::per_wheel;
  const Suspension suspension(p);
  const WheelMotion spot = Drive(p, suspension).wheels_for({0, 0, 0.5}, {});
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_NEAR(std::abs(spot.steer[n]), 45 * degree, 1e-12);
    EXPECT_NEAR(std::abs(spot.rim_speed[n]), 0.5 * 0.3 * std::sqrt(2), 1e-12);
  }
  const WheelMotion crab = Drive(p, suspension).wheels_for({0, 0.2, 0}, {});
  for (std::size_t n = 0; n < 4; ++n) EXPECT_NEAR(crab.steer[n], 90 * degree, 1e-12);
}

class SlipByLaw : public testing::TestWithParam<WheelLaw> {};

TEST_P(SlipByLaw, IsMadeAndOdometryIsOffByIt) {
  RoverParameters p;
  p.wheel_law = GetParam();
  const wheels::WheelGround law = wheels_of(p, WheelGroundParameters());
  for (const double angle : {0.0, 6.0, 10.0, -8.0}) {
    for (const double looseness : {0.0, 0.3}) {
      SCOPED_TRACE(std::to_string(angle) + " deg, looseness " + std::to_string(looseness));
      const SmoothGround ground(plane(angle), 5, looseness);
      const wheels::Ground under{static_cast<float>(looseness), 5, 0};
      Rover r(p, {});
      r.place(0, 0, 0, ground);
      drive(r, {0.2, 0, 0}, 20, ground);
      ASSERT_EQ(r.state().condition, RoverCondition::driving) << r.state().reason;
      const double slip = law.longitudinal_slip(static_cast<float>(angle * degree), 0.2f, under);
      EXPECT_NEAR(r.state().slip, slip, 1e-4);
      EXPECT_NEAR(r.state().wheels[0].slip, slip, 1e-4);
      const Pose &odometry = r.state().odometry, &pose = r.state().pose;
      const double believed = std::hypot(odometry.x, odometry.z),
                   made = std::hypot(pose.x, pose.x * std::tan(angle * degree));
      EXPECT_NEAR(1 - made / believed, slip, 5e-3);
      EXPECT_NEAR(r.state().way_made / r.state().way_commanded, 1 - slip, 5e-3);
      EXPECT_NEAR(r.state().wheels[2].sunk,
                  law.sinkage(static_cast<float>(slip),
                              static_cast<float>(1 + 0.5 * std::tan(angle * degree)), under),
                  3e-4)
          << "the rear wheels carry more uphill: mass_height - wheel_radius is half of wheelbase/2 (and so "
             "sink more)";
    }
  }
}

TEST(RoverDrive, WetGroundIsAsFirmAsItIsTold) {
  SmoothGround ground(plane(6), 5, 1);
  const auto slip = [&](double moisture, const WetGroundParameters& wet) {
    ground.moisture_ = moisture;
    RoverParameters p;
    p.wheel_law = WheelLaw::bekker;
    Rover r(p, {}, "rover", wet);
    r.place(0, 0, 0, ground);
    drive(r, {0.2, 0, 0}, 10, ground);
    return r.state().slip;
  };
  EXPECT_LT(slip(0.5, {3, 0.15}), slip(0.5, {}));
  EXPECT_LT(slip(1, {1.5, 1}), slip(1, {}));
  EXPECT_EQ(slip(0, {3, 1}), slip(0, {}));
}

INSTANTIATE_TEST_SUITE_P(Of, SlipByLaw, testing::Values(WheelLaw::light, WheelLaw::bekker),
                         [](const auto& kind) {
                           return std::string(wheel_laws[static_cast<int>(kind.param)]);
                         });

TEST(RoverDrive, AcrossASlopeItDriftsDownhillByTheLaw) {
  const wheels::WheelGround law = wheels_of(RoverParameters(), WheelGroundParameters());
  const SmoothGround ground(plane(8), 5, 0.3);  // rises to the east
  Rover r = rover_of();
  r.place(0, 0, pi / 2, ground);  // north: uphill to the right
  drive(r, {0.2, 0, 0}, 10, ground);
  const double drift = law.lateral_slip(static_cast<float>(-8 * degree), {0.3f, 5, 0});
  EXPECT_LT(drift, 0);
  EXPECT_LT(r.state().pose.x, 0) << "it drifts uphill";
  EXPECT_NEAR(r.state().pose.x / r.state().pose.y, drift, 1e-3);
}

TEST(RoverDrive, SkidSteeringLosesYawThatOdometryDoesNotNotice) {
  const SmoothGround ground(flat());
  Rover r = rover_of();
  r.place(0, 0, 0, ground);
  drive(r, {0, 0, 0.3}, 5, ground);
  EXPECT_GT(r.state().odometry.yaw, 1.4);
  const double slip = r.state().slip;
  EXPECT_NEAR(r.state().pose.yaw, r.state().odometry.yaw * (1 - slip) * 0.8, 1e-3);
  EXPECT_NEAR(r.state().pose.x, 0, 1e-9);
}

TEST(RoverDrive, NoiseOfOdometryFollowsTheSeed) {
  const SmoothGround ground(flat());
  const auto end = [&](std::uint64_t seed, double noise) {
    RoverParameters p;
    p.seed = seed;
    p.odometry_noise = noise;
    Rover r(p, {});
    r.place(0, 0, 0, ground);
    drive(r, {0.3, 0, 0}, 20, ground);
    return r.state();
  };
  const RoverState without = end(1, 0), with = end(1, 0.05);
  EXPECT_EQ(with.odometry.x, end(1, 0.05).odometry.x);
  EXPECT_NE(with.odometry.x, end(2, 0.05).odometry.x);
  EXPECT_EQ(with.pose.x, without.pose.x);
  EXPECT_NEAR(with.odometry.x, without.odometry.x, 5 * 0.05 * std::sqrt(6));
}

TEST(RoverImu, AtRestItFeelsGravityInItsFrame) {
  Rover r = rover_of();
  const SmoothGround ground(plane(20));
  r.place(0, 0, 0, ground);
  r.advance(1, &ground);
  const ImuReading imu = r.imu();
  EXPECT_NEAR(imu.acceleration[0], 9.81 * std::sin(20 * degree),
              1e-4);  // the nose is up: the ground pushes it ahead
  EXPECT_NEAR(imu.acceleration[1], 0, 1e-9);
  EXPECT_NEAR(imu.acceleration[2], 9.81 * std::cos(20 * degree), 1e-4);
  for (double rate : imu.angular_velocity) EXPECT_NEAR(rate, 0, 1e-9);
}

TEST(RoverImu, InACurveItFeelsTheTurnAndTheCentre) {
  RoverParameters p;
  p.steering = Steering::per_wheel;
  p.wheel_law = WheelLaw::light;
  WheelGroundParameters firm;
  firm.light_packed = 0;
  Rover r(p, firm);
  const SmoothGround ground(flat());
  r.place(0, 0, 0, ground);
  drive(r, {0.3, 0, 0.5}, 8, ground);
  const ImuReading imu = r.imu();
  EXPECT_NEAR(imu.angular_velocity[2], 0.5, 1e-4);
  EXPECT_NEAR(std::hypot(imu.acceleration[0], imu.acceleration[1]), 0.3 * 0.5, 2e-3);
  EXPECT_NEAR(imu.acceleration[1], 0.15, 2e-3);  // to the left, where the centre is
}

TEST(RoverDrive, RefusesWhatIsNoCommand) {
  Rover r = rover_of();
  EXPECT_NE(refusal([&] { r.drive({NAN, 0, 0}, 1); }).find("linear.x: nan"), std::string::npos);
  EXPECT_NE(refusal([&] { r.drive({0, 0, INFINITY}, 1); }).find("angular.z: inf"), std::string::npos);
  EXPECT_NE(refusal([&] { r.drive({0, 0, 0}, -1); }).find("seconds"), std::string::npos);
  EXPECT_NE(refusal([&] { r.advance(NAN, nullptr); }).find("seconds"), std::string::npos);
  EXPECT_EQ(r.state().command_ticks, 0u);
}

TEST(RoverParameters, ThatDoNotGoTogetherAreRefusedAllAtOnce) {
  RoverParameters p;
  p.suspension = SuspensionKind::rocker_bogie;
  p.bogie_x = 0.1;
  p.pivot_x = 5;
  p.free_slip = 0.95;
  p.wheelbase = 0.3;
  const std::string reason = refusal([&] { Rover(p, {}, "file"); });
  for (const char* name : {"file: bogie_x: 0.1", "pivot_x: 5", "free_slip: 0.95", "wheelbase: 0.3"})
    EXPECT_NE(reason.find(name), std::string::npos) << reason;
}

TEST(RoverClass, GivesARoverItsDimensions) {
  const std::string text =
      "traversability: {wheel_law: bekker, mass: 185, gravity: 3.71, wheels: 6, wheel_radius: 0.13, "
      "wheel_width: 0.16}\n"
      "rover_dimensions: {axles: [0.71, 0.0, -0.70], track: 1.06, rocker_pivot: [0.15, 0.3], bogie_pivot: "
      "[-0.35, 0.1],"
      " bogie: rear, clearance: 0.29, body: [1.0, 0.8, 0.4], steered_axles: [0, 2], max_speed: 0.05}\n";
  const RoverParameters p = rover_of_class(YAML::Load(text), "mer");
  EXPECT_EQ(p.suspension, SuspensionKind::rocker_bogie);
  EXPECT_EQ(p.steering, Steering::ackermann);
  EXPECT_NEAR(p.wheelbase, 1.41, 1e-12);
  EXPECT_NEAR(p.middle_x, -0.005, 1e-12);
  EXPECT_NEAR(p.bogie_x, -0.355, 1e-12);
  EXPECT_NEAR(p.mass, 185, 1e-4);
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& word) {
    std::string bad = text;
    bad.replace(bad.find(from), from.size(), to);
    const std::string reason = refusal([&] { rover_of_class(YAML::Load(bad), "mer"); });
    EXPECT_NE(reason.find(word), std::string::npos) << reason;
  };
  refused("[0.71, 0.0, -0.70]", "[1]", "axles");
  refused("bogie: rear", "bogie: front", "rover_dimensions.bogie: 'front'");
  refused("[1.0, 0.8, 0.4]", "[1, wide]", "rover_dimensions.body");
  refused("mass: 185", "mass: -1", "traversability.mass: -1");
  refused("track: 1.06, ", "", "rover_dimensions.track: is missing");
  EXPECT_NE(refusal([] { rover_of_class(YAML::Load("[]"), "list"); }).find("list: is not a class"),
            std::string::npos);
}

}  // namespace
}  // namespace desert_sim

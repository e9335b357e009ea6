// What stops a rover: it is told, and where it can it gets out again.

#include "test/src/rover/field.hpp"
#include "test/support/refusal.hpp"

namespace desert_sim {
namespace {

using namespace test;

/// By the strength of the ground, in which 30 kg on small wheels sink deep.
RoverParameters heavy() {
  RoverParameters p;
  p.wheel_law = WheelLaw::bekker;
  return p;
}

/// Until `done`, at most `seconds`; whether it was.
bool drive_until(Rover& rover, const DriveCommand& command, const GroundSource& ground,
                 const std::function<bool()>& done, double seconds = 60) {
  for (double time = 0; time < seconds; time += 0.1) {
    if (done()) return true;
    rover.drive(command, 1);
    rover.advance(0.1, &ground);
  }
  return done();
}

TEST(RoverTrouble, OnASteepLooseSlopeItGetsStuckAndBacksOut) {
  // Flat, then a slope of loose sand that no slip is enough for.
  const SmoothGround ground([](double x, double) { return x > 0 ? 0.45 * x : 0.0; }, 3, 0.5);
  Rover r = rover_of(heavy());
  r.place(-2, 0, 0, ground);
  const auto is = [&](RoverCondition condition) {
    return [&r, condition] { return r.state().condition == condition; };
  };
  ASSERT_TRUE(drive_until(r, {0.2, 0, 0}, ground, is(RoverCondition::stuck)));
  EXPECT_NE(r.state().reason.find("make no way: slip "), std::string::npos) << r.state().reason;
  EXPECT_GT(r.state().slip, 0.9);
  const double x = r.state().pose.x, depth = deepest(r);
  EXPECT_GT(depth, 0.03);
  drive_until(
      r, {0.2, 0, 0}, ground, [] { return false; }, 20);
  EXPECT_NEAR(r.state().pose.x, x, 0.05) << "it creeps on";
  EXPECT_EQ(r.state().condition, RoverCondition::stuck);
  drive_until(
      r, {0, 0, 0}, ground, [] { return false; }, 2);
  EXPECT_EQ(r.state().condition, RoverCondition::stuck) << "standing still is no way out";
  ASSERT_TRUE(drive_until(r, {-0.2, 0, 0}, ground, is(RoverCondition::driving), 10)) << r.state().reason;
  drive_until(
      r, {-0.2, 0, 0}, ground, [] { return false; }, 10);
  EXPECT_LT(r.state().pose.x, x - 1);
  EXPECT_LT(deepest(r), depth);
}

TEST(RoverTrouble, AWheelThatHasDugItselfInNeedsLessSlopeToStayStuck) {
  // Hysteresis: a slope that it can climb holds it while its wheels stand in their holes.
  double angle = 30;
  SmoothGround ground([&](double x, double) { return std::tan(angle * degree) * x; }, 3, 0.3);
  Rover dug = rover_of(heavy()), fresh = rover_of(heavy());
  dug.place(0, 0, 0, ground);
  ASSERT_TRUE(
      drive_until(dug, {0.2, 0, 0}, ground, [&] { return dug.state().condition == RoverCondition::stuck; }));
  const std::array<WheelState, most_wheels> holes = dug.state().wheels;
  angle = 4;
  fresh.place(0, 0, 0, ground);
  RoverState state = fresh.state();
  for (std::size_t n = 0; n < 4; ++n) state.wheels[n].sunk = holes[n].sunk, state.wheels[n].dug = 1;
  dug.set_state(state);
  for (Rover* r : {&dug, &fresh}) r->drive({0.2, 0, 0}, 1), r->advance(0.2, &ground);
  EXPECT_GT(dug.state().slip, fresh.state().slip + 0.05);
  dug.set_state(state);
  dug.drive({-0.2, 0, 0}, 1);
  dug.advance(0.2, &ground);
  EXPECT_LT(dug.state().slip, fresh.state().slip) << "backwards it rolls in its own track";
}

TEST(RoverTrouble, SandThatComesBuriesItAndWindFreesIt) {
  double sand = 0;
  SmoothGround ground([&](double, double) { return sand; }, 5, 1);
  Rover r = rover_of();
  r.place(0, 0, 0, ground);
  const double z = r.state().pose.z;
  for (; sand < 0.5; sand += 0.002) r.advance(Rover::internal_step, &ground);
  EXPECT_EQ(r.state().condition, RoverCondition::buried);
  EXPECT_NE(r.state().reason.find("buried"), std::string::npos);
  EXPECT_NEAR(r.state().pose.z, z, 1e-6) << "sand does not lift it";
  EXPECT_NEAR(deepest(r), 0.5 + 0.01, 0.03);
  r.drive({0.3, 0, 0}, 10);
  r.advance(5, &ground);
  EXPECT_EQ(r.state().pose.x, 0);
  for (; sand > 0; sand -= 0.002) r.advance(Rover::internal_step, &ground);
  r.advance(0.1, &ground);
  EXPECT_NE(r.state().condition, RoverCondition::buried);
  EXPECT_TRUE(drive_until(r, {0.3, 0, 0}, ground, [&] { return r.state().pose.x > 0.5; }))
      << r.state().reason;
}

TEST(RoverTrouble, GroundThatGoesLetsItDown) {
  double sand = 0;
  SmoothGround ground([&](double, double) { return sand; }, 5, 1);
  Rover r = rover_of();
  r.place(0, 0, 0, ground);
  const double z = r.state().pose.z, depth = deepest(r);
  for (; sand > -0.3; sand -= 0.002) r.advance(Rover::internal_step, &ground);
  r.advance(Rover::internal_step, &ground);
  EXPECT_NEAR(r.state().pose.z, z + sand, 0.003);
  EXPECT_NEAR(deepest(r), depth, 1e-6);
}

TEST(RoverTrouble, TooSteepATiltTipsItOverForGood) {
  const SmoothGround steep(plane(44)), level(flat());
  Rover r = rover_of();
  r.place(0, 0, pi / 2, steep);
  r.advance(0.1, &steep);
  EXPECT_EQ(r.state().condition, RoverCondition::tipped);
  EXPECT_NE(r.state().reason.find("roll"), std::string::npos) << r.state().reason;
  r.drive({0.3, 0, 0}, 10);
  r.advance(3, &level);
  EXPECT_EQ(r.state().condition, RoverCondition::tipped);
  r.place(0, 0, 0, level);
  r.advance(0.1, &level);
  EXPECT_EQ(r.state().condition, RoverCondition::idle);
}

TEST(RoverTrouble, AWallBlocksItAndItCanTurnBack) {
  const GridGround ground = ground_of([](double x, double) { return x > 1 ? 1.0 : 0.0; });
  Rover r = rover_of();
  r.place(0, 0, 0, ground);
  ASSERT_TRUE(
      drive_until(r, {0.3, 0, 0}, ground, [&] { return r.state().condition == RoverCondition::blocked; }));
  EXPECT_NE(r.state().reason.find("step"), std::string::npos) << r.state().reason;
  EXPECT_LT(r.state().pose.x + 0.3, 1.01);
  EXPECT_LT(std::abs(r.state().pose.pitch), 10 * degree) << "it climbs the wall";
  const double believed = r.state().odometry.x;
  drive_until(
      r, {0.3, 0, 0}, ground, [] { return false; }, 5);
  EXPECT_NEAR(r.state().odometry.x, believed, 0.02) << "the wheels turn at a wall";
  EXPECT_TRUE(drive_until(
      r, {-0.3, 0, 0}, ground, [&] { return r.state().pose.x < 0; }, 10))
      << r.state().reason;
}

TEST(RoverTrouble, ObstaclesAndDeepWaterBlockIt) {
  GridGround::Layers stone = layers_of(flat()), pond = layers_of(flat());
  stone.obstacle.assign(stone.elevation.size(), 0);
  pond.water.assign(pond.elevation.size(), 0);
  for (int j = 0; j < 400; ++j)
    for (int i = 210; i < 240; ++i) {
      stone.obstacle[static_cast<std::size_t>(400 * j + i)] = 1;
      pond.water[static_cast<std::size_t>(400 * j + i)] = 0.5f;
    }
  for (const auto& [layers, word] : {std::pair(stone, "obstacle"), std::pair(pond, "water")}) {
    const GridGround ground(geometry(), layers);
    Rover r = rover_of();
    r.place(-1, 0, 0, ground);
    ASSERT_TRUE(
        drive_until(r, {0.3, 0, 0}, ground, [&] { return r.state().condition == RoverCondition::blocked; }));
    EXPECT_NE(r.state().reason.find(word), std::string::npos) << r.state().reason;
    EXPECT_LT(r.state().pose.x + 0.3, 1);
  }
}

/// Water of 5 cm, which it wades through at 1 m/s, and which sweeps it away at 3 m/s.
TEST(RoverTrouble, FastWaterBlocksItThatItWouldWadeThrough) {
  for (const float speed : {1.0F, 3.0F}) {
    GridGround::Layers ford = layers_of(flat());
    ford.water.assign(ford.elevation.size(), 0);
    for (std::size_t n = 0; n < ford.water.size(); ++n)
      if (n % 400 >= 210 && n % 400 < 240) ford.water[n] = 0.05F;
    ford.water_y.assign(ford.elevation.size(), -0.8F * speed);
    ford.water_x.assign(ford.elevation.size(), 0.6F * speed);
    const GridGround ground(geometry(), ford);
    Rover r = rover_of();
    r.place(-1, 0, 0, ground);
    const bool blocked = drive_until(
        r, {0.3, 0, 0}, ground,
        [&] { return r.state().condition == RoverCondition::blocked || r.state().pose.x > 5; }, 60);
    ASSERT_TRUE(blocked);
    EXPECT_EQ(r.state().condition == RoverCondition::blocked, speed > 2) << speed << " m/s";
    if (speed < 2) continue;
    EXPECT_NE(r.state().reason.find("flows with 3 m/s"), std::string::npos) << r.state().reason;
    EXPECT_NE(r.state().reason.find(" m^2/s (at most 0.1 m^2/s)"), std::string::npos) << r.state().reason;
    EXPECT_LT(r.state().pose.x + 0.3, 1);
  }
}

TEST(RoverTrouble, AFloodThatComesHoldsItUntilItIsGone) {
  const auto flood = [](float depth, float speed) {
    GridGround::Layers layers = layers_of(flat());
    layers.water.assign(layers.elevation.size(), depth);
    layers.water_x.assign(layers.elevation.size(), speed);
    return GridGround(geometry(), layers);
  };
  const GridGround dry = flood(0, 2), shallow = flood(0.04F, 2), deep = flood(0.5F, 1),
                   still = flood(0.08F, 0);
  Rover r = rover_of();
  r.place(0, 0, 0, dry);
  drive_until(
      r, {0.3, 0, 0}, shallow, [] { return false; }, 5);
  EXPECT_EQ(r.state().condition, RoverCondition::driving) << r.state().reason;
  const double x = r.state().pose.x;
  EXPECT_GT(x, 1);
  r.advance(0.1, &deep);
  EXPECT_EQ(r.state().condition, RoverCondition::blocked) << "it has not been told to drive";
  EXPECT_NE(r.state().reason.find("0.5 m deep and flows with 1 m/s: 0.5 m^2/s (at most 0.1"),
            std::string::npos)
      << r.state().reason;
  for (const double speed : {0.3, -0.3})
    drive_until(
        r, {speed, 0, 0}, deep, [] { return false; }, 3);
  EXPECT_NEAR(r.state().pose.x, x, 1e-6) << "neither way leads out";
  r.advance(0.1, &still);
  EXPECT_EQ(r.state().condition, RoverCondition::driving) << r.state().reason;
  EXPECT_TRUE(drive_until(
      r, {0.3, 0, 0}, shallow, [&] { return r.state().pose.x > x + 1; }, 10));
}

TEST(RoverTrouble, TheEdgeOfTheTerrainStopsIt) {
  const GridGround ground = ground_of(flat());
  Rover r = rover_of();
  r.place(18, 0, 0, ground);
  ASSERT_TRUE(
      drive_until(r, {0.3, 0, 0}, ground, [&] { return r.state().condition == RoverCondition::off_grid; }));
  EXPECT_NE(r.state().reason.find("(20"), std::string::npos) << r.state().reason;
  EXPECT_LT(r.state().pose.x + 0.3, 20);
  EXPECT_TRUE(drive_until(r, {-0.3, 0, 0}, ground, [&] { return r.state().pose.x < 18; }));
}

TEST(RoverTrouble, UnknownGroundIsToldAndStopsIt) {
  GridGround::Layers layers = layers_of(flat());
  for (int j = 0; j < 400; ++j) layers.elevation[static_cast<std::size_t>(400 * j + 215)] = NAN;
  const GridGround ground(geometry(), layers);
  Rover r = rover_of();
  r.advance(0.1, &ground);
  EXPECT_EQ(r.state().condition, RoverCondition::no_terrain);
  EXPECT_NE(refusal([&] { r.place(1.25, 0, 0, ground); }).find("unknown"), std::string::npos);
  EXPECT_NE(refusal([&] { r.place(20, 0, 0, ground); }).find("off the terrain"), std::string::npos);
  EXPECT_FALSE(r.state().placed);
  r.place(0, 0, 0, ground);
  ASSERT_TRUE(
      drive_until(r, {0.3, 0, 0}, ground, [&] { return r.state().condition == RoverCondition::no_terrain; }));
  EXPECT_TRUE(drive_until(r, {-0.3, 0, 0}, ground, [&] { return r.state().pose.x < 0; }));
  r.advance(0.1, nullptr);
  EXPECT_EQ(r.state().condition, RoverCondition::no_terrain);
  r.drive({0.3, 0, 0}, 1);
  r.advance(0.1, &ground);
  EXPECT_EQ(r.state().condition, RoverCondition::driving) << "it goes on when the terrain is back";
}

}  // namespace
}  // namespace desert_sim

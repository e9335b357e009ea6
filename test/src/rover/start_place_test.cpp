// Where a rover starts: the nearest place from which it can drive off.

#include "src/rover/start_place.hpp"

#include "test/src/rover/field.hpp"

namespace desert_sim {
namespace {

using namespace test;

const StartArea field{0, 0, 30, 30};

TEST(StartPlace, TheMiddleWhereItIsFree) {
  const SmoothGround ground(flat());
  EXPECT_EQ(start_problem(rover_of(), 3, -2, 1, ground), "");
  const auto place = nearest_start(rover_of(), field, 0, ground);
  ASSERT_TRUE(place);
  EXPECT_EQ(std::hypot(place->x, place->y), 0);
}

TEST(StartPlace, BesideACliffThatHasTheMiddle) {
  // A wall to the east of x = -3, and a hole beyond it.
  const SmoothGround ground([](double x, double) { return x > -3 ? 2.0 : 0.0; }, 0, 0);
  const SmoothGround steep(
      [](double x, double y) { return std::hypot(x, y) < 6 ? 2 * (6 - std::hypot(x, y)) : 0.0; });
  EXPECT_EQ(start_problem(rover_of(), 3, 0, 0, ground), "") << "on top of it";
  const std::string problem = start_problem(rover_of(), -4, 0, 0, ground);
  EXPECT_NE(problem.find("driving ahead"), std::string::npos) << problem;
  const auto place = nearest_start(rover_of(), field, 0, steep);
  ASSERT_TRUE(place);
  const double distance = std::hypot(place->x, place->y);
  EXPECT_GT(distance, 6 + 10 * 0.6 - 0.6) << "with room around it";
  EXPECT_LT(distance, 6 + 10 * 0.6 * std::sqrt(2) + 0.6) << "but not farther";
  EXPECT_EQ(start_problem(rover_of(), place->x, place->y, 0, steep), "");
}

TEST(StartPlace, NotWhereSandIsTooLooseToClimb) {
  RoverParameters heavy;
  heavy.wheel_law = WheelLaw::bekker;
  const SmoothGround slope([](double x, double) { return x > -5 ? 0.45 * (x + 5) : 0.0; }, 3, 0.5);
  EXPECT_NE(start_problem(rover_of(heavy), 3, 0, 0, slope), "");
  const auto place = nearest_start(rover_of(heavy), field, 0, slope);
  ASSERT_TRUE(place);
  EXPECT_LT(place->x, -5);
}

TEST(StartPlace, NotOnASummit) {
  const SmoothGround ground([](double x, double y) { return -2 * std::max(std::hypot(x, y) - 3, 0.0); });
  EXPECT_EQ(start_problem(rover_of(), 0, 0, 0, ground), "") << "its top is wide enough to drive on";
  const SmoothGround hill([](double x, double y) {
    const double r = std::hypot(x, y);
    return r < 3 ? 6 : r < 6 ? 6 - 2 * (r - 3) : 0.0;
  });
  const auto below = nearest_start(rover_of(), field, 0, hill);
  ASSERT_TRUE(below);
  EXPECT_GT(std::hypot(below->x, below->y), 6);
  EXPECT_GT(below->room, 5);
  const auto above = nearest_start(rover_of(), field, 0, ground);
  ASSERT_TRUE(above) << "where there is no better place";
  EXPECT_EQ(above->room, 0);
}

TEST(StartPlace, NoneWhereAllIsSteep) {
  const SmoothGround ground(plane(50));
  EXPECT_FALSE(nearest_start(rover_of(), field, 0, ground));
  EXPECT_NE(start_problem(rover_of(), 0, 0, 0, ground).find("it tipped over"), std::string::npos);
}

TEST(StartPlace, SaysWhereItStartsAndWhy) {
  const SmoothGround level(flat());
  const SmoothGround hill(
      [](double x, double y) { return std::hypot(x, y) < 6 ? 2 * (6 - std::hypot(x, y)) : 0.0; });
  EXPECT_EQ(choose_start(rover_of(), field, {}, {}, 0, level).remark, "");
  const Start beside = choose_start(rover_of(), field, {}, {}, 0, hill);
  EXPECT_NE(beside.remark.find("the nearest free ground, 1"), std::string::npos) << beside.remark;
  EXPECT_FALSE(beside.is_bad);
  const Start given = choose_start(rover_of(), field, -5.5, 0, 0, hill);
  EXPECT_EQ(given.place.x, -5.5) << "one gets what one asks for";
  EXPECT_TRUE(given.is_bad);
  EXPECT_NE(given.remark.find("it may not be able to drive off: "), std::string::npos) << given.remark;
  EXPECT_EQ(choose_start(rover_of(), field, 8.5, {}, 0, hill).place.y, 0) << "y is that of the middle";
  const SmoothGround steep(plane(50));
  EXPECT_TRUE(choose_start(rover_of(), field, {}, {}, 0, steep).is_bad);
}

TEST(StartPlace, OnTheTerrainWithRoomToDrive) {
  const GridGround ground = ground_of(flat());
  EXPECT_NE(start_problem(rover_of(), 19, 0, 0, ground), "") << "it would reach the edge";
  EXPECT_NE(start_problem(rover_of(), 30, 0, 0, ground).find("cannot be put there"), std::string::npos);
}

}  // namespace
}  // namespace desert_sim

// Following and navigating, with a rover that does exactly what it is told.
#include "src/planner/navigator.hpp"

#include <cmath>

#include "src/core/error.hpp"
#include "test/src/planner/navigating.hpp"

namespace desert_sim {
namespace {

using test::frame;
using test::IdealRover;
using test::Navigating;

TEST(PurePursuit, ConvergesToThePath) {
  PurePursuit pursuit({});
  const GridPath path{{0, 0}, {10, 0}, {10, 8}, {4, 8}};
  pursuit.follow(path);
  IdealRover rover{{-1, 1.5, 2.5}};
  double worst = 0;
  for (int n = 0; n < 3000 && std::hypot(rover.pose.x - 4, rover.pose.y - 8) > 0.1; ++n) {
    pursuit.locate(rover.pose);
    rover.drive(pursuit.command(), 0.1);
    if (pursuit.done() > 4) worst = std::max(worst, pursuit.off_path());
  }
  EXPECT_NEAR(rover.pose.x, 4, 0.11);
  EXPECT_NEAR(rover.pose.y, 8, 0.11);
  EXPECT_LT(worst, 0.5) << "it cuts corners by less than half the lookahead";
}

TEST(PurePursuit, ARoverThatCannotTurnOnTheSpotDrivesArcs) {
  PursuitParameters p;
  p.turns_on_the_spot = false;
  p.narrowest_arc = 2;
  PurePursuit pursuit(p);
  pursuit.follow({{0, 0}, {-20, 0}});
  IdealRover rover{{0, 0, 0}};
  for (int n = 0; n < 3000 && rover.pose.x > -19.5; ++n) {
    pursuit.locate(rover.pose);
    const DriveCommand c = pursuit.command();
    ASSERT_GT(c.forward, 0);
    ASSERT_LE(std::abs(c.yaw_rate), c.forward / 2 + 1e-9);
    rover.drive(c, 0.1);
  }
  EXPECT_LT(rover.pose.x, -19.4);
  EXPECT_NEAR(rover.pose.y, 0, 0.2);
}

TEST_F(Navigating, ArrivesOverFreeGround) {
  go(30, 20);
  EXPECT_EQ(run(300), NavigatorState::arrived) << status().reason;
  EXPECT_NEAR(rover_.pose.x, 30, 0.5);
  EXPECT_EQ(status().plans, 1);
  EXPECT_EQ(status().replans, 0);
  EXPECT_LT(status().elapsed, 2 * std::hypot(25, 15) / 0.3);
}

TEST_F(Navigating, ItsPathIsWhatLiesAhead) {
  go(35, 5);
  run(1);
  const std::uint64_t number = navigator_.path_number();
  EXPECT_LT(navigator_.path().front().x, 6);
  run(50);
  const GridPath path = navigator_.path();
  EXPECT_EQ(navigator_.path_number(), number) << "it is the same one";
  EXPECT_GT(rover_.pose.x, 15);
  EXPECT_NEAR(path.front().x, rover_.pose.x, 0.1);
  EXPECT_NEAR(path_length(path), status().remaining, 0.1);
  EXPECT_NEAR(navigator_.path_done(), path.front().x - 5, 0.5);
  EXPECT_NEAR(path.back().x, 35, 0.5);
}

TEST_F(Navigating, GoesRoundWhatComesIntoItsWay) {
  go(35, 5);
  run(20);
  ground([](int x, int y) { return x >= 40 && x < 44 && y < 40 ? 0.0F : 1.0F; });
  run(1);
  EXPECT_EQ(status().replans, 1);
  EXPECT_NE(status().last_replan.find("blocked"), std::string::npos) << status().last_replan;
  double highest = 0;
  for (const GridPoint& p : navigator_.path()) highest = std::max(highest, p.y);
  EXPECT_GT(highest, 20);
  EXPECT_EQ(run(600), NavigatorState::arrived) << status().reason;
}

TEST_F(Navigating, TakesAnotherPathWhenItsOwnBecomesDear) {
  go(35, 5);
  run(5);
  ground([](int x, int y) { return x >= 40 && x < 50 && y < 16 ? 0.3F : 1.0F; });
  run(1);
  EXPECT_NE(status().last_replan.find("risen"), std::string::npos) << status().last_replan;
  EXPECT_EQ(run(600), NavigatorState::arrived);
}

TEST_F(Navigating, TakesAShortCutThatOpens) {
  ground([](int x, int y) { return x >= 40 && x < 44 && y < 40 ? 0.0F : 1.0F; });
  go(35, 5);
  run(5);
  const double around = status().remaining;
  ground(free_);
  run(1);
  EXPECT_NE(status().last_replan.find("another path"), std::string::npos) << status().last_replan;
  EXPECT_LT(status().remaining, around - 10);
}

TEST_F(Navigating, SmallChangesPlanNothingAnew) {
  go(35, 5);
  for (int n = 0; n < 50; ++n) {
    ground([n](int x, int y) { return 1.0F - 0.02F * static_cast<float>((x + y + n) % 4); });
    run(1);
  }
  EXPECT_EQ(status().replans, 0) << status().last_replan;
}

TEST_F(Navigating, SaysWhichEndIsNotPassable) {
  parameters_.no_path_patience = 2;
  Navigator strict(parameters_);
  strict.update(frame, {0, 0, frame.width, frame.height},
                test::values_of(frame, [](int x, int) { return x >= 60 || x < 8 ? 0.0F : 1.0F; }).data());
  strict.set_goal({35, 10, 0}, 0);
  EXPECT_EQ(strict.act(0, {20, 10, 0}, RoverCondition::idle, "").forward, 0);
  EXPECT_EQ(strict.status().state, NavigatorState::waiting);
  strict.act(3, {20, 10, 0}, RoverCondition::idle, "");
  EXPECT_EQ(strict.status().state, NavigatorState::no_path);
  EXPECT_NE(strict.status().reason.find("the goal (35, 10) is not passable: the ground there"),
            std::string::npos)
      << strict.status().reason;
  strict.set_goal({20, 10, 0}, 5);
  strict.act(5, {1, 10, 0}, RoverCondition::idle, "");
  EXPECT_NE(strict.status().reason.find("the start (1, 10) is not passable"), std::string::npos)
      << strict.status().reason;
  strict.update(frame, {0, 0, frame.width, frame.height},
                test::values_of(frame, [](int x, int) { return x == 40 ? 0.0F : 1.0F; }).data());
  strict.set_goal({30, 10, 0}, 6);
  strict.act(6, {10, 10, 0}, RoverCondition::idle, "");
  EXPECT_NE(strict.status().reason.find("no way leads"), std::string::npos) << strict.status().reason;
  EXPECT_THROW(strict.set_goal({50, 10, 0}, 7), ConfigError);
  EXPECT_THROW(strict.set_goal({NAN, 10, 0}, 7), ConfigError);
}

/// Cells of a centimetre, of which the rover's radius has more than can be counted: ripples loaded beside a
/// planner.
TEST_F(Navigating, WaitsOnTerrainThatItCannotPlanOn) {
  go(35, 5);
  run(2);
  const GridFrame fine{50, 50, 0.01, 0, 0};
  const std::vector<float> flat(2500, 1);
  navigator_.update(fine, {0, 0, 50, 50}, flat.data());
  EXPECT_EQ(navigator_.grid(), nullptr);
  EXPECT_NE(navigator_.ground_refusal().find("radius: 0.5 (allowed: 0 ... 0.4)"), std::string::npos)
      << navigator_.ground_refusal();
  navigator_.update(fine, {3, 3, 2, 2}, flat.data());
  EXPECT_EQ(run(1), NavigatorState::waiting);
  EXPECT_NE(status().reason.find("cannot be planned on: radius"), std::string::npos) << status().reason;
  EXPECT_TRUE(navigator_.path().empty());
  ground(free_);
  EXPECT_EQ(navigator_.ground_refusal(), "");
  EXPECT_EQ(run(300), NavigatorState::arrived) << status().reason;
}

TEST_F(Navigating, WaitsForAPathToOpen) {
  ground([](int x, int) { return x == 40 ? 0.0F : 1.0F; });
  go(35, 10);
  EXPECT_EQ(run(20), NavigatorState::waiting);
  EXPECT_EQ(rover_.pose.x, 5);
  ground(free_);
  EXPECT_EQ(run(300), NavigatorState::arrived);
}

TEST_F(Navigating, BacksOutAndAvoidsThePlaceWhereItWasStuck) {
  go(35, 5);
  run(20);
  const double x = rover_.pose.x;
  for (; rover_.pose.x > x - 0.9 && time_ < 100; time_ += 0.1)
    rover_.drive(navigator_.act(time_, rover_.pose, RoverCondition::stuck, "slip"), 0.1);
  EXPECT_LE(rover_.pose.x, x - 0.9) << "backwards first";
  EXPECT_EQ(status().recoveries, 1);
  EXPECT_EQ(run(300), NavigatorState::arrived);
  EXPECT_GT(status().replans, 0);
}

TEST_F(Navigating, GivesUpWhenItStaysStuck) {
  go(35, 5);
  run(5);
  for (; time_ < 1000 && navigator_.active(); time_ += 0.5)
    navigator_.act(time_, rover_.pose, RoverCondition::stuck, "its wheels turn");
  EXPECT_EQ(status().state, NavigatorState::stuck);
  EXPECT_EQ(status().recoveries, parameters_.recoveries);
  EXPECT_NE(status().reason.find("its wheels turn"), std::string::npos);
}

TEST_F(Navigating, WaitsForTheWindWhenBuried) {
  go(35, 5);
  run(5);
  EXPECT_EQ(run(100, RoverCondition::buried), NavigatorState::waiting);
  run(1);
  EXPECT_EQ(status().state, NavigatorState::driving);
  EXPECT_EQ(run(200, RoverCondition::buried), NavigatorState::buried);
  go(35, 5);
  EXPECT_EQ(run(1, RoverCondition::tipped), NavigatorState::tipped);
}

TEST_F(Navigating, EndsByTimeAndByCancelling) {
  go(35, 5);
  run(5);
  navigator_.cancel("enough");
  EXPECT_EQ(status().state, NavigatorState::cancelled);
  EXPECT_EQ(status().reason, "enough");
  EXPECT_TRUE(navigator_.path().empty());
  EXPECT_EQ(navigator_.act(time_, rover_.pose, RoverCondition::idle, "").forward, 0);
  parameters_.time_limit = 20;
  Navigator hasty(parameters_);
  hasty.update(frame, {0, 0, frame.width, frame.height}, test::values_of(frame, free_).data());
  hasty.set_goal({35, 5, 0}, 0);
  hasty.act(19, {5, 5, 0}, RoverCondition::idle, "");
  EXPECT_TRUE(hasty.active());
  hasty.act(20, {5, 5, 0}, RoverCondition::idle, "");
  EXPECT_EQ(hasty.status().state, NavigatorState::timed_out);
}

TEST_F(Navigating, TurnsToTheGoalsHeadingWhereThatIsAsked) {
  parameters_.goal_yaw_tolerance_deg = 10;
  Navigator exact(parameters_);
  exact.update(frame, {0, 0, frame.width, frame.height}, test::values_of(frame, free_).data());
  exact.set_goal({10, 5, 2}, 0);
  for (double t = 0; t < 200 && exact.active(); t += 0.1)
    rover_.drive(exact.act(t, rover_.pose, RoverCondition::driving, ""), 0.1);
  EXPECT_EQ(exact.status().state, NavigatorState::arrived);
  EXPECT_NEAR(rover_.pose.yaw, 2, 0.18);
}

TEST_F(Navigating, TheSameCallsGiveTheSamePath) {
  const auto once = [&] {
    Navigator n(parameters_);
    IdealRover rover{{5, 5, 0}};
    std::mt19937 dice(7);
    n.update(frame, {0, 0, frame.width, frame.height}, test::random_ground(frame, dice, 20).data());
    n.set_goal({35, 25, 0}, 0);
    for (int k = 0; k < 600 && n.active(); ++k) {
      const float t = static_cast<float>(dice() % 100) / 100.0F;
      n.update(frame, {static_cast<int>(dice() % 80U), static_cast<int>(dice() % 60U), 1, 1}, &t);
      rover.drive(n.act(0.1 * k, rover.pose, RoverCondition::driving, ""), 0.1);
    }
    EXPECT_EQ(n.status().field_differences, 0U);
    return std::array<double, 3>{rover.pose.x, rover.pose.y, rover.pose.yaw};
  };
  EXPECT_EQ(once(), once());
}

}  // namespace
}  // namespace desert_sim

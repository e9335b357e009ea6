/// The C++ kit for tests of others: deserts, rovers, expectations that are met, and those that are not.
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "include/desert_sim/testing.hpp"

namespace {

using desert_sim::test::Desert;
using desert_sim::test::Expectation;
using desert_sim::test::Options;
using desert_sim::test::Point;
using desert_sim::test::Pose;

constexpr Point start{7, 10}, before_wall{10, 10}, goal{16, 10}, gap{12, 14.5};

/// A folder for pictures, which goes when a test ends.
class TestingHeader : public testing::Test {
 protected:
  TestingHeader() { std::filesystem::create_directory(folder_); }
  ~TestingHeader() override { std::filesystem::remove_all(folder_); }

  /// A small part of a shipped scenario.
  Options options() const {
    Options o;
    o.scenario = "rover_barchans";
    o.settings = {"grid.width=48", "grid.height=32", "looseness.enabled=false",
                  "terrain=[{uniform: {layer: bedrock, value: 1}}, "
                  "{column: {layer: bedrock, x: 12, y: 6, size_x: 1, size_y: 12, height: 3}}]"};
    o.pictures = folder_;
    return o;
  }
  Options with_rover() const {
    Options o = options();
    o.rover = {start.x, start.y};
    return o;
  }

  /// Not met, with this text, and with a picture.
  void expect_failure(const Expectation& e, const std::string& text) const {
    EXPECT_FALSE(e);
    EXPECT_NE(e.message.find(text), std::string::npos) << e.message;
    const std::string word = "; picture: ";
    const std::size_t at = e.message.find(word);
    ASSERT_NE(at, std::string::npos) << e.message;
    const cv::Mat picture = cv::imread(e.message.substr(at + word.size()));
    ASSERT_FALSE(picture.empty()) << e.message;
    EXPECT_EQ(picture.cols * 32, picture.rows * 48);
    const testing::AssertionResult shown = e;
    EXPECT_EQ(shown.message(), e.message);
  }

  const std::string folder_ =
      std::filesystem::temp_directory_path() / ("desert_pictures_" + std::to_string(getpid()));
};

/// A planner that answers each pose with a command along its way, which it publishes.
class Follower {
 public:
  explicit Follower(std::vector<Point> way) : way_(std::move(way)) {
    paths_ = node_.advertise<nav_msgs::Path>("/planner/plan", 1, true);
    commands_ = node_.advertise<geometry_msgs::Twist>("/rover/cmd_vel", 1);
    poses_ = node_.subscribe("/rover/ground_truth", 1, &Follower::drive, this);
    publish();
  }
  void publish() {
    nav_msgs::Path path;
    for (const Point& p : way_) {
      path.poses.emplace_back();
      path.poses.back().pose.position.x = p.x;
      path.poses.back().pose.position.y = p.y;
    }
    paths_.publish(path);
  }
  void go_by(const Point& p) {
    way_.insert(way_.begin(), p);
    publish();
  }

 private:
  void drive(const nav_msgs::Odometry& odometry) {
    const geometry_msgs::Point& p = odometry.pose.pose.position;
    const geometry_msgs::Quaternion& q = odometry.pose.pose.orientation;
    while (!way_.empty() && std::hypot(way_[0].x - p.x, way_[0].y - p.y) < 0.3) way_.erase(way_.begin());
    if (way_.empty()) return;
    const double turn =
        std::remainder(std::atan2(way_[0].y - p.y, way_[0].x - p.x) - 2 * std::atan2(q.z, q.w), 2 * M_PI);
    geometry_msgs::Twist command;
    command.linear.x = 0.3 * std::pow(std::max(0.0, std::cos(turn)), 2);
    command.angular.z = 2 * turn;
    commands_.publish(command);
  }

  std::vector<Point> way_;
  ros::NodeHandle node_;
  ros::Publisher paths_, commands_;
  ros::Subscriber poses_;
};

TEST_F(TestingHeader, ASeedGivesTheSameBits) {
  const auto hash = [this](std::uint64_t seed) {
    Options o = options();
    o.scenario = "barchan";
    o.settings = {"grid.width=48", "grid.height=40"};
    o.seed = seed;
    Desert desert(o);
    EXPECT_EQ(desert.terrain().map()->info().height, 40u);
    return std::string(desert.step(3).state_hash);
  };
  EXPECT_EQ(hash(5), hash(5));
  EXPECT_NE(hash(5), hash(6));
}

TEST_F(TestingHeader, CostsAndEdits) {
  Desert desert(options());
  EXPECT_TRUE(desert.expect_cost(start, 0, 0));
  EXPECT_TRUE(desert.expect_cost({11.2, 6}, 100, 100));
  desert_sim::EditTerrain::Request rock;
  rock.layer = "obstacle";
  rock.shape = "circle";
  rock.merge = "replace";
  rock.center.x = rock.center.y = 5;
  rock.radius = rock.inner = rock.value = 1;
  desert.edit(rock);
  EXPECT_EQ(desert.cost({5, 5}), 100);
  expect_failure(desert.expect_cost({5, 5}, 0, 99), "the cost at (5, 5) is 100 (expected: 0 ... 99)");
  EXPECT_THROW(desert.cost({-1, 5}), std::runtime_error);
  rock.layer = "lava";
  try {
    desert.edit(rock);
    FAIL() << "lava was taken";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/desert_sim/edit_terrain: "), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("lava"), std::string::npos) << e.what();
  }
}

TEST_F(TestingHeader, ARoverArrivesAsItsPlannerWants) {
  Options o = with_rover();
  o.reaction = 60;
  o.seconds_per_step = 0.2;
  Desert desert(o);
  const Follower planner({gap, goal});  // which answers each pose, however long that takes
  const Expectation arrival = desert.expect_rover_arrives(goal, 350);
  EXPECT_TRUE(arrival);
  EXPECT_LE(desert.rover().distance_to(goal), 0.5);
  EXPECT_GT(arrival.steps * 0.06, 11) << "0.3 m/s is its limit";
  EXPECT_EQ(desert.step(0).step, static_cast<std::uint64_t>(arrival.steps));
}

TEST_F(TestingHeader, ARoverThatDoesNotArriveIsShown) {
  Options o = options();
  o.rover = {before_wall.x, before_wall.y};
  o.reaction = 60;
  o.seconds_per_step = 0.2;
  Desert desert(o);
  const Follower planner({goal});  // through the wall
  expect_failure(desert.expect_rover_arrives(goal, 40), "it is blocked: ");
}

/// Paths of the test's own process come at once; where they do not, there are many steps for them.
TEST_F(TestingHeader, APlannerThatPlansAnew) {
  constexpr int many = 100;
  Options o = with_rover();
  o.reaction = 0.1;
  Desert desert(o);
  Follower planner({goal});
  EXPECT_TRUE(desert.expect_replanned("/planner/plan", many, [&] { planner.go_by({9, 14}); }));
  expect_failure(desert.expect_replanned("/planner/plan", many, [&] { planner.publish(); }),
                 "/planner/plan has 1 paths since the change");
  expect_failure(desert.expect_replanned("/nowhere", 2, [] { FAIL() << "nothing to change"; }),
                 "nobody has published a path on /nowhere within 2 steps");
}

TEST_F(TestingHeader, ExpectCountsSteps) {
  Desert desert(options());
  EXPECT_EQ(desert.expect([&] { return desert.terrain().map()->info().step >= 4; }, 10, "four steps").steps,
            4);
  expect_failure(desert.expect([] { return false; }, 2, "the impossible"),
                 "the impossible: not within 2 steps");
}

TEST_F(TestingHeader, ARoverIsCommandedByTheTest) {
  Desert desert(with_rover());
  desert.rover().drive(0.3);
  desert.step();
  EXPECT_EQ(desert.rover().status().state, desert_sim::RoverStatus::DRIVING);
  EXPECT_TRUE(desert.expect([&] { return desert.rover().pose().x > start.x + 0.02; }, 10, "it drives"));
  EXPECT_NEAR(desert.rover().pose().y, start.y, 0.01);
  EXPECT_EQ(desert.rover().status().commands, 1u);
}

TEST_F(TestingHeader, ANodeThatRefusesEndsTheTest) {
  Options o = options();
  o.settings = {"grid.width=-3"};
  EXPECT_THROW(Desert desert(o), std::runtime_error);
  EXPECT_THROW(Desert(options()).rover(), std::runtime_error);
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  desert_sim::test::init(argc, argv, "testing_header");
  ros::AsyncSpinner spinner(1);  // for the planner
  spinner.start();
  return RUN_ALL_TESTS();
}

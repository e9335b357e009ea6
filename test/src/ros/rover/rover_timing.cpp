/// How often a rover in ROS time publishes.

#include "test/support/ros/rover_tests.hpp"

namespace {

TEST(RoverTiming, PosesComeAtTheRate) {
  const node_test::Listener<nav_msgs::Odometry> truth("/ground_truth");
  truth.last();
  const std::size_t before = truth.count();
  ros::WallDuration(1).sleep();
  EXPECT_GT(truth.count() - before, 25u) << "50 Hz are wanted";
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "rover_timing_test"); }

/// ~publish_clock under use_sim_time, on a paused node.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/SimulationStatus.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>

#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

class OwnClock : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(wait_until([] { return ros::service::exists("/desert_sim/load_checkpoint", false); }));
    ASSERT_TRUE(call<std_srvs::Trigger>("pause").success);
    ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
    subscriber_ = ros::NodeHandle().subscribe<rosgraph_msgs::Clock>(
        "/clock", 1000,
        boost::function<void(const rosgraph_msgs::ClockConstPtr&)>([this](const auto& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          times_.push_back(message->clock);
        }));
    ASSERT_TRUE(wait_until([&] { return !times().empty(); })) << "a late comer is told the time";
  }
  std::vector<ros::Time> times() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return times_;
  }
  std::mutex mutex_;
  std::vector<ros::Time> times_;
  ros::Subscriber subscriber_;
};

TEST_F(OwnClock, IsSimulatedTimeAndNeverZero) {
  // Times of the test before and the reset may still be on their way.
  ASSERT_TRUE(wait_until([&] { return times().back() == ros::Time(0, 1); })) << times().back();
  step(3);
  ASSERT_TRUE(wait_until([&] { return times().back() == ros::Time(3); })) << times().back();
  std::vector<ros::Time> run = times();
  run.erase(run.begin(), std::find(run.rbegin(), run.rend(), ros::Time(0, 1)).base());
  EXPECT_EQ(run, (std::vector<ros::Time>{ros::Time(1), ros::Time(2), ros::Time(3)})) << "one message a step";
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_TRUE(wait_until([&] { return times().back() == ros::Time(0, 1); })) << times().back();
}

TEST_F(OwnClock, StampsAreItsTime) {
  step(4);
  Listener<ElevationGrid> keyframes("elevation");
  EXPECT_EQ(keyframes.last().header.stamp, ros::Time(4));
  step(1);
  EXPECT_TRUE(keyframes.wait_for(
      [](const ElevationGrid& m) { return m.step == 5 && m.header.stamp == ros::Time(5); }));
}

/// At which rate, simulation_thread_test.cpp says.
TEST_F(OwnClock, DoesNotWaitForItself) {
  Listener<SimulationStatus> status("status");
  ASSERT_TRUE(call<std_srvs::Trigger>("resume").success);
  EXPECT_TRUE(
      status.wait_for([](const SimulationStatus& m) { return m.state == "running" && m.step >= 30; }));
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "own_clock"); }

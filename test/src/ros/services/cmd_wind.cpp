/// ~cmd_wind, on a paused node whose terrain is in the frame "terrain".
#include "src/ros/services/cmd_wind.hpp"

#include <desert_sim/SetWind.h>
#include <desert_sim/SimulationStatus.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <ros/callback_queue.h>
#include <rosgraph_msgs/Log.h>
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "src/core/error.hpp"
#include "src/ros/services/requests.hpp"
#include "test/support/ros/service_tests.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;

geometry_msgs::Vector3Stamped wind(double x, double y, double z = 0, const std::string& frame = "terrain") {
  geometry_msgs::Vector3Stamped message;
  message.header.frame_id = frame;
  message.vector.x = x;
  message.vector.y = y;
  message.vector.z = z;
  return message;
}

bool is_near(const geometry_msgs::Vector3& wind, double x, double y) {
  return std::abs(wind.x - x) < 1e-4 && std::abs(wind.y - y) < 1e-4;
}

class CmdWind : public Services {
 protected:
  void SetUp() override {
    Services::SetUp();
    publisher_ = node_.advertise<geometry_msgs::Vector3Stamped>("/desert_sim/cmd_wind", 10);
    ASSERT_TRUE(wait_until([&] { return publisher_.getNumSubscribers() > 0; }));
  }
  /// Becomes the wind high above, which the node tells with each request for steps.
  bool blows(double x, double y) {
    return blows(x, y, [] {});
  }
  bool blows(double x, double y, const std::function<void()>& meanwhile) {
    return wait_until([&] {
      meanwhile();
      step(0);
      return is_near(status_.last().wind_above, x, y);
    });
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
  Listener<SimulationStatus> status_{"status"};
};

TEST_F(CmdWind, BlowsFromTheNextStepOn) {
  publisher_.publish(wind(-3, 4));
  EXPECT_TRUE(blows(-3, 4));
  publisher_.publish(wind(0, 7, 0, ""));
  EXPECT_TRUE(blows(0, 7)) << "no frame is the terrain's";
}

TEST_F(CmdWind, IsTheSameAsTheServiceStepByStep) {
  step(3);
  publisher_.publish(wind(0, 6));
  ASSERT_TRUE(blows(0, 6));
  const std::string streamed = step(5).state_hash;
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  step(3);
  SetWind::Request request;
  request.use_vector = true;
  request.vector.y = 6;
  ASSERT_TRUE(call<SetWind>("set_wind", request).success);
  EXPECT_EQ(step(5).state_hash, streamed);
}

/// The node warns at most every two seconds, so that it is asked for one warning only.
TEST_F(CmdWind, RefusesWithAWarning) {
  std::mutex mutex;
  std::vector<std::string> told;
  const auto log = node_.subscribe<rosgraph_msgs::Log>(
      "/rosout", 100, boost::function<void(const rosgraph_msgs::LogConstPtr&)>([&](const auto& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (message->name == "/desert_sim") told.push_back(std::to_string(message->level) + message->msg);
      }));
  const auto says = [&](int level, const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex);
    return std::any_of(told.begin(), told.end(), [&](const std::string& line) {
      return line.rfind(std::to_string(level), 0) == 0 && line.find(text) != std::string::npos;
    });
  };
  ASSERT_TRUE(wait_until([&] {
    return call<std_srvs::Trigger>("reset").success && says(rosgraph_msgs::Log::INFO, "was reset");
  })) << "the node knows who reads its log";
  publisher_.publish(wind(2, 1));
  ASSERT_TRUE(blows(2, 1));
  EXPECT_TRUE(wait_until([&] {
    publisher_.publish(wind(not_a_number, 1));
    return says(rosgraph_msgs::Log::WARN, "cmd_wind") && says(rosgraph_msgs::Log::WARN, "vector.x: nan");
  })) << "no warning says so";
  const std::uint64_t reached = step(1).step;
  ASSERT_TRUE(wait_until([&] { return status_.last().step == reached; }));
  EXPECT_TRUE(is_near(status_.last().wind_above, 2, 1));
}

TEST_F(CmdWind, IsTurnedIntoTheTerrainsFrame) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped turned;
  turned.header.frame_id = "terrain";
  turned.child_frame_id = "anemometer";
  turned.transform.translation.x = 1000;  // which a direction does not feel
  turned.transform.rotation.z = std::sqrt(0.5);
  turned.transform.rotation.w = std::sqrt(0.5);  // its x is the terrain's y
  broadcaster.sendTransform(turned);
  EXPECT_TRUE(blows(-1, 5, [&] { publisher_.publish(wind(5, 1, 0, "anemometer")); }))
      << status_.last().wind_above;
}

TEST_F(CmdWind, AStreamFromManyLeavesTheLastAndTheServicesAnswer) {
  ros::Publisher others[3];
  for (ros::Publisher& other : others) {
    other = node_.advertise<geometry_msgs::Vector3Stamped>("/desert_sim/cmd_wind", 10);
    ASSERT_TRUE(wait_until([&] { return other.getNumSubscribers() > 0; }));
  }
  std::atomic<bool> stop{false};
  std::vector<std::thread> streams;
  for (ros::Publisher& other : others)
    streams.emplace_back([&stop, &other] {
      int n = 0;
      EXPECT_TRUE(wait_until([&] {
        n = (n + 1) % 200;
        other.publish(wind(0.01 * n, -0.02 * n));
        return stop.load();
      }));
    });
  for (std::uint64_t n = 1; n <= 10; ++n) EXPECT_EQ(step(1).step, n);
  stop = true;
  for (std::thread& stream : streams) stream.join();
  // What the streams have sent may still be on its way, over other connections.
  EXPECT_TRUE(blows(4, 3, [&] { publisher_.publish(wind(4, 3)); }));
}

/// What takes messages in, on a queue that the test serves, so that each of them has been taken in when the
/// test looks.
TEST(CmdWindSubscriber, RefusesMalformedWindsWithTheirReasons) {
  SimulationThread::Options options;
  options.backend = "cpu";
  options.threads = 1;
  options.paused = true;
  SimulationThread simulation(load_scenario(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml"),
                              no_raster_loader, options, [] {});
  ros::CallbackQueue queue;
  ros::NodeHandle node("/beside");
  node.setCallbackQueue(&queue);
  const Frames frames("terrain");
  const CmdWindSubscriber subscriber(node, simulation, frames);
  ros::Publisher publisher = node.advertise<geometry_msgs::Vector3Stamped>("cmd_wind", 1);
  ASSERT_TRUE(wait_until([&] { return publisher.getNumSubscribers() > 0; }));
  const auto wind_after = [&](const geometry_msgs::Vector3Stamped& message) {
    publisher.publish(message);
    EXPECT_TRUE(wait_until([&] { return queue.callOne() == ros::CallbackQueue::Called; }));
    return simulation.report(false).get().wind_above;
  };
  const auto before = wind_after(wind(3, 4));
  EXPECT_NEAR(before.x, 3, 1e-4);
  EXPECT_NEAR(before.y, 4, 1e-4);
  const auto expect_refused = [&](const geometry_msgs::Vector3Stamped& message, const std::string& text) {
    try {
      cmd_wind_command(message, frames);
      ADD_FAILURE() << "taken: " << message;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
    const auto now = wind_after(message);
    EXPECT_EQ(now.x, before.x) << text;
    EXPECT_EQ(now.y, before.y) << text;
  };
  expect_refused(wind(not_a_number, 1), "vector.x: nan");
  expect_refused(wind(1, infinity), "vector.y: inf");
  expect_refused(wind(1, 0, 0.5), "must be 0: the wind is horizontal");
  expect_refused(wind(1, 0, 0, "nowhere"),
                 "frame 'nowhere' cannot be transformed into the terrain's frame 'terrain'");
  // The simulation itself refuses what is out of range.
  const auto now = wind_after(wind(300, 400));
  EXPECT_EQ(now.x, before.x);
  EXPECT_EQ(now.y, before.y);
  try {
    simulation.apply(cmd_wind_command(wind(300, 400), frames)).get();
    ADD_FAILURE() << "taken";
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("speed: 500 is not in [0, 100] m/s"), std::string::npos) << e.what();
  }
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "cmd_wind"); }

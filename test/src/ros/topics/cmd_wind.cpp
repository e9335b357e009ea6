/// ~cmd_wind, on a paused node whose terrain is in the frame "terrain".
#include <desert_sim/SetWind.h>
#include <desert_sim/SimulationStatus.h>
#include <geometry_msgs/Vector3Stamped.h>
#include <rosgraph_msgs/Log.h>
#include <tf2_ros/static_transform_broadcaster.h>

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

class CmdWind : public Services {
 protected:
  void SetUp() override {
    Services::SetUp();
    publisher_ = node_.advertise<geometry_msgs::Vector3Stamped>("/desert_sim/cmd_wind", 10);
    warnings_ = node_.subscribe<rosgraph_msgs::Log>(
        "/rosout", 100, boost::function<void(const rosgraph_msgs::LogConstPtr&)>([this](const auto& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          if (message->name == "/desert_sim" && message->level == rosgraph_msgs::Log::WARN)
            told_.push_back(message->msg);
        }));
    ASSERT_TRUE(
        wait_until([&] { return publisher_.getNumSubscribers() > 0 && warnings_.getNumPublishers() > 0; }));
  }
  bool blows(double x, double y) {
    return wait_until([&] {
      const geometry_msgs::Vector3 now = status_.last().wind_above;
      return std::abs(now.x - x) < 1e-4 && std::abs(now.y - y) < 1e-4;
    });
  }
  bool told(const std::string& text) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const std::string& warning : told_)
      if (warning.find(text) != std::string::npos) return true;
    return false;
  }
  /// Nothing changes, and a warning of the node has the text in it. The node warns at most every two seconds.
  void expect_warning(const geometry_msgs::Vector3Stamped& message, const std::string& text) {
    const geometry_msgs::Vector3 before = status_.last().wind_above;
    EXPECT_TRUE(wait_until([&] {
      publisher_.publish(message);
      ros::WallDuration(0.1).sleep();
      return told("cmd_wind") && told(text);
    })) << "no warning says: "
        << text;
    const std::size_t n = status_.count();
    EXPECT_TRUE(status_.wait_for_count(n + 3));
    EXPECT_EQ(status_.last().wind_above, before) << text;
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::Subscriber warnings_;
  Listener<SimulationStatus> status_{"status"};
  std::mutex mutex_;
  std::vector<std::string> told_;
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

TEST_F(CmdWind, IsTurnedIntoTheTerrainsFrame) {
  tf2_ros::StaticTransformBroadcaster broadcaster;
  geometry_msgs::TransformStamped turned;
  turned.header.frame_id = "terrain";
  turned.child_frame_id = "anemometer";
  turned.transform.translation.x = 1000;  // which a direction does not feel
  turned.transform.rotation.z = std::sqrt(0.5);
  turned.transform.rotation.w = std::sqrt(0.5);  // its x is the terrain's y
  broadcaster.sendTransform(turned);
  EXPECT_TRUE(wait_until([&] {
    publisher_.publish(wind(5, 1, 0, "anemometer"));
    ros::WallDuration(0.1).sleep();
    const geometry_msgs::Vector3 now = status_.last().wind_above;
    return std::abs(now.x + 1) < 1e-4 && std::abs(now.y - 5) < 1e-4;
  })) << status_.last().wind_above;
}

TEST_F(CmdWind, RefusesWithAWarning) {
  publisher_.publish(wind(2, 1));
  ASSERT_TRUE(blows(2, 1));
  expect_warning(wind(not_a_number, 1), "vector.x: = nan");
  expect_warning(wind(300, 400), "speed: = 500 is not in [0, 100] m/s");
}

/// The reasons are read from the function that the node calls for each message, because warnings of the node
/// are two seconds apart.
TEST_F(CmdWind, MalformedWindsAreRefusedWithTheirReasons) {
  const TerrainTransforms frames("terrain");
  const auto expect_refused = [&](const geometry_msgs::Vector3Stamped& message, const std::string& text) {
    try {
      cmd_wind_command(message, frames);
      ADD_FAILURE() << "taken: " << message;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
    }
    const geometry_msgs::Vector3 before = status_.last().wind_above;
    const std::size_t n = status_.count();
    publisher_.publish(message);
    EXPECT_TRUE(status_.wait_for_count(n + 4));
    EXPECT_EQ(status_.last().wind_above, before) << text;
  };
  expect_refused(wind(not_a_number, 1), "vector.x: = nan");
  expect_refused(wind(1, infinity), "vector.y: = inf");
  expect_refused(wind(1, 0, 0.5), "must be 0: the wind is horizontal");
  expect_refused(wind(1, 0, 0, "nowhere"),
                 "frame 'nowhere' cannot be transformed into the terrain's frame 'terrain'");
  EXPECT_NO_THROW(cmd_wind_command(wind(3, 4), frames));
}

TEST_F(CmdWind, AStreamFromManyLeavesTheLastAndTheServicesAnswer) {
  ros::Publisher others[3];
  for (ros::Publisher& other : others) {
    other = node_.advertise<geometry_msgs::Vector3Stamped>("/desert_sim/cmd_wind", 10);
    ASSERT_TRUE(wait_until([&] { return other.getNumSubscribers() > 0; }));
  }
  std::vector<std::thread> streams;
  for (ros::Publisher& other : others)
    streams.emplace_back([&other] {
      for (int n = 0; n < 200; ++n) {
        other.publish(wind(0.01 * n, -0.02 * n));
        ros::WallDuration(0.002).sleep();
      }
    });
  for (std::uint64_t n = 1; n <= 10; ++n) EXPECT_EQ(step(1).step, n);
  for (std::thread& stream : streams) stream.join();
  publisher_.publish(wind(4, 3));
  EXPECT_TRUE(blows(4, 3));
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "cmd_wind"); }

/// /diagnostics of a node that is well, and of one that is not. They are of this process, and their schedules
/// go by a clock that the test moves.
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <diagnostic_msgs/DiagnosticArray.h>

#include <cmath>
#include <map>

#include "src/grid_map/grid_map_msg.hpp"
#include "src/ros/node/desert_sim_server.hpp"
#include "test/support/manual_clock.hpp"
#include "test/support/ros/service_tests.hpp"
#include "test/support/temporary_folder.hpp"

namespace {

using namespace desert_sim;
using namespace node_test;
using diagnostic_msgs::DiagnosticStatus;

class Diagnostics : public testing::Test {
 protected:
  void SetUp() override {
    subscriber_ = ros::NodeHandle().subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100,
        boost::function<void(const diagnostic_msgs::DiagnosticArrayConstPtr&)>([this](const auto& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const DiagnosticStatus& status : message->status) latest_[status.name] = status;
        }));
  }
  void start(const std::string& name, const std::string& data_folder, bool paused = false) {
    XmlRpc::XmlRpcValue p;
    p["scenario"] = std::string(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml");
    p["backend"] = "cpu";
    p["threads"] = 1;
    p["answer_timeout"] = 600.0;
    p["paused"] = paused;
    p["step_rate"] = 20;
    p["keyframe_rate"] = 5;
    p["update_rate"] = 20;
    p["diagnostic_period"] = 0.05;
    p["autosave_period"] = 0.05;
    p["robot_frame"] = "lost_rover";
    p["data_dir"] = data_folder;
    ros::param::set(name, p);
    server_ = std::make_unique<DesertSimServer>(ros::NodeHandle(name), clock_);
  }
  void start_well(bool paused = false) { start("/desert_sim", folder_.path("data"), paused); }
  DiagnosticStatus latest(const std::string& name) {
    const std::lock_guard<std::mutex> lock(mutex_);
    return latest_.count(name) ? latest_[name] : DiagnosticStatus();
  }
  /// Waits for this level and a message with this text in it.
  testing::AssertionResult says(const std::string& name, int level, const std::string& text) {
    if (wait_until([&] {
          const DiagnosticStatus s = latest(name);
          return s.level == level && !s.message.empty() && s.message.find(text) != std::string::npos;
        }))
      return testing::AssertionSuccess();
    return testing::AssertionFailure()
           << name << ": level " << static_cast<int>(latest(name).level) << ", " << latest(name).message;
  }
  /// The value of one key, once there is one.
  std::string value(const std::string& name, const std::string& key) {
    std::string found;
    EXPECT_TRUE(wait_until([&] {
      for (const auto& pair : latest(name).values)
        if (pair.key == key) found = pair.value;
      return !found.empty();
    })) << name
        << " has no " << key;
    return found;
  }
  desert_sim::test::ManualClock clock_;

 private:
  const desert_sim::test::TemporaryFolder folder_;
  std::unique_ptr<DesertSimServer> server_;
  std::mutex mutex_;
  std::map<std::string, DiagnosticStatus> latest_;
  ros::Subscriber subscriber_;
};

TEST_F(Diagnostics, ANodeThatIsWell) {
  start_well(true);
  const Listener<ElevationUpdate> updates("elevation_updates");
  ASSERT_TRUE(call<std_srvs::Trigger>("resume").success);
  ASSERT_TRUE(wait_until([] { return step(0).step == 1; })) << "the first at once";
  for (std::uint64_t n = 2; n < 45; ++n) {
    clock_.advance(1.0001 / 20);  // so that rounding does not put a due time behind it
    ASSERT_TRUE(wait_until([&] { return updates.last().step == n; })) << n;
  }
  EXPECT_TRUE(wait_until([&] {
    return std::abs(std::stod(value("desert_sim: simulation", "steps a second")) - 20) < 0.1;
  })) << value("desert_sim: simulation", "steps a second");
  EXPECT_NEAR(std::stod(value("desert_sim: simulation", "steps a second wanted")), 20, 1e-9);
  EXPECT_TRUE(says("desert_sim: simulation", DiagnosticStatus::OK, "running"));
  EXPECT_TRUE(says("desert_sim: mass balance", DiagnosticStatus::OK, "mass is conserved"));
  EXPECT_TRUE(says("desert_sim: memory", DiagnosticStatus::OK, "the available memory is sufficient"));
  EXPECT_TRUE(says("desert_sim: topics", DiagnosticStatus::OK, "all topics reach their rates"));
  EXPECT_TRUE(says("desert_sim: forecast", DiagnosticStatus::OK, "there was no forecast yet"));
  EXPECT_TRUE(says("desert_sim: autosave", DiagnosticStatus::OK, "the last autosave succeeded"));
  EXPECT_FALSE(latest("desert_sim: simulation").hardware_id.empty());
  EXPECT_NE(value("desert_sim: mass balance", "sand").find("residual 0 quanta"), std::string::npos);
  EXPECT_GT(std::stod(value("desert_sim: memory", "host, resident [MiB]")), 1);
  EXPECT_GT(std::stod(value("desert_sim: memory", "layers [MiB]")), 0.05);
}

TEST_F(Diagnostics, RatesOfTopicsAreWantedAndAchieved) {
  start_well(true);
  const Listener<ElevationGrid> keyframes("elevation");
  keyframes.last();
  for (int n = 0; n < 15; ++n) {  // each shows the state of a step
    clock_.advance(1.0 / 5);
    step(1);
  }
  EXPECT_TRUE(wait_until([&] {
    double achieved = 0, wanted = 0;
    unsigned subscribers = 0;
    const std::string text = value("desert_sim: topics", "/desert_sim/elevation");
    return std::sscanf(text.c_str(), "%lf of %lf Hz, %u", &achieved, &wanted, &subscribers) == 3 &&
           std::abs(achieved - 5) < 0.1 && wanted == 5 && subscribers == 1;
  })) << value("desert_sim: topics", "/desert_sim/elevation");
}

/// It cannot keep its rate, and has no place for its autosaves.
TEST_F(Diagnostics, ANodeThatIsNot) {
  start("/overworked", "/proc/no_folder");
  EXPECT_TRUE(wait_until([&] {
    clock_.advance(10);
    return latest("overworked: simulation").level == DiagnosticStatus::WARN;
  }));
  EXPECT_TRUE(says("overworked: simulation", DiagnosticStatus::WARN, " s behind its schedule: "));
  EXPECT_TRUE(says("overworked: autosave", DiagnosticStatus::ERROR, "/proc/no_folder"));
  EXPECT_TRUE(says("overworked: mass balance", DiagnosticStatus::OK, "mass is conserved"));
}

TEST_F(Diagnostics, AMissingTransformOfTheLocalMapIsNamed) {
  start_well();
  ros::Subscriber maps = ros::NodeHandle().subscribe<GridMap>(
      "/desert_sim/local_map", 1,
      boost::function<void(const boost::shared_ptr<const GridMap>&)>([](const auto&) {}));
  EXPECT_TRUE(says("desert_sim: topics", DiagnosticStatus::WARN, "frame 'lost_rover' cannot be transformed"));
}

TEST_F(Diagnostics, APauseIsNoFault) {
  start_well();
  EXPECT_TRUE(says("desert_sim: simulation", DiagnosticStatus::OK, "running"));
  ASSERT_TRUE(call<std_srvs::Trigger>("pause").success);
  EXPECT_TRUE(says("desert_sim: simulation", DiagnosticStatus::OK, "paused"));
  ASSERT_TRUE(call<std_srvs::Trigger>("resume").success);
  EXPECT_TRUE(says("desert_sim: simulation", DiagnosticStatus::OK, "running"));
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "diagnostics"); }

/// Steps by service and by schedule: exact numbers, equal hashes, several clients at once.
#include <desert_sim/EditTerrain.h>
#include <desert_sim/ElevationGrid.h>
#include <desert_sim/ElevationUpdate.h>
#include <desert_sim/LoadCheckpoint.h>
#include <desert_sim/SetWind.h>
#include <desert_sim/SimulationStatus.h>
#include <desert_sim/Step.h>
#include <std_srvs/Trigger.h>

#include <filesystem>
#include <future>

#include "src/core/hash_text.hpp"
#include "src/ros/conversion/messages.hpp"
#include "src/simulation/session.hpp"
#include "test/support/ros/client.hpp"

namespace {

namespace fs = std::filesystem;
using desert_sim::ElevationGrid;
using desert_sim::ElevationUpdate;
using desert_sim::SimulationStatus;
using node_test::call;
using node_test::Listener;
using node_test::wait_until;

desert_sim::Step::Response step(std::uint32_t steps) {
  desert_sim::Step::Request request;
  request.steps = steps;
  return call<desert_sim::Step>("step", request);
}

bool trigger(const std::string& name) { return call<std_srvs::Trigger>(name).success; }

desert_sim::Scenario corner(const desert_sim::Settings& settings = {}) {
  return desert_sim::load_scenario(DESERT_SOURCE_DIR "/test/support/ros/scenarios/corner.yaml", settings);
}

class Stepping : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(trigger("pause"));
    ASSERT_TRUE(trigger("reset"));
  }
};

// ---- by service ----

TEST_F(Stepping, StepsAreExactAndGiveTheHashOfAnyOtherRun) {
  const auto response = step(25);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.step, 25u);
  EXPECT_EQ(response.sim_time, 25);
  desert_sim::Session session(corner(), desert_sim::no_raster_loader, "cpu", 1);
  for (int n = 0; n < 25; ++n) session.step();
  EXPECT_EQ(response.state_hash, desert_sim::hash_text(session.simulation().state().hash()));
}

TEST_F(Stepping, ManySmallRequestsMakeOneLargeOne) {
  for (int n = 0; n < 20; ++n) step(1);
  const std::string small = step(0).state_hash;
  ASSERT_TRUE(trigger("reset"));
  EXPECT_EQ(step(20).state_hash, small);
}

TEST_F(Stepping, SubscribersChangeNothing) {
  const std::string alone = step(15).state_hash;
  ASSERT_TRUE(trigger("reset"));
  Listener<ElevationGrid> keyframes("elevation");
  Listener<ElevationUpdate> updates("elevation_updates");
  for (int n = 0; n < 14; ++n) step(1);
  EXPECT_EQ(step(1).state_hash, alone);
}

TEST_F(Stepping, ResetBeginsAnewWithAKeyframe) {
  Listener<ElevationGrid> keyframes("elevation");
  const std::string start = step(0).state_hash;
  step(5);
  ASSERT_TRUE(keyframes.wait_for([](const ElevationGrid& k) { return k.step == 5; }));
  ASSERT_TRUE(trigger("reset"));
  EXPECT_TRUE(wait_until([&] { return keyframes.last().step == 0; }));
  EXPECT_EQ(step(0).state_hash, start);
}

TEST_F(Stepping, TwoClientsAtOnceGetAllTheirSteps) {
  // Over connections that are there before: roscpp loses a call now and then when threads of one process open
  // new ones at once.
  const auto connected = [](ros::ServiceClient client) {
    EXPECT_TRUE(client.isValid()) << client.getService();
    return client;
  };
  ros::NodeHandle node;
  const auto steps_of_a_client = [](ros::ServiceClient client) {
    std::uint64_t last = 0;
    for (int n = 0; n < 20; ++n) {
      desert_sim::Step exchange;
      exchange.request.steps = 3;
      EXPECT_TRUE(client.call(exchange) && exchange.response.success) << exchange.response.message;
      EXPECT_GT(exchange.response.step, last);
      last = exchange.response.step;
    }
  };
  const auto winds = [](ros::ServiceClient client) {
    for (int n = 0; n < 40; ++n) {
      desert_sim::SetWind exchange;
      exchange.request.speed = 3 + n % 5;
      EXPECT_TRUE(client.call(exchange) && exchange.response.success) << exchange.response.message;
    }
  };
  const ros::ServiceClient first = connected(node.serviceClient<desert_sim::Step>("/desert_sim/step", true));
  const ros::ServiceClient second = connected(node.serviceClient<desert_sim::Step>("/desert_sim/step", true));
  const ros::ServiceClient wind =
      connected(node.serviceClient<desert_sim::SetWind>("/desert_sim/set_wind", true));
  std::vector<std::future<void>> clients;
  clients.push_back(std::async(std::launch::async, steps_of_a_client, first));
  clients.push_back(std::async(std::launch::async, steps_of_a_client, second));
  clients.push_back(std::async(std::launch::async, winds, wind));
  for (auto& client : clients) client.get();
  EXPECT_EQ(step(0).step, 120u);
}

TEST_F(Stepping, APauseEndsALongRequest) {
  Listener<SimulationStatus> statuses("status");
  // More steps than there is time for.
  auto request = std::async(std::launch::async, [] { return step(4000000000u); });
  ASSERT_TRUE(statuses.wait_for([](const SimulationStatus& s) { return s.step > 5; }));
  ASSERT_TRUE(trigger("pause"));
  const auto response = request.get();
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("ended by a pause after"), std::string::npos) << response.message;
}

TEST_F(Stepping, ACheckpointOfAnotherSizeGivesAKeyframeOfThatSize) {
  std::string folder;
  ASSERT_TRUE(ros::param::get("/desert_sim/data_dir", folder));
  fs::create_directories(folder);
  desert_sim::Session small(corner({"grid.width=20", "grid.height=33", "terrain=[]"}),
                            desert_sim::no_raster_loader, "cpu", 1);
  for (int n = 0; n < 3; ++n) small.step();
  small.save_checkpoint(folder + "/small.ckpt");

  Listener<ElevationGrid> keyframes("elevation");
  Listener<ElevationUpdate> updates("elevation_updates");
  keyframes.last();
  ASSERT_TRUE(wait_until([&] { return step(1).success && updates.count() > 0; })) << "the node knows both";
  desert_sim::LoadCheckpoint::Request request;
  request.name = "small.ckpt";
  const auto response = call<desert_sim::LoadCheckpoint>("load_checkpoint", request);
  ASSERT_TRUE(response.success) << response.message;
  EXPECT_EQ(response.state_hash, desert_sim::hash_text(small.simulation().state().hash()));
  ASSERT_TRUE(keyframes.wait_for(
      [](const ElevationGrid& k) { return k.width == 20 && k.height == 33 && k.step == 3; }));
  ASSERT_TRUE(step(2).success);
  ASSERT_TRUE(wait_until([&] { return updates.last().step == 5; }));
  for (const auto& tile : updates.last().tiles) EXPECT_LE(tile.x + tile.width, 20u);
  // The checkpoint brought its scenario along: that one begins anew.
  ASSERT_TRUE(trigger("reset"));
  EXPECT_TRUE(wait_until([&] { return keyframes.last().width == 20 && keyframes.last().step == 0; }));
}

// ---- by schedule; at which rate, simulation_thread_test.cpp says ----

TEST_F(Stepping, RunsAndPauses) {
  Listener<SimulationStatus> statuses("status");
  ASSERT_TRUE(trigger("resume"));
  ASSERT_TRUE(statuses.wait_for([](const SimulationStatus& s) {
    return s.state == "running" && s.step > 20 && !s.process_times.empty();
  }));
  for (const auto& time : statuses.last().process_times) EXPECT_GT(time.milliseconds, 0) << time.process;
  ASSERT_TRUE(trigger("pause"));
  const std::uint64_t stopped = step(0).step;
  ASSERT_TRUE(
      statuses.wait_for([&](const SimulationStatus& s) { return s.state == "paused" && s.step == stopped; }));
  EXPECT_EQ(step(0).step, stopped);
}

TEST_F(Stepping, StepsWhileRunningAreAddedToTheSchedule) {
  ASSERT_TRUE(trigger("resume"));
  const auto response = step(40);
  EXPECT_TRUE(response.success);
  EXPECT_GE(response.step, 40u);
  Listener<SimulationStatus> statuses("status");
  EXPECT_TRUE(statuses.wait_for([&](const SimulationStatus& s) { return s.step > response.step + 5; }));
}

}  // namespace

int main(int argc, char** argv) {
  const int status = node_test::run_tests(argc, argv, "stepping");
  std::string folder;
  if (ros::param::get("/desert_sim/data_dir", folder)) fs::remove_all(folder);
  return status;
}
